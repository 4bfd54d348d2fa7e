// The search against full evaluation with real errors: the grid of 1,000 points, many targets.
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

void compare(const char* what, const SweepInput& input) {
  const Grid grid(Config{}, thousand_point_axes(), Grid::Kind::full);
  ASSERT_EQ(grid.size(), 1000u);
  std::vector<Config> configs;
  std::vector<SearchPoint> points;
  for (std::uint64_t row = 0; row < grid.size(); ++row) {
    configs.push_back(grid.point(row).config);
    points.push_back({configs.back(), scalar_cost(hardware_cost(configs.back()), CostWeights{})});
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

  std::size_t searches = 0, met = 0, most = 0, sum = 0;
  for (const char* name : {"lambda", "attribute", "depth", "colour", "arithmetic_lambda_p999"}) {
    const ErrorColumn column = parse_error_column(name, ErrorKind::arithmetic);
    const std::vector<std::string_view> idle = idle_keys(std::span(&column.quantity, 1));
    const auto error = [&](std::size_t i) { return column.value(results[i]); };
    if (!idle.empty() && idle.front() == "depth_bits") {
      for (std::size_t i = 0; i < results.size(); ++i)  // the last axis is depth_bits, with four values
        ASSERT_EQ(error(i), error(i - i % 4)) << name;
    }
    // Targets at every level that the grid has, just met and just missed.
    std::vector<double> levels;
    for (std::size_t i = 0; i < results.size(); i += 37) levels.push_back(error(i));
    for (const double level : levels)
      for (const double target : {level, std::nextafter(level, 0.0), level * 0.75}) {
        if (!(target > 0)) continue;
        std::size_t best = results.size();
        for (std::size_t i = 0; i < results.size(); ++i)
          if (error(i) <= target && (best == results.size() || points[i].cost < points[best].cost)) best = i;
        const SearchResult found = cheapest_meeting(
            points, [&](std::size_t i) { return error(i) / target; }, sampled_slack, idle);
        ++searches;
        met += found.winner.has_value();
        sum += found.evaluations;
        most = std::max(most, found.evaluations);
        ASSERT_EQ(found.winner.value_or(results.size()), best) << what << " " << name << " <= " << target;
        EXPECT_LE(found.evaluations, 100u) << what << " " << name << " <= " << target;
      }
  }
  EXPECT_GT(searches, 300u);
  EXPECT_GT(met, 200u);
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
