// Sets on the disk: every damage is seen, and none of them crashes the reader.
#include "golden/vectors/manifest.hpp"
#include "golden/io/test_support.hpp"
#include "golden/vectors/suite.hpp"
#include "model/port/latency.hpp"
#include "model/support/prng.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <map>

namespace {

using namespace quadrille;
using namespace quadrille::vectors;
namespace fs = std::filesystem;

/// A small set of three suites, and ways to damage it.
class Set : public golden::InDirectory {
 protected:
  static GenerateOptions options() {
    GenerateOptions o;
    o.limit = 30;
    return o;
  }
  static SetInfo info() { return {1, 1, Config{}, 30}; }

  void generate(const std::string& name, const std::vector<std::string>& suite_names, bool replace = false,
                unsigned threads = 1) const {
    SetWriter writer(path(name), info(), replace);
    for (const std::string& suite : suite_names) {
      GenerateOptions o = options();
      o.threads = threads;
      writer.add(find_suite(suite).info(), [&](SuiteWriter& out) { find_suite(suite).write(out, o); });
    }
    writer.commit(false);
  }
  void SetUp() override { generate("set", {"sqrt", "coverage", "depth"}); }

  /// Reads all of a set; the number of its vectors.
  static std::uint64_t check(const std::string& directory) {
    const SetReader set(directory);
    std::uint64_t lines = 0;
    for (const std::string& suite : set.suites()) lines += set.suite(suite).lines("stimulus");
    return lines;
  }
  /// The message of the InputError that reading the set must throw.
  std::string complaint() const {
    return golden::input_error_of([&] { check(path("set")); });
  }
  std::vector<std::string> all_files() const {
    std::vector<std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path("set")))
      if (entry.is_regular_file()) files.push_back(entry.path().string());
    std::ranges::sort(files);
    return files;
  }
  void replace_text(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = read(path(file));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(file, text.replace(at, from.size(), to));
  }
  /// Puts the right hash of a suite's changed manifest into the set's.
  void sign(const std::string& suite) const {
    nlohmann::ordered_json set = nlohmann::ordered_json::parse(read(path("set/manifest.json")));
    set["suites"][suite]["sha256"] = sha256(read(path("set/" + suite + "/manifest.json")));
    write("set/manifest.json", set.dump(2) + "\n");
  }
};

TEST_F(Set, ReadsBackWhatWasWritten) {
  const SetReader set(path("set"));
  EXPECT_EQ(set.suites(), (std::vector<std::string>{"sqrt", "coverage", "depth"}));
  EXPECT_EQ(set.info().level, 1);
  EXPECT_EQ(set.info().limit, 30u);
  EXPECT_EQ(set_command(info()), "quadrille golden generate --level 1 --seed 1 --limit 30");
  EXPECT_FALSE(set.says_complete());
  for (const std::string& name : set.suites()) {
    const SuiteReader reader = set.suite(name);
    EXPECT_EQ(reader.manifest()["command"], "quadrille golden generate --level 1 --seed 1 --limit 30 --suite " + name);
    EXPECT_NO_THROW(require_known(reader));
    EXPECT_GT(reader.lines("stimulus"), 20u);
    EXPECT_EQ(reader.lines("stimulus"), reader.lines("response"));
    const VerifyResult result = find_suite(name).verify(reader, 1);
    EXPECT_TRUE(result.ok()) << result.first_difference;
    EXPECT_EQ(result.vectors, reader.lines("stimulus"));
  }
}

TEST_F(Set, EverySingleBitIsGuarded) {
  const std::vector<std::string> files = all_files();
  ASSERT_EQ(files.size(), 1u + 3 * 3);
  std::vector<std::string> contents;
  for (const std::string& file : files) contents.push_back(read(file));
  golden::Prng prng(7);
  int detected = 0;
  for (int i = 0; i < 200; ++i) {
    const std::size_t f = static_cast<std::size_t>(i) % files.size();
    std::string damaged = contents[f];
    const std::size_t at = prng.below(damaged.size());
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << prng.below(8)));
    std::ofstream(files[f], std::ios::binary) << damaged;
    try {
      check(path("set"));
      ADD_FAILURE() << files[f] << ": a changed bit of byte " << at << " was not seen";
    } catch (const golden::InputError&) {
      ++detected;
    }
    std::ofstream(files[f], std::ios::binary) << contents[f];
  }
  EXPECT_EQ(detected, 200);
  EXPECT_GT(check(path("set")), 0u);
}

TEST_F(Set, DamageOfFilesIsNamed) {
  const std::string response = path("set/sqrt/response.hex");
  const std::string text = read(response);
  const std::size_t line = text.find('\n') + 1;

  write("set/sqrt/response.hex", text.substr(0, text.size() - line));
  EXPECT_NE(complaint().find("response.hex: has " + std::to_string(text.size() - line) + " bytes"), std::string::npos);
  std::string upper = text;
  upper[line + 3] = 'G';
  write("set/sqrt/response.hex", upper);
  EXPECT_EQ(complaint(), response + ":2: column 4 is not a lower-case hexadecimal digit");
  // One line longer, one shorter: as many bytes, as many lines.
  std::string shifted = text;
  shifted[2 * line - 1] = '0';
  shifted[2 * line] = '\n';
  write("set/sqrt/response.hex", shifted);
  EXPECT_EQ(complaint().find(response + ":2: has "), 0u);
  std::string joined = text;
  joined[2 * line - 1] = ' ';
  write("set/sqrt/response.hex", joined);
  EXPECT_EQ(complaint().find(response + ":2: has "), 0u);
  std::string endless = text;
  endless.back() = '0';
  write("set/sqrt/response.hex", endless);
  EXPECT_NE(complaint().find("has "), std::string::npos);
  write("set/sqrt/response.hex", text);

  fs::rename(response, path("elsewhere"));
  EXPECT_EQ(complaint(), response + ": is missing");
  fs::rename(path("elsewhere"), response);

  write("set/sqrt/notes.txt", "mine");
  EXPECT_EQ(complaint(), path("set/sqrt/notes.txt") + ": does not belong to the set");
  fs::remove(path("set/sqrt/notes.txt"));
  write("set/notes.txt", "mine");
  EXPECT_EQ(complaint(), path("set/notes.txt") + ": does not belong to the set");
  fs::remove(path("set/notes.txt"));
  fs::create_directory(path("set/other"));
  EXPECT_EQ(complaint(), path("set/other") + ": does not belong to the set");
  fs::remove(path("set/other"));
  fs::rename(path("set/depth"), path("depth"));
  EXPECT_EQ(complaint(), path("set/depth") + ": is missing");
  fs::rename(path("depth"), path("set/depth"));
  EXPECT_GT(check(path("set")), 0u);
}

TEST_F(Set, DamageOfManifestsIsNamed) {
  const std::string set = path("set/manifest.json"), text = read(set);
  const auto with = [&](const std::string& from, const std::string& to) {
    write("set/manifest.json", text);
    replace_text("set/manifest.json", from, to);
    return complaint();
  };
  // Sets from before vertices had bases, and from later on.
  for (const char* other : {"1", "3"})
    EXPECT_EQ(with("\"format\": 2", std::string("\"format\": ") + other),
              set + ": has format " + other + "; this program reads format 2 (golden/CONVERTING.md)");
  EXPECT_EQ(with("\"format\": 2,", ""), set + ": has no \"format\"");
  EXPECT_EQ(with("\"significand_bits\": 18", "\"significand_bits\": 19").find(set + ": "), 0u);
  EXPECT_EQ(with("\"significand_bits\": 18", "\"significand_bits\": 99").find(set + ": config: "), 0u);
  EXPECT_EQ(with("\"significand_bits\"", "\"significant_bits\"").find(set + ": config: unknown configuration key"), 0u);
  EXPECT_EQ(with("\"tile_slots_log2\": 2,\n    \"stamp_fifo_log2\": 3",
                 "\"stamp_fifo_log2\": 3,\n    \"tile_slots_log2\": 2"),
            set + ": config does not hold its keys in order");
  const std::string other = set + ": \"command\" does not generate this level, seed and configuration";
  EXPECT_EQ(with("\"seed\": 1", "\"seed\": 3"), other);
  EXPECT_EQ(with("--seed 1", "--seed 01"), other);
  EXPECT_EQ(with("--limit 30", "--limit 30 --set significand_bits=12"), other);
  EXPECT_NE(with("--limit 30", "--limit 30 --set significand_bits=18"), "") << "the default is not spelled";
  EXPECT_EQ(with("quadrille golden generate", "rm -rf"), set + ": \"command\" is not \"quadrille golden generate\"");
  EXPECT_EQ(with("--suite coverage", "--suite weights"), set + ": \"command\" generates other suites than the set has");
  EXPECT_EQ(with("quadrille 0", "gremlin 0").find(set + ": \"generator\" is \"gremlin 0"), 0u);
  EXPECT_EQ(with("\"seed\": 1", "\"seed\": 1.5"), set + ": \"seed\" is not a whole number from 0");
  EXPECT_EQ(with("\"seed\": 1", "\"seed\": -1"), set + ": \"seed\" is not a whole number from 0");
  EXPECT_EQ(with("\"level\": 1", "\"level\": 7"), set + ": \"level\" is not a whole number from 1 to 2");
  EXPECT_EQ(with("--limit 30", "--limit 31"), set + ": \"command\" differs from that of suite sqrt");
  EXPECT_EQ(with("\"sqrt\"", "\"../sqrt\""), set + ": \"../sqrt\" is no name of a suite");
  EXPECT_EQ(with("  \"seed\"", " \"seed\"").find(set + ":4: "), 0u);
  EXPECT_EQ(with("{", "{\n  \"more\": 1,"), set + ": has \"more\", which is unknown in format 2");
  EXPECT_EQ(with("{", "[").find(set + ":"), 0u);
  write("set/manifest.json", "{}\n");
  EXPECT_EQ(complaint(), set + ": has no \"format\"");
  write("set/manifest.json", "");
  EXPECT_EQ(complaint().find(set + ":1: is not JSON"), 0u);
  write("set/manifest.json", std::string(100000, '['));
  EXPECT_EQ(complaint().find(set + ":"), 0u);
  fs::remove(set);
  EXPECT_NE(complaint().find(set), std::string::npos);
  EXPECT_NE(golden::input_error_of([&] { check(path("nowhere")); }).find("is no directory"), std::string::npos);
}

// A key that was added later is not in a set made before: it has its default.
TEST_F(Set, KeysThatItDoesNotNameHaveTheirDefaults) {
  const auto without = [&](const std::string& key) {
    for (const char* file : {"sqrt", "coverage", "depth"}) {
      const std::string manifest = "set/" + std::string(file) + "/manifest.json";
      replace_text(manifest, key, "");
      sign(file);
    }
    replace_text("set/manifest.json", key, "");
  };
  without("    \"stamp_fifo_log2\": 3,\n");
  EXPECT_GT(check(path("set")), 0u);
  EXPECT_EQ(SetReader(path("set")).info().config, Config());
  EXPECT_NO_THROW(require_known(SetReader(path("set")).suite("sqrt")));
  // Not where one of them names it.
  replace_text("set/manifest.json", "    \"tile_slots_log2\": 2,\n", "");
  EXPECT_EQ(complaint(), path("set/manifest.json") + ": \"config\" differs from that of suite sqrt");
}

// A set whose hashes are right but whose contents are not: what someone else's generator may write.
TEST_F(Set, ConsistentNonsenseIsRefused) {
  const std::string manifest = path("set/sqrt/manifest.json"), text = read(manifest),
                    top = read(path("set/manifest.json"));
  const auto with = [&](const std::string& from, const std::string& to) {
    write("set/sqrt/manifest.json", text);
    write("set/manifest.json", top);
    replace_text("set/sqrt/manifest.json", from, to);
    sign("sqrt");
    return complaint();
  };
  EXPECT_EQ(with("\"position\": 0", "\"position\": 1").find(manifest + ": the fields of record"), 0u);
  EXPECT_EQ(with("\"width\": 18", "\"width\": 0"), manifest + ": \"width\" is not a whole number from 1 to 64");
  EXPECT_EQ(with("\"width\": 18", "\"width\": 19").find(manifest + ": the fields of record"), 0u);
  EXPECT_EQ(with("\"bits\": 120", "\"bits\": 121").find(manifest + ": record stimulus has 120 bits of fields"), 0u);
  EXPECT_EQ(with("\"suite\": \"sqrt\"", "\"suite\": \"depth\""),
            manifest + ": is the manifest of \"depth\", not of sqrt");
  EXPECT_EQ(
      with("\"file\": \"stimulus.hex\"", "\"file\": \"../x\"").find(manifest + ": record \"stimulus\" has no file"),
      0u);
  EXPECT_EQ(with("\"response.hex\": {", "\"other.hex\": {").find(path("set/sqrt/")), 0u);
  EXPECT_EQ(with("\"title\"", "\"notes\": 1,\n  \"title\""),
            manifest + ": has \"notes\", which is unknown in format 2");
  EXPECT_EQ(with("--suite sqrt", "--suite depth"), manifest + ": \"command\" is not that of suite sqrt");
  // What a reader takes, but is not what this program says of the suite.
  const auto known = [&](const std::string& from, const std::string& to) {
    write("set/sqrt/manifest.json", text);
    write("set/manifest.json", top);
    replace_text("set/sqrt/manifest.json", from, to);
    sign("sqrt");
    return golden::input_error_of([&] { require_known(SetReader(path("set")).suite("sqrt")); });
  };
  const std::string says = "\" is not what this program says of suite sqrt";
  EXPECT_EQ(known("\"kind\": \"stage\"", "\"kind\": \"machine\""), manifest + ": \"kind" + says);
  EXPECT_EQ(known("\"latency\": " + std::to_string(latency::sqrt_stages), "\"latency\": 99"),
            manifest + ": \"latency" + says);
  EXPECT_EQ(known("\"module\": \"sqrt\"", "\"module\": \"rsqrx\""), manifest + ": \"module" + says);
  EXPECT_EQ(known("\"title\": \"S", "\"title\": \"s"), manifest + ": \"title" + says);
  EXPECT_EQ(known("\"contract\": \"a", "\"contract\": \"A"), manifest + ": \"contract" + says);
  EXPECT_EQ(known("\"corner\": 10", "\"corner\": 11").find(manifest + ": \"counts\" should be {"), 0u);
  EXPECT_EQ(known("\"random\": 10", "\"random\": 9").find(manifest + ": \"counts\" should be {"), 0u);
  EXPECT_EQ(known("\"vectors\": ", "\"more\": 1,\n    \"vectors\": ").find(manifest + ": \"counts\" should be {"), 0u);

  EXPECT_EQ(with("\"VAL_BITS\": 63", "\"VAL_BITS\": 62"), manifest + ": \"derived\" does not follow from \"config\"");

  // A wrong response with all hashes right is for verify to find.
  write("set/sqrt/manifest.json", text);
  std::string response = read(path("set/sqrt/response.hex"));
  const std::size_t digits = response.find('\n');
  char& digit = response[2 * (digits + 1) + digits - 1];  // line 3, the lowest digit: sig[0]
  digit = digit == '0' ? '1' : '0';
  const std::string old_hash = sha256(read(path("set/sqrt/response.hex")));
  write("set/sqrt/response.hex", response);
  replace_text("set/sqrt/manifest.json", old_hash, sha256(response));
  sign("sqrt");
  const VerifyResult result = find_suite("sqrt").verify(SetReader(path("set")).suite("sqrt"), 2);
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.mismatches, 1u);
  EXPECT_EQ(result.first_difference.find(path("set/sqrt/response.hex") + ":3: sig[0]: expected "), 0u)
      << result.first_difference;
}

// Any bytes at all in the place of a manifest, rightly signed: an InputError or a set that reads, never a crash.
TEST_F(Set, FuzzedManifests) {
  const std::string names[] = {"set/manifest.json", "set/sqrt/manifest.json"};
  const std::string top = read(path(names[0]));
  golden::Prng prng(3);
  const std::string_view pieces[] = {
      "{",  "}",  "[",    "]",       ",",    ":", "\"",   "null",     "-1", "1e999", "18446744073709551616",
      "{}", "[]", "true", "\\u0000", "\xff", "0", "\"\"", "999999999"};
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    const std::string& name = names[i % 2];
    const std::string original = read(path(name));
    std::string text = original;
    for (std::uint64_t n = 1 + prng.below(4); n > 0; --n) {
      const std::size_t at = prng.below(text.size());
      switch (prng.below(4)) {
        case 0:
          text.erase(at, prng.below(40));
          break;
        case 1:
          text.insert(at, pieces[prng.below(std::size(pieces))]);
          break;
        case 2:
          text[at] = static_cast<char>(prng.next());
          break;
        default: {  // another value in the place of one
          const std::size_t colon = text.find(": ", at);
          if (colon == std::string::npos) break;
          const std::size_t end = text.find_first_of(",\n", colon);
          text.replace(colon + 2, end - colon - 2, pieces[prng.below(std::size(pieces))]);
        }
      }
      if (text.empty()) text = " ";
    }
    // Written as a manifest is, where it is JSON, so that the reader gets beyond the spelling.
    const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
    if (!json.is_discarded()) text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    write(name, text);
    if (i % 2 == 1) sign("sqrt");
    try {
      check(path("set"));
    } catch (const golden::InputError&) {
      ++refused;
    }
    write(name, original);
    write(names[0], top);
  }
  EXPECT_GT(refused, 500);
}

TEST_F(Set, NothingIsReplacedUnasked) {
  const std::string before = read(path("set/manifest.json"));
  EXPECT_NE(golden::input_error_of([&] { generate("set", {"sqrt"}); }).find("--force"), std::string::npos);
  EXPECT_EQ(read(path("set/manifest.json")), before);
  generate("set", {"sqrt"}, true);
  EXPECT_EQ(SetReader(path("set")).suites(), std::vector<std::string>{"sqrt"});
  // What is no set stays, even when asked to replace it.
  write("set/thesis.txt", "mine");
  EXPECT_NE(golden::input_error_of([&] { generate("set", {"sqrt"}, true); }).find("does not belong"),
            std::string::npos);
  EXPECT_EQ(read(path("set/thesis.txt")), "mine");
  fs::remove(path("set/thesis.txt"));
  write("set/sqrt/thesis.txt", "mine");
  EXPECT_NE(golden::input_error_of([&] { generate("set", {"sqrt"}, true); }), "");
  EXPECT_EQ(read(path("set/sqrt/thesis.txt")), "mine");
  fs::create_directory(path("other"));
  write("other/file", "mine");
  EXPECT_NE(golden::input_error_of([&] { generate("other", {"sqrt"}, true); }), "");
  fs::create_directory(path("empty"));
  generate("empty", {"sqrt"});
  EXPECT_EQ(check(path("empty")), check(path("empty")));
}

TEST_F(Set, AnUnfinishedSetLeavesNothing) {
  const std::size_t before = entries();
  {
    SetWriter writer(path("new"), info(), false);
    writer.add(find_suite("sqrt").info(), [&](SuiteWriter& out) { find_suite("sqrt").write(out, options()); });
  }
  EXPECT_EQ(entries(), before);
  SetWriter empty(path("new"), info(), false);
  EXPECT_NE(golden::input_error_of([&] { empty.commit(false); }).find("no suite"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("new")));
}

// Two runs that found the name free: the set that is there first stays.
TEST_F(Set, ASetThatAppearsMeanwhileIsNotReplaced) {
  SetWriter late(path("new"), info(), false);
  late.add(find_suite("depth").info(), [&](SuiteWriter& out) { find_suite("depth").write(out, options()); });
  generate("new", {"sqrt"});
  const std::string message = golden::input_error_of([&] { late.commit(false); });
  EXPECT_EQ(message.find(path("new") + ": was written by another run"), 0u) << message;
  EXPECT_EQ(SetReader(path("new")).suites(), std::vector<std::string>{"sqrt"});
  // With --force the last one wins, whole.
  SetWriter forced(path("new"), info(), true);
  forced.add(find_suite("depth").info(), [&](SuiteWriter& out) { find_suite("depth").write(out, options()); });
  generate("new", {"coverage"}, true);
  forced.commit(false);
  EXPECT_EQ(SetReader(path("new")).suites(), std::vector<std::string>{"depth"});
}

TEST_F(Set, LinksLeadToTheSetAndNotOutOfIt) {
  fs::create_directory(path("target"));
  fs::create_directory_symlink("target", path("link"));
  generate("link", {"sqrt"});
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(SetReader(path("target")).suites(), std::vector<std::string>{"sqrt"});
  generate("link", {"depth"}, true);
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(check(path("link")), check(path("target")));
  fs::create_directory_symlink("nothing", path("dangling"));
  EXPECT_EQ(golden::input_error_of([&] { generate("dangling", {"sqrt"}); }),
            path("dangling") + ": is a symbolic link to nothing");

  for (const char* name : {"set/sqrt/response.hex", "set/sqrt/manifest.json", "set/depth", "set/manifest.json"}) {
    fs::rename(path(name), path("outside"));
    fs::create_symlink(path("outside"), path(name));
    EXPECT_EQ(complaint().find(path(name) + ": "), 0u) << complaint();
    fs::remove(path(name));
    fs::rename(path("outside"), path(name));
  }
  EXPECT_GT(check(path("set")), 0u);
}

TEST_F(Set, OnlyRegularFilesAreOpened) {
  for (const char* name : {"set/sqrt/response.hex", "set/sqrt/manifest.json", "set/manifest.json"}) {
    fs::rename(path(name), path("outside"));
    ASSERT_EQ(::mkfifo(path(name).c_str(), 0600), 0);
    EXPECT_EQ(complaint().find(path(name) + ": "), 0u);
    fs::remove(path(name));
    fs::rename(path("outside"), path(name));
  }
}

TEST_F(Set, TheCurrentDirectoryIsNotReplaced) {
  const fs::path before = fs::current_path();
  fs::create_directories(path("here/below"));
  fs::current_path(path("here/below"));
  for (const char* name : {".", "..", "../"})
    EXPECT_NE(golden::input_error_of([&] { SetWriter(name, info(), false); }).find("holds the current directory"),
              std::string::npos);
  fs::current_path(before);
}

TEST_F(Set, ASuiteIsNoSet) {
  EXPECT_EQ(golden::input_error_of([&] { SetReader(path("set/sqrt")); }),
            path("set/sqrt/manifest.json") + ": is the manifest of one suite; expected its set, the directory above");
}

TEST_F(Set, FilesBesideTheRecordsAreGuardedToo) {
  SetWriter writer(path("pictures"), info(), false);
  SuiteInfo suite{"pictures", "machine", "t", "quadrille", 0, ""};
  writer.add(suite, [&](SuiteWriter& out) {
    RecordLayout layout;
    layout.add({.name = "n", .width = 5});
    out.add_record("stimulus", layout);
    out.write("stimulus", Record(5));
    std::ofstream(out.add_file("image_0.exr"), std::ios::binary) << "any bytes";
    out.set_count("vectors", 1);
    out.set_count("draws", 1);
  });
  writer.commit(false);
  EXPECT_EQ(SetReader(path("pictures")).suite("pictures").manifest()["counts"]["draws"], 1);
  write("pictures/pictures/image_0.exr", "any bytez");
  EXPECT_NE(golden::input_error_of([&] { check(path("pictures")); }).find("image_0.exr: is not the file"),
            std::string::npos);
}

TEST(Suites, UnknownNamesTheNearest) {
  const std::string message = golden::input_error_of([] { find_suite("weigths"); });
  EXPECT_EQ(message, "unknown suite \"weigths\"; did you mean \"weights\"?");
}

}  // namespace
