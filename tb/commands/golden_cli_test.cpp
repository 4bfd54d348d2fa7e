// quadrille golden as a user runs it: sets, the same bytes everywhere, damage, bad input.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

class GoldenCli : public Cli {
 protected:
  void generate(const std::string& arguments) const {
    const Outcome outcome = run("golden generate --limit 30 " + arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  /// Every file of a set in one string.
  std::string bytes(const std::string& directory) const {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(file(directory)))
      if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::string all;
    for (const fs::path& path : files) all += fs::relative(path, file(directory)).string() + "\n" + read(path);
    return all;
  }
  std::string digest(const std::string& name) const {
    EXPECT_EQ(std::system(("sha256sum '" + file(name).string() + "' >'" + file("digest").string() + "'").c_str()), 0);
    return read(file("digest")).substr(0, 64);
  }
  void replace(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = read(file(name));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << name;
    write(name, text.replace(at, from.size(), to));
  }
  /// Another text in a suite's file, with every hash above it made right again.
  void put(const std::string& set, const std::string& suite, const std::string& name, const std::string& text) const {
    const std::string path = set + "/" + suite, manifest = path + "/manifest.json";
    const std::string old_file = digest(path + "/" + name), old_manifest = digest(manifest);
    write(path + "/" + name, text);
    if (name != "manifest.json") replace(manifest, old_file, digest(path + "/" + name));
    replace(set + "/manifest.json", old_manifest, digest(manifest));
  }
};

TEST_F(GoldenCli, ShardsPutTogetherAreOneRun) {
  generate("--out whole");
  for (const std::string shard : {"0", "1", "2"}) generate("--shard " + shard + "/3 --out part" + shard);
  EXPECT_FALSE(bytes("part0") == bytes("whole"));  // not _EQ: the difference of megabytes takes forever to print
  const Outcome outcome = run("golden merge part2 part0 part1 --out merged");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(bytes("merged") == bytes("whole"));
  EXPECT_EQ(run("golden verify merged").status, 0);

  // Some of all suites, a configuration of one's own, and a part given twice.
  const std::string some = "--suite sqrt --suite weights --suite depth --set significand_bits=14 ";
  generate(some + "--out some");
  for (const std::string shard : {"0", "1"}) generate(some + "--shard " + shard + "/2 --out some" + shard);
  ASSERT_EQ(run("golden merge some1 some0 some1 --out some_merged").status, 0);
  EXPECT_TRUE(bytes("some_merged") == bytes("some"));

  refuses(2, "golden merge part0 some0 --out mixed", {"some0", "significand_bits=14"});
  EXPECT_FALSE(fs::exists(file("mixed")));
  refuses(2, "golden merge part0 part1 --out merged", {"merged", "not empty", "--force"});
  refuses(2, "golden merge part0 nowhere --out mixed", {"nowhere"});
  replace("part0/sqrt/response.hex", read(file("part0/sqrt/response.hex")).substr(0, 1), "x");
  refuses(2, "golden merge part0 part1 --out mixed", {"part0/sqrt/response.hex:1"});
  for (const char* shard : {"3/3", "-1/3", "1", "0/0", "a/b", "1/2/3"})
    refuses(2, std::string("golden generate --out x --shard ") + shard, {shard, "0 <= I < N"});
  refuses(2, "golden generate --suite sqrt --out x --shard 0/2", {"2 shards", "suites, 1"});
  refuses(2, "golden generate --scene bowtie --out x --shard 0/2", {"2 shards", "suites, 1"});
}

TEST_F(GoldenCli, ListsSuites) {
  const Outcome outcome = run("golden generate --list-suites");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream in(outcome.out);
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) names.push_back(line);
  for (const char* name : {"snapping", "setup", "tile_context", "coverage", "forward_difference", "normalise", "sqrt",
                           "reciprocal", "ratios", "weights", "interpolation", "depth"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST_F(GoldenCli, GeneratesAndVerifies) {
  generate("--suite weights --suite sqrt --out set");
  const json manifest = json::parse(read(file("set") / "manifest.json"));
  EXPECT_EQ(manifest["command"],
            "quadrille golden generate --level 1 --seed 1 --limit 30 --suite sqrt --suite weights");
  EXPECT_EQ(manifest["suites"].size(), 2u);
  const json suite = json::parse(read(file("set") / "sqrt" / "manifest.json"));
  EXPECT_EQ(suite["config"]["attribute_frac_bits"], 24);
  EXPECT_EQ(suite["counts"]["vectors"], suite["files"]["stimulus.hex"]["lines"]);

  const Outcome outcome = run("golden verify set");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("sqrt: " + suite["counts"]["vectors"].dump() + " vectors, 0 mismatches\nweights: "), 0u)
      << outcome.out;
  const Outcome one = run("golden verify set --suite weights --json -");
  ASSERT_EQ(one.status, 0) << one.err;
  const json report = json::parse(one.out);
  EXPECT_EQ(report["ok"], true);
  EXPECT_EQ(report["engine"], "model");
  ASSERT_EQ(report["suites"].size(), 1u);
  EXPECT_EQ(report["suites"][0]["suite"], "weights");
  EXPECT_EQ(report["suites"][0]["mismatches"], 0);
}

TEST_F(GoldenCli, SameBytesForAnyThreadsAndSpelling) {
  generate("--suite ratios --suite depth --set significand_bits=12 --threads 1 --out a");
  write("c.toml", "significand_bits = 12\n");
  generate("--suite depth --suite ratios --config c.toml --threads 3 --out deep/b/");
  EXPECT_EQ(bytes("a"), bytes("deep/b"));
  generate("--suite ratios --suite depth --set significand_bits=12 --seed 2 --out c");
  EXPECT_NE(bytes("a"), bytes("c"));
  EXPECT_EQ(run("golden verify deep/b").status, 0);
  // What the set says generates it again.
  const std::string command = json::parse(read(file("a") / "manifest.json"))["command"];
  ASSERT_EQ(command.find("quadrille "), 0u);
  ASSERT_EQ(run(command.substr(10) + " --out d").status, 0);
  EXPECT_EQ(bytes("a"), bytes("d"));
}

TEST_F(GoldenCli, DamageEndsWithStatus2) {
  generate("--suite sqrt --out set");
  const fs::path response = file("set") / "sqrt" / "response.hex";
  const std::string text = read(response);
  std::string flipped = text;
  flipped[5] = flipped[5] == '1' ? '2' : '1';
  write("set/sqrt/response.hex", flipped);
  refuses(2, "golden verify set", {"response.hex", "SHA-256"});
  write("set/sqrt/response.hex", text);
  write("set/sqrt/more", "");
  refuses(2, "golden verify set", {"sqrt/more: does not belong to the set"});
  fs::remove(file("set") / "sqrt" / "more");
  EXPECT_EQ(run("golden verify set").status, 0);
  refuses(2, "golden verify nowhere", {"nowhere", "is no directory"});
}

// A set that is intact but wrong: one digit changed and every hash made right again.
TEST_F(GoldenCli, WrongVectorsEndWithStatus1) {
  generate("--suite sqrt --out set");
  std::string text = read(file("set/sqrt/response.hex"));
  char& lowest = text[text.find('\n') - 1];
  lowest = lowest == '0' ? '1' : '0';
  put("set", "sqrt", "response.hex", text);
  const Outcome outcome = run("golden verify set --json report.json");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("vectors, 1 mismatches"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err.find("quadrille: set/sqrt/response.hex:1: sig[0]: expected "), 0u) << outcome.err;
  EXPECT_EQ(json::parse(read(file("report.json")))["ok"], false);
}

// Every byte of a picture counts, even where the picture stays the same, and for every engine.
TEST_F(GoldenCli, WrongPicturesAreFound) {
  generate("--suite stress_bowtie --out set");
  ASSERT_EQ(run("golden verify set").status, 0);
  const std::string good = read(file("set/stress_bowtie/image_0.exr"));
  for (const std::size_t at : {good.size() / 4, good.size() * 3 / 4, good.size() * 7 / 8}) {
    std::string text = good;
    text[at] = static_cast<char>(text[at] ^ 1);
    put("set", "stress_bowtie", "image_0.exr", text);
    for (const char* engine : {"model", "float"}) {
      const Outcome outcome = run(std::string("golden verify set --engine ") + engine);
      EXPECT_EQ(outcome.status, 1) << at << engine << outcome.err;
      EXPECT_EQ(outcome.err.find("quadrille: set/stress_bowtie/image_0.exr: channel "), 0u) << outcome.err;
      EXPECT_NE(outcome.out.find("1 mismatches"), std::string::npos) << outcome.out;
    }
  }
  std::string broken = good;
  broken[0] = 'x';
  put("set", "stress_bowtie", "image_0.exr", broken);
  refuses(2, "golden verify set", {"image_0.exr"});
  put("set", "stress_bowtie", "image_0.exr", good);
  EXPECT_EQ(run("golden verify set").status, 0);
}

TEST_F(GoldenCli, SmallestSetsVerify) {
  const Outcome made = run("golden generate --limit 1 --quiet --out set");
  ASSERT_EQ(made.status, 0) << made.err;
  for (const char* engine : {"model", "float"}) {
    const Outcome outcome = run(std::string("golden verify set --engine ") + engine);
    EXPECT_EQ(outcome.status, 0) << engine << outcome.err;
    EXPECT_EQ(outcome.out.find(": 0 vectors"), std::string::npos) << outcome.out;
  }
}

TEST_F(GoldenCli, NarrowIds) {
  const Outcome made =
      run("golden generate --suite machine --suite stress_tiny --set quad_id_bits=8 --quiet --out set", "timeout 60");
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(run("golden verify set").status, 0);
}

TEST_F(GoldenCli, TheWholeSetIsRead) {
  generate("--suite sqrt --suite weights --out set");
  const std::string response = read(file("set/sqrt/response.hex"));
  std::string flipped = response;
  flipped[5] = flipped[5] == '1' ? '2' : '1';
  write("set/sqrt/response.hex", flipped);
  refuses(2, "golden verify set --suite weights", {"sqrt/response.hex", "SHA-256"});
  write("set/sqrt/response.hex", response);
  std::string manifest = read(file("set/sqrt/manifest.json"));
  const std::string good = manifest;
  manifest.insert(manifest.find("\"latency\": ") + 11, "7");
  put("set", "sqrt", "manifest.json", manifest);
  refuses(2, "golden verify set --suite weights", {"sqrt/manifest.json", "latency"});
  put("set", "sqrt", "manifest.json", good);
  // A command without --suite stands for every suite.
  replace("set/manifest.json", " --suite sqrt --suite weights", "");
  refuses(2, "golden verify set", {"set/manifest.json", "generates other suites"});
}

TEST_F(GoldenCli, NumbersThatDoNotFit) {
  for (const char* seed : {"18446744073709551616", "1e3", "-1", "3x"})
    refuses(2, std::string("golden generate --suite sqrt --out set --seed ") + seed,
            {"--seed", "from 0 to 18446744073709551615"});
  for (const char* limit : {"1000001", "18446744073709551616", "-1"})
    refuses(2, std::string("golden generate --suite sqrt --out set --limit ") + limit,
            {"--limit", "from 0 to 1000000"});
  EXPECT_FALSE(fs::exists(file("set")));
  const Outcome largest = run("golden generate --suite sqrt --limit 30 --seed 18446744073709551615 --out set");
  EXPECT_EQ(largest.status, 0) << largest.err;
  EXPECT_EQ(json::parse(read(file("set/manifest.json")))["seed"], 18446744073709551615u);
  EXPECT_EQ(run("golden verify set").status, 0);
}

TEST_F(GoldenCli, WhereTheSetGoes) {
  refuses(2, "golden generate --suite sqrt --limit 30 --out .", {"current directory"});
  fs::create_directory(file("target"));
  fs::create_directory_symlink("target", file("link"));
  generate("--suite sqrt --out link");
  EXPECT_TRUE(fs::is_symlink(file("link")));
  EXPECT_EQ(run("golden verify target").status, 0);
  refuses(2, "golden verify target/sqrt", {"one suite", "above"});
}

TEST_F(GoldenCli, NothingToReplayIsStatus1) {
  generate("--suite snapping --out set");
  const Outcome outcome = run("golden verify set --engine rtl");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.out, "snapping: no RTL\n");
  EXPECT_EQ(outcome.err, "quadrille: no vectors compared\n");
}

TEST_F(GoldenCli, SealsResponsesOfOnesOwn) {
  generate("--suite sqrt --suite stress_tiny --out " + file("set").string());
  const auto copy = [&] {
    fs::remove_all(file("mine")), fs::copy(file("set"), file("mine"), fs::copy_options::recursive);
  };
  const auto seal = [&] { return run("golden seal " + file("mine").string()); };
  copy();
  ASSERT_EQ(seal().status, 0);
  EXPECT_EQ(bytes("mine"), bytes("set")) << "a set that is right stays as it is";

  // Another significand in the first line: refused until it is sealed, then a difference.
  std::string text = read(file("set/sqrt/response.hex"));
  const std::size_t last = text.find('\n') - 1;
  text[last] = text[last] == '0' ? '1' : '0';
  write("mine/sqrt/response.hex", text);
  EXPECT_EQ(run("golden verify " + file("mine").string()).status, 2);
  ASSERT_EQ(seal().status, 0);
  Outcome outcome = run("golden verify " + file("mine").string());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("response.hex:1: sig[0]"), std::string::npos) << outcome.err;
  outcome = run("golden diff " + file("set").string() + " " + file("mine").string());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("sqrt/response.hex: 1 of "), std::string::npos) << outcome.out;

  // A machine that draws one fragment less.
  copy();
  text = read(file("set/stress_tiny/response.hex"));
  write("mine/stress_tiny/response.hex", text.substr(0, text.rfind('\n', text.size() - 2) + 1));
  outcome = seal();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(run("golden verify " + file("mine").string()).status, 1);
}

TEST_F(GoldenCli, SealReadsWhatSimulatorsWrite) {
  generate("--suite sqrt --suite stress_tiny --out " + file("set").string());
  fs::copy(file("set"), file("mine"), fs::copy_options::recursive);
  for (const char* name : {"sqrt/response.hex", "stress_tiny/response.hex", "stress_tiny/beats.hex"}) {
    const std::string text = read(file("set/" + std::string(name)));
    std::string other = "// 0x00000000\r\n";
    for (const char c : text) other += c == '\n' ? " \r\n" : std::string(1, static_cast<char>(std::toupper(c)));
    other.insert(other.find("\r\n") + 3, "_");
    write("mine/" + std::string(name), other);
  }
  const Outcome outcome = run("golden seal " + file("mine").string());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(bytes("mine"), bytes("set"));
  EXPECT_EQ(run("golden verify " + file("mine").string()).status, 0);
}

TEST_F(GoldenCli, SealRefusesMalformedFiles) {
  generate("--suite sqrt --out " + file("set").string());
  const std::string response = read(file("set/sqrt/response.hex")), stimulus = read(file("set/sqrt/stimulus.hex"));
  const std::string manifest = read(file("set/sqrt/manifest.json"));
  const std::size_t line = response.find('\n') + 1;
  const auto refused = [&](const std::string& name, const std::string& text, const std::string& why) {
    const std::string before = read(file("set/sqrt/" + name));
    write("set/sqrt/" + name, text);
    const Outcome outcome = run("golden seal " + file("set").string());
    EXPECT_EQ(outcome.status, 2) << why;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
    EXPECT_EQ(read(file("set/sqrt/manifest.json")), manifest) << "nothing is written";
    write("set/sqrt/" + name, before);
  };
  refused("response.hex", response.substr(0, line) + "x" + response.substr(line + 1),
          "response.hex:2: column 1 is an unknown digit");
  refused("response.hex", response.substr(0, line) + "0" + response.substr(line), "response.hex:2: has 31 characters");
  refused("response.hex", response.substr(line), "each needs one");
  refused("stimulus.hex", response, "stimulus.hex: differs from the generated file");
  EXPECT_EQ(run("golden seal " + file("nowhere").string()).status, 2);
}

// A square over the pixels 1 to 8 of both axes, w = 1, one quad a line.
constexpr const char* square = "1 1 0.5 1  9 1 0.5 1  9 9 0.5 1  1 9 0.5 1\n";

TEST_F(GoldenCli, AnInputOfOnesOwn) {
  write("square.quads", square);
  ASSERT_EQ(run("golden generate --quads square.quads --size 32x32 --out own").status, 0);
  const json manifest = json::parse(read(file("own/input/manifest.json")));
  EXPECT_EQ(manifest["counts"], (json{{"vectors", 64}, {"draws", 1}, {"quads", 1}}));
  // {draw[16], id[24], x[32], y[32], ...}, 493 bits behind three zeros: the first corner is half a pixel from the first
  // pixel's centre, FRAC = 15.
  EXPECT_EQ(read(file("own/input/stimulus.hex")).substr(0, 26), "00000000000000080000000800");
  // {perspective, x[4 of 64], y, z, w, ...}: as given, x of the last vertex first.
  EXPECT_EQ(read(file("own/input/quads.hex")).substr(0, 65),
            "13ff0000000000000402200000000000040220000000000003ff0000000000000");
  for (const char* engine : {"model", "float"}) {
    const Outcome outcome = run(std::string("golden verify own --engine ") + engine);
    EXPECT_EQ(outcome.status, 0) << engine << ": " << outcome.err;
    EXPECT_EQ(outcome.out, "input: 64 vectors, 0 mismatches\n") << engine;
  }
  // The command of the manifest makes the same bytes.
  const std::string command = manifest["command"];
  ASSERT_EQ(command, "quadrille golden generate --level 1 --seed 1 --quads square.quads --size 32x32");
  ASSERT_EQ(run(command.substr(10) + " --threads 1 --out again").status, 0);
  EXPECT_EQ(bytes("own"), bytes("again"));
}

// Under right hashes: a port integer that does not follow from its quad, and a fragment that the machine does not
// draw.
TEST_F(GoldenCli, WrongBytesOfAnInputAreFound) {
  write("square.quads", square);
  ASSERT_EQ(run("golden generate --quads square.quads --size 32x32 --out own").status, 0);
  const std::string quads = read(file("own/input/quads.hex")), response = read(file("own/input/response.hex"));
  std::string text = quads;
  ASSERT_EQ(text.substr(113, 4), "3ff0");
  text[116] = '1';  // y of the first vertex: 1 + 1/16
  write("own/input/quads.hex", text);
  refuses(2, "golden verify own", {"quads.hex", "SHA-256"});
  write("own/input/quads.hex", quads);
  put("own", "input", "quads.hex", text);
  Outcome outcome = run("golden verify own");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err.find("quadrille: own/input/stimulus.hex:1: y: expected "), 0u) << outcome.err;
  put("own", "input", "quads.hex", quads);
  ASSERT_EQ(run("golden verify own").status, 0);

  text = response;
  char& lowest = text[text.find('\n') - 1];
  lowest = lowest == '0' ? '1' : '0';
  put("own", "input", "response.hex", text);
  outcome = run("golden verify own");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err.find("quadrille: own/input/response.hex:1: attr[0]: expected "), 0u) << outcome.err;
}

// Every kind of input, with draw state and configuration: as many vectors as the command `fragments` has fragments.
TEST_F(GoldenCli, InputsOfEveryKind) {
  const std::string examples = QUADRILLE_SOURCE_DIR "/golden/examples/";
  const std::string narrow = "--config '" + examples + "narrow.toml' --set significand_bits=13";
  for (const std::string& input :
       {std::string("--scene bowtie --shade uv --cull back"),
        std::string("--stress eye_crossing --count 6 --seed 3 --no-depth"),
        std::string("--scene bloomenthal10_a --scissor 3,5,20,30 --no-perspective --set attribute_slots=5"),
        "--mesh '" + examples + "box.obj' --camera '" + examples + "camera.json' --shade normal " + narrow,
        "--mesh '" + examples + "box.obj' --up z --view back --znear 0.1",
        "--quads '" + examples + "winding.quads' --skip none " + narrow}) {
    SCOPED_TRACE(input);
    const Outcome made = run("golden generate --force --size 40x32 --out own " + input);
    ASSERT_EQ(made.status, 0) << made.err;
    const json manifest = json::parse(read(file("own/input/manifest.json")));
    const Outcome fragments = run("fragments --size 40x32 --out - " + input);
    ASSERT_EQ(fragments.status, 0) << fragments.err;
    EXPECT_EQ(manifest["counts"]["vectors"], std::ranges::count(fragments.out, '\n') - 1);
    EXPECT_EQ(manifest["config"]["significand_bits"], input.ends_with(narrow) ? 13 : 18);
    for (const char* engine : {"model", "float"}) {
      const Outcome outcome = run(std::string("golden verify own --engine ") + engine);
      EXPECT_EQ(outcome.status, 0) << engine << outcome.err;
    }
    // The command is words of a shell; what it names makes the same bytes again.
    const std::string command = manifest["command"];
    ASSERT_EQ(run(command.substr(10) + " --force --out again").status, 0) << command;
    EXPECT_EQ(bytes("own"), bytes("again"));
  }
}

TEST_F(GoldenCli, RefusesInputsThatMakeNoSet) {
  write("square.quads", square);
  write("beside.quads", "101 1 0.5 1  109 1 0.5 1  109 9 0.5 1  101 9 0.5 1\n");
  write("huge.quads", std::string(square) + "1e20 1 0.5 1e-20  9 1 0.5 1  9 9 0.5 1  1 9 0.5 1\n");
  const auto refused = [&](const std::string& arguments, const std::vector<std::string>& pieces) {
    refuses(2, "golden generate --out own " + arguments, pieces);
    EXPECT_FALSE(fs::exists(file("own"))) << arguments;
  };
  refused("--quads square.quads --suite sqrt", {"--suite"});
  refused("--quads square.quads --level 2", {"--level"});
  refused("--quads square.quads --scene bowtie", {"one input", "2 were given"});
  refused("--quads nowhere.quads", {"nowhere.quads", "cannot be read"});
  refused("--scene bowtei", {"did you mean \"bowtie\""});
  refused("--quads square.quads --camera c.json", {"--camera needs --mesh"});
  for (const char* alone : {"--cull back", "--size 32x32", "--shade uv", "--count 5", "--strict", "--up z"})
    refused(alone, {"one input is needed", "0 were given"});
  refused("--size 32x32 --quads beside.quads", {"none of the input's quads (1) draws a fragment"});
  refused("--size 32x32 --stress general --count 300 --set quad_id_bits=8", {"quad 256", "quad_id_bits = 8"});
  refused("--size 64x64 --stress general --count 100000", {"more than 1000000 fragments", "--limit"});
  refused("--scene bowtie --shade uv --set attribute_slots=1", {"2 attributes", "--set attribute_slots=2"});
}

// The entries are the constants that the RTL is built with, and wrong ones are found by either engine.
TEST_F(GoldenCli, TablesAreTheConstantsOfTheRtl) {
  for (const char* settings : {"", "--set significand_bits=10", "--set significand_bits=14 --set sqrt_degree=1"}) {
    SCOPED_TRACE(settings);
    generate("--force --suite sqrt_table --suite reciprocal_table --out set " + std::string(settings));
    ASSERT_EQ(run("config --quiet --emit-tables tables.sv " + std::string(settings)).status, 0);
    const json config = json::parse(read(file("set/manifest.json")))["config"];
    const int s = config["significand_bits"];
    // "      5'd3: sqrt_rom = {22'd2060, 18'd77, 18'd5};" against the records {c0[S+4], c1[S], c2[S]} in order.
    std::map<std::string, std::string> roms;
    std::istringstream lines(read(file("tables.sv")));
    for (std::string line; std::getline(lines, line);) {
      char rom[16];
      unsigned long index = 0, c0 = 0, c1 = 0, c2 = 0;
      if (std::sscanf(line.c_str(), " %*d'd%lu: %15s = {%*d'd%lu, %*d'd%lu, %*d'd%lu};", &index, rom, &c0, &c1, &c2) !=
          5)
        continue;
      char record[32];
      std::snprintf(record, sizeof record, "%0*lx\n", (3 * s + 4 + 3) / 4, c0 << 2 * s | c1 << s | c2);
      roms[rom] += record;
    }
    EXPECT_EQ(read(file("set/sqrt_table/response.hex")), roms["sqrt_rom"]);
    EXPECT_EQ(read(file("set/reciprocal_table/response.hex")), roms["recip_rom"]);
    EXPECT_EQ(std::ranges::count(roms["sqrt_rom"], '\n'), 2 << config["sqrt_segments_log2"].get<int>());
    EXPECT_EQ(std::ranges::count(roms["recip_rom"], '\n'), 1 << config["recip_segments_log2"].get<int>());
    for (const char* engine : {"model", "float"})
      EXPECT_EQ(run(std::string("golden verify set --engine ") + engine).status, 0) << engine;
  }
  for (const char* suite : {"sqrt_table", "reciprocal_table"}) {
    const std::string response = read(file("set") / suite / "response.hex");
    std::string text = response;
    text[1] = text[1] == '0' ? '1' : '0';  // a high digit of C0
    put("set", suite, "response.hex", text);
    for (const char* engine : {"model", "float"}) {
      const Outcome outcome = run(std::string("golden verify set --engine ") + engine);
      EXPECT_EQ(outcome.status, 1) << engine;
      EXPECT_NE(outcome.err.find(std::string(suite) + "/response.hex:1: c0"), std::string::npos) << outcome.err;
    }
    put("set", suite, "response.hex", response);
  }
}

TEST_F(GoldenCli, RefusesWhatItCannotDo) {
  refuses(2, "golden generate", {"--out"});
  refuses(2, "golden generate --suite weigths --out set", {"unknown suite \"weigths\"", "did you mean \"weights\""});
  refuses(2, "golden generate --suite '' --out set", {"--suite: the value is empty"});
  refuses(2, "golden generate --level 3 --out set", {"--level"});
  refuses(2, "golden generate --seed -1 --out set", {"from 0 to 18446744073709551615"});
  refuses(2, "golden generate --set significand_bits=99 --out set", {"significand_bits"});
  refuses(2, "golden generate --levle 1 --out set", {"did you mean --level?", "quadrille golden generate --help"});
  refuses(2, "golden", {"subcommand"});
  EXPECT_FALSE(fs::exists(file("set")));
  generate("--suite sqrt --out set");
  refuses(2, "golden generate --suite sqrt --out set", {"is not empty", "--force"});
  generate("--suite reciprocal --out set --force");
  refuses(2, "golden verify set --suite sqrt", {"sqrt", "reciprocal"});
  refuses(2, "golden verify set --engine modle", {"unknown engine \"modle\"", "did you mean \"model\""});
  write("taken", "");
  refuses(2, "golden generate --suite sqrt --out taken", {"taken: is no directory"});
}

}  // namespace
