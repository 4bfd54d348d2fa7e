#include "tb/device/verilate.hpp"

#include "tb/device/scratch.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;

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

TEST(Verilate, MissingNinjaIsAnEnvironmentError) {
  const Scratch scratch;
  const fs::path bin = scratch.path / "bin";
  fs::create_directory(bin);
  for (const char* tool : {"verilator", "g++", "perl", "verilator_bin"})
    fs::create_symlink(find_program(tool, tool), bin / tool);
  const Variable path("PATH", bin.string());
  const Variable cxx("CXX", "");
  const Variable cache("QUADRILLE_CACHE", (scratch.path / "cache").string());
  std::ofstream(scratch.path / "empty.v") << "module quadrille(input clk_i); endmodule\n";
  VerilateOptions options;
  options.source = scratch.path / "empty.v";
  options.probes = false;
  try {
    verilate(Config{}, options);
    FAIL() << "no error";
  } catch (const EnvironmentError& error) {
    EXPECT_NE(std::string(error.what()).find("apt-get install ninja-build"), std::string::npos) << error.what();
  }
}

TEST(Verilate, BrokenSourceNamesTheLog) {
  const Scratch scratch;
  const Variable cache("QUADRILLE_CACHE", (scratch.path / "cache").string());
  std::ofstream(scratch.path / "broken.v") << "module quadrille(input clk_i); this is no Verilog endmodule\n";
  VerilateOptions options;
  options.source = scratch.path / "broken.v";
  EXPECT_THROW(verilate(Config{}, options), std::invalid_argument) << "probes of a machine in one file";
  options.probes = false;
  testing::internal::CaptureStderr();
  try {
    verilate(Config{}, options);
    ADD_FAILURE() << "no error";
  } catch (const VerilateError& error) {
    EXPECT_NE(std::string(error.what()).find(".log"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("broken.v"), std::string::npos) << error.what();
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(said.starts_with("quadrille: building the simulator of default without probes, RTL ")) << said;
  EXPECT_NE(said.find("0 of 4 steps, 0 s\n"), std::string::npos) << said;
  for (const fs::directory_entry& entry : fs::directory_iterator(scratch.path / "cache"))
    EXPECT_TRUE(entry.path().filename().string().starts_with("failed-device-")) << entry.path();
}

TEST(Verilate, BlanksInEveryPath) {
  const Scratch scratch;
  const fs::path folder = scratch.path / "a folder's \"name\" $x";
  fs::create_directories(folder / "rtl");
  const Variable cache("QUADRILLE_CACHE", (folder / "ca che").string());
  std::ofstream(folder / "rtl" / "quadrille.sv") << "module quadrille(input clk_i, rst_i); endmodule\n";
  VerilateOptions options;
  options.source = folder / "rtl";
  options.probes = false;
  options.arguments = {"-Werror-DECLFILENAME"};  // of a name that was cut off
  testing::internal::CaptureStderr();
  try {
    verilate(Config{}, options);
  } catch (const VerilateError& error) {
    // Verilator has read it and the compiler what it wrote: only the glue misses the machine's ports.
    EXPECT_NE(std::string(error.what()).find("compiling the Verilated machine failed"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("device_glue.cpp"), std::string::npos) << error.what();
  }
  testing::internal::GetCapturedStderr();
}

TEST(Verilate, EveryKeyBecomesADefine) {
  Config config;
  config.set("significand_bits", 12);
  const std::vector<std::string> defines = key_defines(config);
  EXPECT_EQ(defines.size(), Config::keys().size());
  EXPECT_NE(std::find(defines.begin(), defines.end(), "-DQUADRILLE_SIGNIFICAND_BITS=12"), defines.end());
  EXPECT_NE(std::find(defines.begin(), defines.end(), "-DQUADRILLE_SQRT_SEGMENTS_LOG2=-1"), defines.end());
}

TEST(Process, LinesAreHandedOnAndLogged) {
  const Scratch scratch;
  const fs::path log = scratch.path / "all.log";
  const std::string sh = find_program("sh", "dash");
  std::vector<std::string> lines;
  int ticks = 0;
  EXPECT_EQ(run_watched(
                std::vector<std::string>{sh, "-c", "echo one; echo two >&2; sleep 1.2; echo three; exit 3"},
                scratch.path, log, [&](std::string_view line) { lines.emplace_back(line); }, [&] { ++ticks; }),
            3);
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "three"}));
  EXPECT_GE(ticks, 3);
  for (const char* line : {"one", "two", "three"}) EXPECT_NE(tail_of(log, 100).find(line), std::string::npos) << line;
}

TEST(SourcePaths, PackagesComeFirst) {
  const std::vector<fs::path> sources = rtl_sources(rtl_directory());
  ASSERT_FALSE(sources.empty());
  EXPECT_EQ(sources.front().filename(), "quadrille_pkg.sv");
}

}  // namespace
}  // namespace quadrille::tb
