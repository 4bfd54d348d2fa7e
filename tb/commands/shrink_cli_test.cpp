// cosim --shrink on RTL with a fault: what is left fails by the command that is printed, and is little.
#include "tb/commands/cli_fixture.hpp"

#include <cstdlib>
#include <string>

namespace {

using namespace quadrille::cli_test;
using CliShrink = Cli;

/// A quad, its pixel and no stall are left of a scene with stalls and gaps; the command fails, as the first run did,
/// and the same quads pass in the project's RTL.
TEST_F(CliShrink, FaultInAFixedPointBit) {
  fs::copy(fs::path(QUADRILLE_SOURCE_DIR) / "rtl", file("rtl"), fs::copy_options::recursive);
  std::string unit = read(file("rtl/fixed_point.sv"));
  const std::string right = "top_q >> distance_q[NEAR-1:0]";
  ASSERT_NE(unit.find(right), std::string::npos);
  unit.replace(unit.find(right), right.size(), "(" + right + ") & ~OUT'(4)");
  write("rtl/fixed_point.sv", unit);

  const std::string input =
      "cosim --scene bowtie --size 96x96 --stall 0.5 --gap 0.3 --seed 5 --no-snapping-error --quiet";
  const Outcome whole = run(input + " --rtl rtl --shrink less.quads");
  EXPECT_EQ(whole.status, 1) << whole.err;
  const std::size_t command = whole.err.find("\n  quadrille cosim --quads less.quads ");
  ASSERT_NE(command, std::string::npos) << whole.err;
  EXPECT_NE(whole.err.find("fails with 1 of 6 quads, in 1x1 pixels, "), std::string::npos) << whole.err;
  EXPECT_NE(whole.err.find(": less.fst"), std::string::npos) << whole.err;
  EXPECT_GT(fs::file_size(file("less.fst")), 1000u);

  const std::size_t begin = whole.err.find("cosim", command);
  const std::string less = whole.err.substr(begin, whole.err.find('\n', begin) - begin);
  EXPECT_EQ(less.find("--stall"), std::string::npos) << less;
  EXPECT_EQ(less.find("--gap"), std::string::npos) << less;
  const Outcome again = run(less + " --quiet");
  EXPECT_EQ(again.status, 1) << less << again.err;
  EXPECT_NE(again.err.find("stage fragment, field"), std::string::npos) << again.err;
  const std::string sound = less.substr(0, less.find(" --rtl"));
  EXPECT_EQ(run(sound + " --quiet").status, 0) << sound;
}

TEST_F(CliShrink, NothingIsWrittenWhereNothingFails) {
  EXPECT_EQ(run("cosim --scene bowtie --size 32x32 --shrink less.quads --quiet").status, 0);
  EXPECT_FALSE(fs::exists(file("less.quads")) || fs::exists(file("less.fst")));
  refuses(2, "cosim --shrink less.quads", {"--shrink", "one input"});
}

}  // namespace
