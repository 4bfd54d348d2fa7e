#include "tb/device/verilate.hpp"

#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;

/// Sets an environment variable for the scope.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { setenv(name_, old_.c_str(), 1); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string old_;
};

/// An empty directory for the scope.
class Scratch {
 public:
  Scratch() : path(fs::path(testing::TempDir()) / ("quadrille_tb_" + std::to_string(getpid()))) {
    fs::create_directories(path);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const fs::path path;
};

TEST(Verilate, MissingVerilatorIsAnEnvironmentError) {
  const Scratch scratch;
  const Variable path("PATH", scratch.path.string());
  try {
    verilate(Config{});
    FAIL() << "no error";
  } catch (const EnvironmentError& error) {
    EXPECT_NE(std::string(error.what()).find("apt-get install verilator"), std::string::npos) << error.what();
  }
}

TEST(Verilate, MissingCompilerIsAnEnvironmentError) {
  const Scratch scratch;
  const fs::path verilator = find_program("verilator", "verilator");
  fs::create_symlink(verilator, scratch.path / "verilator");
  const Variable path("PATH", scratch.path.string());
  const Variable cxx("CXX", "");
  try {
    verilate(Config{});
    FAIL() << "no error";
  } catch (const EnvironmentError& error) {
    EXPECT_NE(std::string(error.what()).find("apt-get install g++"), std::string::npos) << error.what();
  }
}

TEST(Verilate, CacheThatCannotBeWritten) {
  const Scratch scratch;
  std::ofstream(scratch.path / "file") << "no directory";
  const Variable cache("QUADRILLE_CACHE", (scratch.path / "file" / "cache").string());
  EXPECT_THROW(cache_directory(), EnvironmentError);
}

TEST(Verilate, CacheDirectoryByPrecedence) {
  const Scratch scratch;
  const Variable home("HOME", (scratch.path / "home").string());
  {
    const Variable cache("QUADRILLE_CACHE", (scratch.path / "own").string());
    EXPECT_EQ(cache_directory(), scratch.path / "own");
  }
  const Variable cache("QUADRILLE_CACHE", "");
  {
    const Variable xdg("XDG_CACHE_HOME", (scratch.path / "xdg").string());
    EXPECT_EQ(cache_directory(), scratch.path / "xdg" / "quadrille");
  }
  const Variable xdg("XDG_CACHE_HOME", "");
  EXPECT_EQ(cache_directory(), scratch.path / "home" / ".cache" / "quadrille");
}

TEST(Verilate, BrokenSourceNamesTheLog) {
  const Scratch scratch;
  const Variable cache("QUADRILLE_CACHE", (scratch.path / "cache").string());
  std::ofstream(scratch.path / "broken.v") << "module quadrille(input clk_i); this is no Verilog endmodule\n";
  VerilateOptions options;
  options.source = scratch.path / "broken.v";
  try {
    verilate(Config{}, options);
    FAIL() << "no error";
  } catch (const VerilateError& error) {
    EXPECT_NE(std::string(error.what()).find(".log"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("broken.v"), std::string::npos) << error.what();
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(scratch.path / "cache")) {
    EXPECT_FALSE(entry.path().filename().string().starts_with("tmp.")) << entry.path();
    EXPECT_FALSE(entry.path().filename().string().starts_with("device-") && entry.is_directory()) << entry.path();
  }
}

TEST(Verilate, EveryKeyBecomesADefine) {
  Config config;
  config.set("significand_bits", 12);
  const std::vector<std::string> defines = key_defines(config);
  EXPECT_EQ(defines.size(), Config::keys().size());
  EXPECT_NE(std::find(defines.begin(), defines.end(), "-DQUADRILLE_SIGNIFICAND_BITS=12"), defines.end());
  EXPECT_NE(std::find(defines.begin(), defines.end(), "-DQUADRILLE_RSQRT_SEGMENTS_LOG2=-1"), defines.end());
}

TEST(Fingerprint, DependsOnEveryPieceAndOnTheirBorders) {
  const auto of = [](std::initializer_list<std::string_view> pieces) {
    Fingerprint f;
    for (const std::string_view piece : pieces) f.add(piece);
    return f.hex();
  };
  EXPECT_EQ(of({}), "6c62272e07bb014262b821756295c58d");  // the offset basis of FNV-1a with 128 bits
  EXPECT_EQ(of({"ab", "c"}), of({"ab", "c"}));
  EXPECT_NE(of({"ab", "c"}), of({"a", "bc"}));
  EXPECT_NE(of({"ab"}), of({"ab", ""}));
  EXPECT_NE(of({"ab"}), of({"aB"}));
}

TEST(Process, ParallelCommandsStopAtAFailure) {
  const Scratch scratch;
  const fs::path log = scratch.path / "all.log";
  const std::string sh = find_program("sh", "dash");
  const std::vector<std::vector<std::string>> good{{sh, "-c", "echo one"}, {sh, "-c", "echo two >&2"}};
  EXPECT_EQ(run_parallel(good, scratch.path, log, 2), 0);
  const std::string text = tail_of(log, 100);
  EXPECT_NE(text.find("one"), std::string::npos);
  EXPECT_NE(text.find("two"), std::string::npos);
  const std::vector<std::vector<std::string>> bad{{sh, "-c", "exit 3"}, {sh, "-c", "touch never"}};
  EXPECT_EQ(run_parallel(bad, scratch.path, log, 1), 3);
  EXPECT_FALSE(fs::exists(scratch.path / "never"));
}

TEST(SourcePaths, PackagesComeFirst) {
  const std::vector<fs::path> sources = rtl_sources(rtl_directory());
  ASSERT_FALSE(sources.empty());
  EXPECT_EQ(sources.front().filename(), "quadrille_pkg.sv");
}

}  // namespace
}  // namespace quadrille::tb
