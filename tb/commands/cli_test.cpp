// Runs the built program: exit statuses and messages for bad input, bytes that do not depend on threads, reports, and
// files that survive failed runs.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace quadrille::cli_test;
using nlohmann::json;

/// Characters of the longest line, and the number of lines.
std::pair<std::size_t, std::size_t> extent(const std::string& text) {
  std::istringstream lines(text);
  std::size_t longest = 0, count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    longest = std::max<std::size_t>(longest, std::ranges::count_if(line, [](char c) { return (c & 0xc0) != 0x80; }));
  return {longest, count};
}

/// Help of the program, of every command that it lists, and of theirs, as wide as the terminal.
TEST_F(Cli, Help) {
  std::vector<std::string> commands{""};
  std::size_t narrow_lines = 0, wide_lines = 0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::string command = commands[i];
    ::setenv("COLUMNS", "80", 1);
    const Outcome narrow = run(command + " --help");
    ::setenv("COLUMNS", "120", 1);
    const Outcome wide = run(command + " --help");
    ::unsetenv("COLUMNS");
    EXPECT_EQ(run(command + " --help").out, narrow.out) << command << ": 80 columns without a terminal";
    EXPECT_EQ(narrow.status, 0) << command;
    EXPECT_LE(extent(narrow.out).first, 80u) << narrow.out;
    EXPECT_LE(extent(wide.out).first, 120u) << wide.out;
    narrow_lines += extent(narrow.out).second;
    wide_lines += extent(wide.out).second;
    const std::size_t status = narrow.out.find("\nExit status:\n  0  "),
                      examples = narrow.out.find("\nExamples:\n  quadrille ");
    EXPECT_LT(status, examples) << narrow.out;
    EXPECT_LE(std::ranges::count(narrow.out.substr(std::min(examples, narrow.out.size())), '\n'), 5) << narrow.out;
    std::istringstream lines(narrow.out);
    for (std::string line; std::getline(lines, line) && line != "Subcommands:";) continue;
    for (std::string line; std::getline(lines, line) && line.starts_with("  ");)
      if (line[2] != ' ') commands.push_back(command + " " + line.substr(2, line.find(' ', 2) - 2));
  }
  EXPECT_EQ(commands.size(), 21u);
  EXPECT_LT(wide_lines, narrow_lines);
}

TEST_F(Cli, Version) {
  for (const char* command : {"", "cosim", "golden", "stress"}) {
    const Outcome version = run(command + std::string(" --version"));
    EXPECT_EQ(version.status, 0) << command;
    EXPECT_EQ(version.out.rfind("quadrille ", 0), 0u) << command;
  }
}

// The core alone says what it lacks; beside the studies it hands over to them.
TEST_F(Cli, StudiesThatAreNotBuilt) {
  fs::copy_file(QUADRILLE_PROGRAM, file("core"));
  for (const auto& [command, lacking] :
       {std::pair{"compare --help", "the command compare"},
        {"bench", "the command bench"},
        {"stress --count 1", "the command stress"},
        {"render --method mvc --scene sphere --png a.png", "--method mvc"},
        {"fragments --engine shader --scene sphere --out a.csv", "the engine shader"}}) {
    const Outcome outcome = run(command, "", file("core").string());
    EXPECT_EQ(outcome.status, 3) << command;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_EQ(outcome.err.rfind("quadrille: " + std::string(lacking) + " is not built: ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find("scripts/setup.sh"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(file("a.png")) || fs::exists(file("a.csv")));
  }
  EXPECT_EQ(run("render --scene bowtie --size 32x32 --png a.png", "", file("core").string()).status, 0);
}

/// Of EGL nothing but the dispatcher: as on a machine without a driver.
TEST_F(Cli, TheShaderNeedsOpenGl) {
  for (const char* command : {"render --engine shader --scene bowtie --size 32x32 --png a.png",
                              "fragments --engine shader --scene bowtie --size 32x32 --out a.csv"}) {
    const Outcome outcome = run(command, "__EGL_VENDOR_LIBRARY_DIRS=/nonexistent");
    EXPECT_EQ(outcome.status, 3) << command;
    EXPECT_EQ(outcome.err.rfind("quadrille: ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find("the engine shader"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("apt-get install"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(file("a.png")) || fs::exists(file("a.csv")));
  }
}

TEST_F(Cli, UsageErrors) {
  refuses(2, "", {"subcommand"});
  refuses(2, "rendre", {"unknown command", "did you mean \"render\"", "cosim"});
  refuses(2, "render --png a.png", {"one input is needed", "--scene"});
  refuses(2, "render --scene sphere --quads a.quads --png a.png", {"one input is needed"});
  refuses(2, "render --scene sphere", {"--out", "--png"});
  refuses(2, "render --scene shpere --png a.png", {"unknown scene", "did you mean \"sphere\"", "phong_mesh"});
  refuses(2, "render --engine modle --scene sphere --png a.png", {"unknown engine", "did you mean \"model\"", "truth"});
  refuses(2, "render --shade textur --scene sphere --png a.png", {"unknown shading", "did you mean \"texture\""});
  refuses(2, "render --sceen sphere --png a.png", {"--sceen", "did you mean --scene"});
  refuses(2, "render --snap off --scene sphere --png a.png", {"--snap off", "float", "shader", "truth"});
  refuses(2, "render --snap maybe --engine truth --scene sphere --png a.png", {"choices: on off"});
  refuses(2, "render --camera c.json --scene sphere --png a.png", {"--camera needs --mesh"});
  refuses(2, "render --cull bak --scene sphere --png a.png", {"did you mean \"back\""});
  refuses(2, "render --scissor 1,2,3 --scene sphere --png a.png", {"X0,Y0,X1,Y1"});
  refuses(2, "render --scissor 0,0,9999,3 --scene sphere --png a.png", {"inside the viewport"});
  refuses(2, "render --znear 0.5 --zfar 0.25 --scene sphere --png a.png", {"znear <= zfar"});
  refuses(2, "render --threads -1 --scene sphere --png a.png", {"--threads"});
  refuses(2, "render --seed x --scene sphere --png a.png", {"--seed"});
  refuses(2, "cosim --stress genral", {"unknown stress family", "did you mean \"general\""});
  refuses(2, "cosim --scene fig7_floor --stall 1", {"--stall"});
  refuses(2, "cosim --scene fig7_floor --gap -0.5", {"--gap"});
  refuses(2, "cosim --scene all --png a.png", {"one input"});
  refuses(2, "fragments --scene sphere", {"--out"});
  refuses(2, "fragments --scene sphere --out - --json -", {"two outputs"});
  refuses(2, "render --scene sphere --png a --out a", {"two outputs"});
  refuses(2, "cosim --scene sphere --png ./a --out b --json a", {"two outputs"});
  refuses(2, "cosim --scene sphere --seed -1", {"--seed", "whole number"});
  refuses(2, "cosim --scene sphere --limit-fragments -5", {"--limit-fragments", "whole number"});
  refuses(2, "cosim --scene sphere --rtl nowhere", {"--rtl nowhere", "no such file"});
  refuses(2, "fragments --engine model --stall 0.5 --scene sphere --out -", {"--engine rtl"});
  refuses(2, "fragments --engine rtl --stall 7 --scene sphere --out -", {"--stall", "probability"});
  refuses(2, "render --texture t.png --shade uv --scene sphere --png a.png", {"--shade texture"});
  refuses(2, "fragments --scene sphere --quad 128 --out -", {"128 quads"});
  refuses(2, "fragments --scene sphere --pixel 512,0 --out -", {"--pixel"});
  refuses(2, "config --quiet --verbose", {"--quiet"});
}

TEST_F(Cli, AnInputIsNeverAnOutput) {
  const std::string quads = write("q.csv", good_quad);
  refuses(2, "fragments --quads q.csv --out ./q.csv", {"q.csv", "input"});
  EXPECT_EQ(read(quads), good_quad);
}

TEST_F(Cli, AFullDiskIsAnError) {
  for (const char* command : {"config", "config --markdown", "scenes", "scenes --json"}) {
    const Outcome outcome = run(std::string(command) + " >/dev/full; exit $?; :");
    EXPECT_EQ(outcome.status, 2) << command;
  }
}

TEST_F(Cli, Sizes) {
  for (const char* size : {"0x5", "5x0", "-3x5", "5", "axb", "5x5x5", "99999999999x1", "4097x1"})
    refuses(2, std::string("render --scene sphere --png a.png --size ") + size, {"--size"});
  EXPECT_EQ(run("render --scene sphere --png a.png --size 1x1 --quiet").status, 0);
  EXPECT_EQ(run("render --scene sphere --png a.png --size 8x70 --quiet").status, 0);
  EXPECT_EQ(run("render --scene sphere --png a.png --size 100x100 --set viewport_bits=7 --quiet").status, 0);
  refuses(2, "render --scene sphere --png a.png --size 200x100 --set viewport_bits=7", {"viewport_bits = 7"});
}

TEST_F(Cli, BadConfigurations) {
  refuses(2, "config --set significand_bit=3", {"significand_bit", "did you mean \"significand_bits\""});
  refuses(2, "config --set significand_bits=99", {"significand_bits", "8..26"});
  refuses(2, "config --set significand_bits=x", {"significand_bits", "\"x\""});
  refuses(2, "config --set significand_bits", {"KEY=VALUE"});
  refuses(2, "config --set =3", {"KEY=VALUE"});
  refuses(2, "config --config missing.toml", {"missing.toml"});
  write("a.toml", "significand_bits = 18\nnonsense = 4\n");
  refuses(2, "config --config a.toml", {"a.toml:2", "nonsense"});
  write("b.toml", "significand_bits = \n");
  refuses(2, "config --config b.toml", {"b.toml:1"});
  write("c.toml", "significand_bits = 1e3\n");
  refuses(2, "config --config c.toml", {"c.toml:1", "integer"});
  refuses(2, "config --set viewport_bits=14 --set guard_bits=4 --set homogeneous_frac_bits=10", {"quadrille: "});
}

TEST_F(Cli, BadQuads) {
  refuses(2, "fragments --quads missing.quads --out -", {"missing.quads"});
  const auto bad = [&](const std::string& text, const std::vector<std::string>& pieces) {
    write("a.quads", text);
    refuses(2, "fragments --quads a.quads --out a.csv", pieces);
    EXPECT_FALSE(fs::exists(file("a.csv")));
  };
  bad("", {"a.quads"});
  bad("# only a comment\n", {"a.quads"});
  bad(std::string("# comment\n") + good_quad + "1 2 3\n", {"a.quads:3"});
  bad("10 10 0.5 x  40 12 0.5 1  42 44 0.5 1  8 40 0.5 1\n", {"a.quads:1", "x"});
  bad("10 10 0.5 1  nan 12 0.5 1  42 44 0.5 1  8 40 0.5 1\n", {"a.quads:1"});
  bad("10 10 0.5 1  inf 12 0.5 1  42 44 0.5 1  8 40 0.5 1\n", {"a.quads:1"});
  bad("10 10 0.5 1  1e300 12 0.5 1  42 44 0.5 1  8 40 0.5 1\n", {"a.quads:1"});
  bad("10 10 0.5 1  0 0 0.5 0  42 44 0.5 1  8 40 0.5 1\n", {"a.quads:1"});
  bad("1e-30 0 0 0  10 0 0 1  42 44 0.5 1  8 40 0.5 1\n", {"a.quads:1", "quad 0, vertex 0"});
  bad(std::string("\n# two\n") + "10 10 0.5 1  40 12 0.5 1  42 44 0.5 1  8 40 0.5 1  1 2 3 400\n",
      {"a.quads:3", "quad 0, vertex 3", "attribute_int_bits"});
  bad(std::string(good_quad) + "10 10 0.5 1  40 12 0.5 1  42 44 0.5 1  8 40 0.5 1  1 2 3 4\n", {"a.quads:2"});
}

TEST_F(Cli, BadMeshesAndCameras) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const auto bad = [&](const std::string& text, const std::vector<std::string>& pieces) {
    write("a.obj", text);
    refuses(2, "render --mesh a.obj --png a.png", pieces);
  };
  bad(square + "f 1 2\n", {"a.obj:5"});
  bad(square + "f 1\n", {"a.obj:5"});
  bad(square + "f 1 2 9\n", {"a.obj:5", "9"});
  bad(square + "f 1 2 x 4\n", {"a.obj:5"});
  bad(square + "f 0 1 2\n", {"a.obj:5"});
  bad("v 0 0 nan\n", {"a.obj:1"});
  bad("v 0 zero 0\n", {"a.obj:1"});
  bad("", {"a.obj"});
  refuses(2, "render --mesh missing.obj --png a.png", {"missing.obj"});

  write("a.obj", square + "f 1 2 3 4\n");
  const auto camera = [&](const std::string& text, const std::vector<std::string>& pieces) {
    write("c.json", text);
    refuses(2, "render --mesh a.obj --camera c.json --png a.png", pieces);
  };
  camera("{", {"c.json"});
  camera(R"({"matrix": [1, 2, 3]})", {"c.json", "16"});
  camera(R"({"eye": [0, 0, 5]})", {"c.json"});
  camera(R"({"eye":[0,0,5],"target":[0,0,5],"up":[0,1,0],"fovy":40,"near":1,"far":9})", {"c.json"});
  refuses(2, "render --mesh a.obj --camera missing.json --png a.png", {"missing.json"});
  refuses(2, "render --mesh a.obj --texture missing.png --shade texture --png a.png", {"missing.png"});
  write("not.png", "not a picture");
  refuses(2, "render --mesh a.obj --texture not.png --shade texture --png a.png", {"not.png"});

  write("five.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n");
  refuses(2, "render --strict --mesh five.obj --png a.png", {"5 corners"});
  EXPECT_EQ(run("render --mesh five.obj --png a.png --quiet").status, 0);
}

TEST_F(Cli, MissingNormalsAreSaid) {
  write("a.quads", good_quad);
  refuses(2, "render --quads a.quads --shade normal --png a.png", {"no normal"});
}

TEST_F(Cli, UnwritableOutputs) {
  refuses(2, "render --scene sphere --png missing/a.png", {"missing/a.png", "cannot be written"});
  refuses(2, "render --scene sphere --out .", {"directory"});
  refuses(2, "fragments --scene bowtie --out missing/a.csv", {"missing/a.csv"});
  refuses(2, "cosim --scene bowtie --json missing/a.json", {"missing/a.json"});
  refuses(2, "config --json missing/a.json", {"missing/a.json"});
  refuses(2, "config --emit-tables missing/a.sv", {"missing/a.sv"});
}

TEST_F(Cli, OldOutputsSurviveFailedRuns) {
  for (const char* name : {"a.exr", "a.png", "a.csv", "a.json"}) write(name, "old");
  write("a.quads", std::string(good_quad) + "1e-30 0 0 0  10 0 0 1  42 44 0.5 1  8 40 0.5 1\n");
  EXPECT_EQ(run("render --quads a.quads --out a.exr --png a.png --json a.json").status, 2);
  EXPECT_EQ(run("fragments --quads a.quads --out a.csv --json a.json").status, 2);
  for (const char* name : {"a.exr", "a.png", "a.csv", "a.json"}) EXPECT_EQ(read(file(name)), "old") << name;
  // A disk that is full for files of this size: the writer fails half-way.
  EXPECT_NE(
      run("render --scene sphere --size 256x256 --out a.exr --no-error --quiet", "ulimit -f 8; trap '' XFSZ;").status,
      0);
  EXPECT_EQ(read(file("a.exr")), "old");
  std::size_t entries = 0;
  for (const auto& entry : fs::directory_iterator(file(""))) entries += entry.path().extension() != ".quads" ? 1 : 0;
  EXPECT_EQ(entries, 6u) << "temporary files are left";  // the four, stdout, stderr
}

TEST_F(Cli, SameBytesForAnyNumberOfThreads) {
  const auto compare = [&](const std::string& arguments, const std::vector<std::string>& names) {
    SCOPED_TRACE(arguments);
    std::vector<std::string> first;
    for (const char* threads : {"1", "2", "4", "7"}) {
      const Outcome outcome = run(arguments + " --quiet --threads " + threads);
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (threads == std::string("1")) first.push_back(read(file(names[i])));
        ASSERT_FALSE(first[i].empty());
        EXPECT_EQ(read(file(names[i])), first[i]) << names[i] << " with " << threads << " threads";
      }
    }
  };
  for (const char* engine : {"model", "float", "truth"}) {
    for (const char* scene : {"sphere", "fig9_h", "phong_mesh"})
      compare(std::string("render --size 96x80 --out a.exr --png a.png --engine ") + engine + " --scene " + scene,
              {"a.exr", "a.png"});
    compare(std::string("fragments --size 64x64 --stress general --count 100 --out a.csv --engine ") + engine,
            {"a.csv"});
  }
}

TEST_F(Cli, ModelAgreesWithTruth) {
  ASSERT_EQ(run("render --scene bowtie --size 128x128 --out a.exr --json a.json --quiet").status, 0);
  const json report = json::parse(read(file("a.json")));
  EXPECT_GT(report["fragments"], 1000);
  EXPECT_GT(report["error_max"], 0.0);
  EXPECT_LE(report["error_max"], 0x1p-15);
}

TEST_F(Cli, FragmentTable) {
  write("a.quads",
        std::string("# one\n") + "10 10 0.5 1  20 10 0.5 1  20 20 0.5 1  10 20 0.5 1   0 0  1 0  1 1  0 1\n");
  for (const char* engine : {"model", "float", "truth"}) {
    const Outcome outcome = run(std::string("fragments --size 64x64 --quads a.quads --out - --engine ") + engine);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out.substr(0, outcome.out.find('\n')), "quad,x,y,front,flags,l0,l1,l2,l3,z,a0,a1");
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 101);
  }
  const Outcome one = run("fragments --size 64x64 --quads a.quads --out - --pixel 10,10 --no-depth --quad 0");
  EXPECT_EQ(std::count(one.out.begin(), one.out.end(), '\n'), 2);
  EXPECT_NE(one.out.find(",,"), std::string::npos) << "z is empty with depth off";
  EXPECT_EQ(one.err, "");
  const Outcome none = run("fragments --size 64x64 --quads a.quads --out - --pixel 40,41");
  EXPECT_EQ(std::count(none.out.begin(), none.out.end(), '\n'), 1);
  EXPECT_NE(none.err.find("no fragments at pixel 40,41"), std::string::npos) << none.err;
  // More attributes than the machine's slots, and weights where slots are few.
  write("b.quads",
        "10 10 0.5 1  20 10 0.5 1  20 20 0.5 1  10 20 0.5 1   0 0 1 2 3 4  1 0 1 2 3 4  1 1 1 2 3 4  0 1 1 2 3 4\n");
  EXPECT_EQ(run("fragments --size 64x64 --quads b.quads --out b.csv --quiet").status, 0);
  EXPECT_EQ(run("fragments --size 64x64 --quads b.quads --out c.csv --quiet --set attribute_slots=1").status, 0);
  EXPECT_EQ(run("fragments --size 64x64 --quads b.quads --out d.csv --quiet --set attribute_slots=8").status, 0);
  EXPECT_EQ(read(file("b.csv")), read(file("c.csv")));
  EXPECT_EQ(read(file("b.csv")), read(file("d.csv")));
}

TEST_F(Cli, Reports) {
  const auto fields = [&](const std::string& arguments, const std::vector<std::string>& names) {
    const Outcome outcome = run(arguments + " --json -");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json report = json::parse(outcome.out);
    for (const char* name : {"schema_version", "version", "config", "seed", "command"})
      EXPECT_TRUE(report.contains(name)) << name;
    for (const std::string& name : names) EXPECT_TRUE(report.contains(name)) << name;
  };
  fields("render --scene sphere --size 32x32 --png a.png", {"quads", "fragments", "undefined", "wall_seconds"});
  fields("fragments --scene sphere --size 32x32 --out a.csv", {"quads", "fragments", "undefined", "wall_seconds"});
  fields("config --set significand_bits=12", {"keys", "derived", "bounds"});
  fields("bench --no-rtl --repeat 1 --fragments 1000 --size 64x64 --quad-size 16", {"speed", "quads", "threads"});
  const json scenes = json::parse(run("scenes --json").out);
  ASSERT_TRUE(scenes.is_array());
  EXPECT_GE(scenes.size(), 8u);
  for (const json& scene : scenes)
    for (const char* name : {"name", "title", "paper", "quads"}) EXPECT_TRUE(scene.contains(name)) << name;
}

/// A square of 10 x 10 pixels, and one that a skip leaves out: the counters follow from that, whatever the command.
TEST_F(Cli, CountersOfAMachine) {
  write("a.quads",
        "10 10 0.5 1  20 10 0.5 1  20 20 0.5 1  10 20 0.5 1\n30 10 0.5 1  40 20 0.5 1  50 30 0.5 1  35 15 0.5 1\n");
  const std::string input = " --size 64x64 --quads a.quads --json a.json";
  for (const std::string& command : {"fragments --out a.csv" + input, "render --png a.png" + input}) {
    SCOPED_TRACE(command);
    const Outcome outcome = run(command);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json counters = json::parse(read(file("a.json"))).at("counters");
    EXPECT_EQ(counters.at("quads"), 2);
    EXPECT_EQ(counters.at("quads_ordinary"), 1);
    EXPECT_EQ(counters.at("quads_line"), 1);
    EXPECT_EQ(counters.at("fragments"), 100);
    EXPECT_EQ(counters.at("pixels_lane0"), 100);
    EXPECT_EQ(counters.at("stamps"), 10 + 10);  // rows of ten pixels in two tiles of eight
    EXPECT_NE(outcome.out.find("tiles 4 of 4"), std::string::npos) << outcome.out;
    // What is asked of the machine counts: with the skip off both quads are set up.
    ASSERT_EQ(run(command + " --skip none").status, 0);
    EXPECT_EQ(json::parse(read(file("a.json"))).at("counters").at("quads_ordinary"), 2);
    // No machine, no counters.
    for (const char* engine : {"float", "truth"}) {
      ASSERT_EQ(run(command + " --engine " + engine).status, 0);
      EXPECT_FALSE(json::parse(read(file("a.json"))).contains("counters")) << engine;
    }
  }
  ASSERT_EQ(run("render --png a.png --method mvc" + input).status, 0);
  EXPECT_FALSE(json::parse(read(file("a.json"))).contains("counters"));
  EXPECT_EQ(run("render --size 64x64 --quads a.quads --png a.png").out.find("counters"), std::string::npos);
  EXPECT_NE(run("render --size 64x64 --quads a.quads --png a.png --verbose").out.find("counters"), std::string::npos);

  const Outcome bench = run("bench --no-rtl --repeat 1 --fragments 1000 --size 64x64 --quad-size 16 --json b.json");
  ASSERT_EQ(bench.status, 0) << bench.err;
  EXPECT_GE(json::parse(read(file("b.json"))).at("counters").at("fragments"), 1000);
  EXPECT_NE(bench.out.find("clocks bound by pixels"), std::string::npos) << bench.out;
  const Outcome error = run("bench --error --no-rtl --repeat 1 --quads a.quads");
  EXPECT_NE(error.out.find("tiles 4 of 4"), std::string::npos) << error.out;
}

TEST_F(Cli, TablesGoToAFile) {
  ASSERT_EQ(run("config --emit-tables a.sv").status, 0);
  EXPECT_NE(read(file("a.sv")).find("package quadrille_tables_pkg"), std::string::npos);
  const Outcome markdown = run("config --markdown");
  EXPECT_NE(markdown.out.find("| `significand_bits` | 18 |"), std::string::npos);
  EXPECT_NE(read(QUADRILLE_SOURCE_DIR "/model/README.md").find(markdown.out), std::string::npos);
}

TEST_F(Cli, ConfigurationGoesToAFileAndBack) {
  write("cost.toml", "[cost]\nadder = 0.5\n");
  const Outcome all = run("config --config cost.toml --set significand_bits=24 --set quadratic_frac_bits=18 --toml");
  ASSERT_EQ(all.status, 0) << all.err;
  write("all.toml", all.out);
  EXPECT_EQ(run("config --config all.toml --toml").out, all.out);
  EXPECT_NE(all.out.find("adder = 0.5"), std::string::npos);
  const auto config = [&](const std::string& arguments) {
    return json::parse(run("config --json - " + arguments).out)["config"];
  };
  EXPECT_EQ(config("--config all.toml"), config("--set significand_bits=24 --set quadratic_frac_bits=18"));
  refuses(2, "config --toml --markdown", {"--toml"});
}

TEST_F(Cli, RemovedKeysAreReadWithANote) {
  const std::string note =
      "plane_tolerance_bits = 0 is no longer needed: quads nearly plane are no longer treated apart\n";
  write("old.toml", "depth_bits = 20\n\nplane_tolerance_bits = 0\n");
  const Outcome file = run("config --config old.toml");
  EXPECT_EQ(file.status, 0);
  EXPECT_EQ(file.err, "note: old.toml:3: " + note);
  const Outcome set = run("config --set plane_tolerance_bits=0");
  EXPECT_EQ(set.status, 0);
  EXPECT_EQ(set.err, "note: " + note);
  EXPECT_EQ(run("config --quiet --set plane_tolerance_bits=0").err, "");
  for (const char* value : {"10", "31"})
    refuses(2, "config --set plane_tolerance_bits=" + std::string(value),
            {"plane_tolerance_bits = " + std::string(value), "the tolerance was removed", "set plane_quads = 1"});
}

TEST_F(Cli, NoVerilator) {
  const Outcome outcome = run("cosim --scene bowtie", "PATH=/nonexistent QUADRILLE_CACHE=cache");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.err.rfind("quadrille: ", 0), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find("verilator"), std::string::npos) << outcome.err;
}

}  // namespace
