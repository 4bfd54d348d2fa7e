// Depth limits and ranges of attributes through the program: a sky, a ramp through a limit, coordinates of large tiles.
#include "tb/commands/cli_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace quadrille::cli_test {
namespace {

using nlohmann::json;

std::ptrdiff_t rows(const std::string& csv) {
  return std::max<std::ptrdiff_t>(0, std::count(csv.begin(), csv.end(), '\n') - 1);
}

/// 100 × 100 pixels of these depths at the lower left, lower right, upper right and upper left.
std::string square(const std::string& a, const std::string& b, const std::string& c, const std::string& d,
                   const std::string& attributes = "  0 0 1 0 1 1 0 1") {
  return "14 114 " + a + " 1  114 114 " + b + " 1  114 14 " + c + " 1  14 14 " + d + " 1" + attributes + "\n";
}

TEST_F(Cli, QuadsOnADepthLimitAreWhole) {
  write("sky.quads", square("1", "1", "1", "1"));
  write("half.quads", square("0.5", "0.5", "0.5", "0.5"));
  for (const std::string engine : {"model", "truth"}) {
    const std::string fragments = "fragments --size 128x128 --out - --engine " + engine;
    EXPECT_EQ(rows(run(fragments + " --quads sky.quads").out), 10'000) << engine;
    EXPECT_EQ(rows(run(fragments + " --quads half.quads --znear 0.5 --zfar 0.5").out), 10'000) << engine;
    EXPECT_EQ(rows(run(fragments + " --quads half.quads --znear 0.500001").out), 0) << engine;
  }
}

/// Weights and attributes are drawn in passes of their own; a limit within the quad cuts each alike.
TEST_F(Cli, ARampThroughALimitIsAPicture) {
  write("ramp.quads", square("0.25", "0.75", "0.75", "0.25"));
  for (const std::string skip : {"none", "plane", "all"})
    for (const std::string shade : {"lambda", "depth", "quad"}) {
      const Outcome drawn = run("render --quads ramp.quads --size 128x128 --zfar 0.5 --png p.png --json - --shade " +
                                shade + " --skip " + skip + " --set plane_quads=1");
      EXPECT_EQ(drawn.status, 0) << drawn.err;
    }
  EXPECT_EQ(run("render --scene sprites --size 128x128 --set plane_quads=1 --skip plane --zfar 0.5 --png p.png").status,
            0);
}

TEST_F(Cli, AttributesMayBeFarFromZero) {
  write("far.quads", square("0.5", "0.5", "0.5", "0.5", "  100 -100 100.01 -100 100.01 -100.01 100 -100.01"));
  const std::string csv = run("fragments --quads far.quads --size 128x128 --out -").out;
  EXPECT_EQ(rows(csv), 10'000);
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  ASSERT_NE(line.find(",a0,a1"), std::string::npos) << line;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::vector<double> numbers;
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::strtod(cell.c_str(), nullptr));
    const double x = numbers[1], y = numbers[2], u = numbers[numbers.size() - 2], v = numbers.back();
    // Linear on a square: a pixel is 0.0001, the error of 18 bits a fiftieth of that at most.
    ASSERT_NEAR(u, 100 + 0.0001 * (x + 0.5 - 14), 1e-6) << line;
    ASSERT_NEAR(v, -100 - 0.0001 * (114 - y - 0.5), 1e-6) << line;
  }
  write("beyond.quads", square("0.5", "0.5", "0.5", "0.5", "  128 0 128 0 128 0 128 0"));
  refuses(2, "fragments --quads beyond.quads --size 128x128 --out a.csv", {"beyond.quads:1", "attribute_int_bits = 7"});
}

/// The approaches to values: the model is within its bound from the whole range to one code and to none.
TEST_F(Cli, StressWalksTowardsConstantValues) {
  const Outcome outcome =
      run("stress --families value_spread,depth_limit,guard_band_flat --count 12 --engines float --json -");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  ASSERT_EQ(report["families"].size(), 3u);
  std::size_t steps = 0;
  for (const json& step : report["errors"]) {
    if (step["engine"] != "model") continue;
    ++steps;
    EXPECT_EQ(step["beyond"], 0) << step;
  }
  EXPECT_EQ(2 * steps, report["errors"].size());  // the others are of the paper's formulas
  EXPECT_GT(steps, 3u);
  refuses(2, "stress --families value_spread --set attribute_int_bits=6",
          {"value_spread has attributes up to 127", "attribute_int_bits = 6", "--families"});
}

}  // namespace
}  // namespace quadrille::cli_test
