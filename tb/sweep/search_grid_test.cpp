// The search against full evaluation with real errors: the grid of 1,000 points, many targets, several weights of the
// cost; and what it takes for granted of keys that cannot move an error.
#include "golden/analysis/hardware_cost.hpp"
#include "golden/scenes/scenes.hpp"
#include "golden/scenes/stress.hpp"
#include "tb/sweep/evaluator.hpp"
#include "tb/sweep/grid.hpp"
#include "tb/sweep/point_table.hpp"
#include "tb/sweep/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

namespace quadrille::sweep {
namespace {

SweepInput scene_input(const char* name, int size) {
  const golden::Scene scene = golden::make_scene(name);
  SweepInput input;
  input.state.width = input.state.height = input.state.scissor_x1 = input.state.scissor_y1 = size;
  input.state.perspective = scene.perspective;
  input.attributes = 2;
  input.quads = golden::scene_quads(scene, size, size, golden::AttributeSet::uv);
  return input;
}

SweepInput stress_input(golden::StressFamily family, std::size_t count) {
  SweepInput input;
  input.state.width = input.state.height = input.state.scissor_x1 = input.state.scissor_y1 = 128;
  input.attributes = 4;
  input.quads = golden::make_stress(family, count, 1, 1, 128, 128);
  return input;
}

/// Errors of the grid, in whose order depth_bits is last and align_guard_bits before it.
void check_what_the_search_assumes(const std::vector<Config>& configs, const std::vector<PointResult>& results,
                                   bool ordinary) {
  const auto machine = [](Config c) {
    c.depth_bits = 0;
    return c.get("significand_bits") * 10'000 + c.quadratic_frac() * 100 + c.align_guard_bits;
  };
  for (std::size_t i = 0; i < results.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Config &a = configs[i], &b = configs[j];
      const bool same = machine(a) == machine(b);
      const bool same_but_for_exact_products = ordinary && a.significand_bits == b.significand_bits &&
                                               a.align_guard_bits == b.align_guard_bits && a.quadratic_frac() >= 16 &&
                                               b.quadratic_frac() >= 16;
      if (!same && !same_but_for_exact_products) continue;
      for (const char* statistic : {"max", "rms", "mean", "p999"})
        for (const char* output : {"lambda", "attribute", "depth", "colour"}) {
          const ErrorColumn column = parse_error_column(std::string("arithmetic_") + output + "_" + statistic);
          const double difference = std::fabs(column.value(results[i]) - column.value(results[j]));
          if (column.output == Output::depth && a.depth_bits != b.depth_bits) continue;
          ASSERT_EQ(difference, 0) << column.name() << " of points " << i << " and " << j;
        }
    }
}

void compare(const char* what, const SweepInput& input) {
  const Grid grid(Config{}, thousand_point_axes(), Grid::Kind::full);
  ASSERT_EQ(grid.size(), 1000u);
  std::vector<Config> configs;
  std::vector<SearchPoint> points;
  OrdinaryInput ordinary(input);
  for (std::uint64_t row = 0; row < grid.size(); ++row) {
    configs.push_back(grid.point(row).config);
    points.push_back({configs.back(), 0, ordinary(configs.back())});
  }
  Evaluator::Settings settings;
  settings.threads = 2;
  settings.cycles = false;
  Evaluator evaluator(input, settings);
  std::vector<PointResult> results(configs.size());
  evaluator.evaluate(configs, [&](const Batch& batch) {
    for (std::size_t i = 0; i < batch.points.size(); ++i) results[batch.points[i]] = batch.results[i];
  });
  ASSERT_GT(results.front().fragments, 500u);

  check_what_the_search_assumes(configs, results, points.front().ordinary);
  std::size_t searches = 0, met = 0, most = 0, sum = 0;
  // The winner may not depend on the cost being right: other technologies weigh the same resources otherwise.
  for (const CostWeights& weights :
       {ecp5_weights, ecp5_nodsp_weights,
        CostWeights{.state = 0, .multiplier = 10, .adder = 0, .table = 0, .dsp = 0, .join = 0, .block_ram = 0}}) {
    for (SearchPoint& point : points) point.cost = scalar_cost(hardware_cost(point.config), weights);
    std::vector<std::size_t> by_cost(points.size());
    std::iota(by_cost.begin(), by_cost.end(), std::size_t{0});
    std::ranges::stable_sort(by_cost, {}, [&](std::size_t i) { return points[i].cost; });
    for (const char* name : {"lambda", "attribute", "depth", "colour", "arithmetic_lambda_p999"}) {
      const ErrorColumn column = parse_error_column(name);
      const std::vector<std::string_view> idle = idle_keys(std::span(&column.output, 1));
      const auto error = [&](std::size_t i) { return column.value(results[i]); };
      // Targets at every level that the grid has, just met and just missed.
      std::vector<double> levels;
      for (std::size_t i = 0; i < results.size(); i += 37) levels.push_back(error(i));
      for (const double level : levels)
        for (const double target : {level, std::nextafter(level, 0.0), level * 0.75}) {
          if (!(target > 0)) continue;
          const auto best = std::ranges::find_if(by_cost, [&](std::size_t i) { return error(i) <= target; });
          const SearchResult found = cheapest_meeting(
              points, [&](std::size_t i) { return error(i) / target; }, sampled_slack, idle);
          ++searches;
          met += found.winner.has_value();
          sum += found.evaluations;
          most = std::max(most, found.evaluations);
          ASSERT_EQ(found.winner.value_or(results.size()), best == by_cost.end() ? results.size() : *best)
              << what << " " << name << " <= " << target;
          EXPECT_LE(found.evaluations, 125u) << what << " " << name << " <= " << target;
        }
    }
  }
  EXPECT_GT(searches, 900u);
  EXPECT_GT(met, 600u);
  std::printf("%s: %zu searches (%zu met), %.1f evaluations on average, %zu at most\n", what, searches, met,
              static_cast<double>(sum) / static_cast<double>(searches), most);
}

TEST(SearchOnTheGrid, Sphere) { compare("sphere", scene_input("sphere", 96)); }
TEST(SearchOnTheGrid, ConcaveQuad) { compare("fig10_concave", scene_input("fig10_concave", 96)); }
TEST(SearchOnTheGrid, GeneralQuads) { compare("general", stress_input(golden::StressFamily::general, 40)); }
TEST(SearchOnTheGrid, EyeCrossingQuads) {
  compare("eye_crossing", stress_input(golden::StressFamily::eye_crossing, 4));
}

}  // namespace
}  // namespace quadrille::sweep
