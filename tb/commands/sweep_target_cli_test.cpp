// --target-error of quadrille sweep as a user runs it: the search, what confirms it, and what stands beside the target.
#include "tb/commands/sweep_fixture.hpp"

#include <cmath>
#include <cstdlib>

namespace {

using namespace quadrille::cli_test;

TEST_F(SweepCli, TargetsAreSearched) {
  const std::string grid = std::string(small) + "--axis significand_bits=8:26 --axis align_guard_bits=0:3 ";
  const Outcome found = run("sweep --target-error lambda=2^-12" + grid + "--no-confirm --out t");
  ASSERT_EQ(found.status, 0) << found.err;
  const json search = manifest("t").at("search");
  EXPECT_EQ(manifest("t").at("knees").size(), 0u);
  EXPECT_NE(manifest("t").at("no_knee").get<std::string>().find("of 76 points"), std::string::npos) << "a sample";
  ASSERT_EQ(run("sweep --target-error lambda=2^-12 --exhaustive" + grid + "--no-confirm --out e").status, 0);
  EXPECT_EQ(search.at("winner"), manifest("e").at("search").at("winner"));
  EXPECT_LT(search.at("evaluations"), 40);
  EXPECT_EQ(manifest("e").at("search").at("evaluations"), 76);
  // The rows that the search evaluated are those of the whole grid.
  std::map<std::string, std::string> whole;
  for (const auto& row : table(file("e") / "points.csv")) whole[row.at("row")] = row.at("arithmetic_lambda_max");
  EXPECT_EQ(whole.size(), 76u);
  const Table evaluated = table(file("t") / "points.csv");
  EXPECT_EQ(evaluated.size(), search.at("evaluations"));
  for (const auto& row : evaluated) EXPECT_EQ(row.at("arithmetic_lambda_max"), whole.at(row.at("row")));

  const Outcome unreachable = run("sweep --target-error lambda=2^-40" + grid + "--no-confirm --out u");
  EXPECT_EQ(unreachable.status, 1);
  EXPECT_NE(unreachable.err.find("no point meets the target; closest: row "), std::string::npos) << unreachable.err;
}

/// All three errors beside the target, those of points.csv; the key is one that the same sweep by --set bears out.
TEST_F(SweepCli, TheTotalAndWhatIsInTheWayStandBesideATarget) {
  const std::string target =
      "sweep --scene sphere --size 64x64 --cosim none --no-cycles --axis significand_bits=12,14 ";
  const auto parts = [&](const std::string& out) { return manifest(out).at("search").at("targets").at(0); };
  const auto found = [&](const std::string& out) {
    const std::string row = std::to_string(manifest(out).at("search").at("row").get<int>());
    for (const auto& cells : table(file(out) / "points.csv"))
      if (cells.at("row") == row) return cells;
    return std::map<std::string, std::string>();
  };
  // Without perspective, so that there are families that say nothing.
  const Outcome confirmed =
      run(target + "--no-perspective --set subpixel_bits=5 --target-error colour=0.5/255 --out c");
  ASSERT_EQ(confirmed.status, 0) << confirmed.err;
  const json c = parts("c");
  const auto row = found("c");
  double sum = 0;
  for (const char* kind : {"arithmetic", "snapping"}) {
    EXPECT_EQ(c.at(kind).get<double>(), std::stod(row.at(std::string(kind) + "_colour_max"))) << kind;
    sum += c.at(kind).get<double>();
  }
  EXPECT_EQ(c.at("total").get<double>(), sum);
  ASSERT_GT(sum, c.at("limit").get<double>());
  EXPECT_EQ(c.at("in_the_way"), "snapping");
  const json families = manifest("c").at("search").at("families");
  std::string silent;
  std::size_t speak = 0;
  for (const json& family : families) {
    EXPECT_EQ(family.at("measured").get<bool>(), !family.at("error_over_target").is_null()) << family;
    if (!family.at("measured").get<bool>()) {
      silent += (silent.empty() ? "" : ", ") + family.at("family").get<std::string>();
      continue;
    }
    ++speak;
    // What is to be pasted draws as the family was drawn.
    EXPECT_NE(family.at("worst").get<std::string>().find(" --no-perspective "), std::string::npos) << family;
  }
  EXPECT_NE((", " + silent + ",").find(", eye_crossing,"), std::string::npos) << "all its quads are partly behind";
  EXPECT_NE((", " + silent + ",").find(", eye_in_hull,"), std::string::npos) << silent;
  EXPECT_NE(confirmed.out.find("arithmetic_colour_max confirmed on " + std::to_string(speak) + " of " +
                               std::to_string(families.size()) + " stress families (not measured on " + silent + ")"),
            std::string::npos)
      << confirmed.out;
  const std::string verdict = c.at("verdict");
  EXPECT_GT(confirmed.out.find(verdict), confirmed.out.find("confirmed on")) << confirmed.out;
  EXPECT_NE(confirmed.out.find(verdict), std::string::npos) << confirmed.out;
  char steps[64];
  std::snprintf(steps, sizeof steps, "%.3g times colour=0.5/255, %.2g steps of 8 bits", sum / (0.5 / 255), sum * 255);
  EXPECT_NE(verdict.find(steps), std::string::npos) << steps << " in: " << verdict;
  EXPECT_EQ(c.at("remedy").at("change"), "subpixel_bits=6");
  ASSERT_EQ(
      run("sweep --scene sphere --size 64x64 --cosim none --no-cycles --no-perspective --set subpixel_bits=6 --axis "
          "significand_bits=" +
          row.at("significand_bits") + " --out r")
          .status,
      0);
  const auto remedied = table(file("r") / "points.csv").at(0);
  EXPECT_EQ(c.at("remedy").at("part").get<double>(), std::stod(remedied.at("snapping_colour_max")));
  EXPECT_EQ(c.at("remedy").at("total").get<double>(), std::stod(remedied.at("total_colour_max")));
  EXPECT_LT(std::stod(remedied.at("snapping_colour_max")), std::stod(row.at("snapping_colour_max")));

  // No key is left: the position has all its fraction bits.
  const Outcome finest = run(target + "--target-error attribute=2^-12 --no-confirm --out n");
  ASSERT_EQ(finest.status, 0) << finest.err;
  EXPECT_EQ(parts("n").at("in_the_way"), "snapping");
  EXPECT_TRUE(parts("n").at("remedy").is_null());
  EXPECT_NE(finest.out.find("no key lowers it by a tenth: subpixel_bits cannot grow beyond 8"), std::string::npos)
      << finest.out;
  EXPECT_NE(finest.out.find("--no-confirm"), std::string::npos);

  const Outcome met = run(target + "--target-error colour=0.5 --no-confirm --out m");
  EXPECT_TRUE(parts("m").at("in_the_way").is_null());
  EXPECT_NE(met.out.find("The total error meets colour=0.5 too"), std::string::npos) << met.out;

  // Vertices on the grid: nothing is snapped.
  write("on_grid.quads", "4 4 0.5 1  40 8 0.5 1  44 44 0.5 1  8 40 0.5 1\n");
  const Outcome arithmetic = run(
      "sweep --quads on_grid.quads --size 48x48 --cosim none --no-cycles --axis significand_bits=12,14 --target-error "
      "lambda=2^-20 --no-confirm --out g");
  EXPECT_EQ(arithmetic.status, 1);
  EXPECT_LT(parts("g").at("snapping").get<double>(), 0x1p-50) << "two ways to the same exact weights, in double";
  EXPECT_EQ(parts("g").at("in_the_way"), "arithmetic");
  EXPECT_EQ(parts("g").at("remedy").at("change"), "significand_bits=15");
}

TEST_F(SweepCli, TheClosestIsTheClosest) {
  const std::string sweep = "sweep --exhaustive --no-confirm --no-cycles" + std::string(small) +
                            "--axis significand_bits=10:20:2 --axis align_guard_bits=0,2 ";
  for (const char* limit : {"2^-10", "2^-40"}) {
    const std::string out = std::string("out") + limit;
    run(sweep + "--target-error lambda=" + limit + " --out '" + out + "'");
    const json search = manifest(out).at("search");
    std::string closest;
    double least = 1e9;
    for (const auto& row : table(file(out) / "points.csv")) {
      const double distance = std::fabs(std::log2(std::stod(row.at("arithmetic_lambda_max"))) - std::atof(limit + 2));
      if (distance < least) {
        least = distance;
        closest = row.at("row");
      }
    }
    EXPECT_EQ(std::to_string(search.at("closest").at("row").get<int>()), closest) << limit;
    EXPECT_NEAR(std::fabs(std::log2(search.at("closest").at("error_over_target").get<double>())), least, 1e-9);
  }
}

TEST_F(SweepCli, UnconfirmedTargetsSayHowClose) {
  const Outcome outcome = run(
      "sweep --target-error colour=0.5/255 --target-error depth=2^-16 --size 64x64 --scene sphere --cosim none --axis "
      "significand_bits=12,26 --axis depth_bits=16,28 --out c");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("stress families; closest: row "), std::string::npos) << outcome.err;
  const json search = manifest("c").at("search");
  EXPECT_TRUE(search.at("confirmed").is_null());
  EXPECT_FALSE(search.at("winner").is_null());
  EXPECT_GT(search.at("confirm_closest").at("error_over_target"), 1);
}

}  // namespace
