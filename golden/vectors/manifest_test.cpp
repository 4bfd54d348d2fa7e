// Sets on the disk: every damage is seen, and none of them crashes the reader.
#include "golden/vectors/manifest_test_support.hpp"
#include "model/port/latency.hpp"

namespace quadrille::vectors {
namespace {

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

TEST_F(Set, ARemovedKeyIsReadAtItsOffValueWithANote) {
  const auto change = [&](const std::string& from, const std::string& to) {
    for (const std::string suite : {"sqrt", "coverage", "depth"}) {
      replace_text("set/" + suite + "/manifest.json", from, to);
      sign(suite);
    }
    replace_text("set/manifest.json", from, to);
  };
  change("\"config\": {\n", "\"config\": {\n    \"plane_tolerance_bits\": 0,\n");
  EXPECT_GT(check(path("set")), 0u);
  const SetInfo info = SetReader(path("set")).info();
  EXPECT_EQ(info.config, Config());
  ASSERT_EQ(info.notes.size(), 1u);
  EXPECT_EQ(info.notes[0].find("config: plane_tolerance_bits = 0 is no longer needed"), 0u) << info.notes[0];
  change("plane_tolerance_bits\": 0", "plane_tolerance_bits\": 7");
  EXPECT_NE(complaint().find("plane_tolerance_bits = 7"), std::string::npos) << complaint();
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
  const std::string says = "\" differs from this program's for suite sqrt";
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
}  // namespace quadrille::vectors
