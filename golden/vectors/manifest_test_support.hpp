// What the tests of manifest share.
#pragma once

#include "golden/io/test_support.hpp"
#include "golden/vectors/manifest.hpp"
#include "golden/vectors/suite.hpp"
#include "model/support/prng.hpp"

#include <sys/stat.h>

#include <algorithm>

namespace quadrille::vectors {

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

}  // namespace quadrille::vectors
