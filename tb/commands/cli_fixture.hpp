// Runs the built program in a directory of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace quadrille::cli_test {

namespace fs = std::filesystem;

/// A line of a quads file.
inline constexpr const char* good_quad = "10 10 0.5 1  40 12 0.5 1  42 44 0.5 1  8 40 0.5 1\n";

inline std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

struct Outcome {
  int status = -1;
  std::string out, err;
};

class Cli : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "quadrille-cli-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
  }
  void TearDown() override {
    fs::permissions(directory_, fs::perms::owner_all, fs::perm_options::add);
    fs::remove_all(directory_);
  }

  fs::path file(const std::string& name) const { return directory_ / name; }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name).string();
  }

  /// The project's RTL in the folder rtl, with a fault.
  void spoil(const std::string& unit, const std::string& right, const std::string& wrong) const {
    fs::copy(fs::path(QUADRILLE_SOURCE_DIR) / "rtl", file("rtl"), fs::copy_options::recursive);
    std::string text = read(file("rtl/" + unit));
    ASSERT_NE(text.find(right), std::string::npos);
    text.replace(text.find(right), right.size(), wrong);
    write("rtl/" + unit, text);
  }

  /// `arguments` as a shell line, `environment` before the program.
  Outcome run(const std::string& arguments, const std::string& environment = {},
              const std::string& program = QUADRILLE_PROGRAM) const {
    const std::string out = file("stdout").string(), err = file("stderr").string();
    const std::string line = "cd '" + directory_.string() + "' && " + environment + " '" + program + "' " + arguments +
                             " >'" + out + "' 2>'" + err + "' </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  }

  /// A run that must fail with `status`, one line "quadrille: …" that contains every piece, and nothing on standard
  /// output.
  void refuses(int status, const std::string& arguments, const std::vector<std::string>& pieces) const {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("quadrille: ", 0), 0u) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& piece : pieces)
      EXPECT_NE(outcome.err.find(piece), std::string::npos) << piece << " in: " << outcome.err;
  }

 private:
  fs::path directory_;
};

}  // namespace quadrille::cli_test
