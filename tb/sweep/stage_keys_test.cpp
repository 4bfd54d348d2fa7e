// Every key of the configuration: a point that shares stages with others has in every column of points.csv what it has
// alone. A key that the lists of stages or of clocks leave out shows here.
#include "tb/sweep/stage_keys.hpp"

#include "golden/scenes/stress.hpp"
#include "tb/sweep/evaluator.hpp"
#include "tb/sweep/point_table.hpp"
#include "tb/sweep/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <string>

namespace quadrille::sweep {
namespace {

constexpr int size = 40;  // pixels

void place(WindowQuad& quad, double x, double y, double edge, double z) {
  constexpr std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {x + edge * corners[i][0], y + edge * corners[i][1], z, 1};
}

/// Something for every key: vertices of every kind, depths at a limit and across it, values at the ends of formats,
/// enough small quads for queues to fill.
SweepInput input_for_every_key(bool in_perspective) {
  using enum golden::StressFamily;
  SweepInput input;
  input.attributes = 3;
  for (const auto family : {general, any_w, eye_crossing, on_vertex, perspective})
    for (WindowQuad& quad : golden::make_stress(family, 1, 11, 1.0, size, size, input.attributes))
      input.quads.push_back(std::move(quad));
  for (int n = 0; n < 24; ++n) {
    WindowQuad& quad = input.quads.emplace_back();
    place(quad, 1.3 + 5 * (n % 7), 2.7 + 9 * (n / 7), n % 3 == 0 ? 12 : 4, n % 2 == 0 ? 0.2999 : 0.5);
    for (std::size_t i = 0; i < 4; ++i) {
      const double v = static_cast<double>(i);
      quad.attribute[i] = {2 - 0x1p-27, 0.1 * v * (n % 5), 0.7 + 1e-5 * v};  // the first: 2 in a format
      if (n % 4 == 1) quad.vertex[i].z += 0.07 * (v - 1);
      if (n % 5 == 0) quad.attribute[i][2] = i == 1 || i == 2 ? 0.25 : 0.75;  // plane
    }
  }
  // Past the guard band of narrower coordinates, and of all.
  for (const double far : {9000.0, 40000.0}) {
    WindowQuad& quad = input.quads.emplace_back();
    place(quad, 3.3, 4.4, 20, 0.4);
    quad.vertex[2].x = far;
    for (std::size_t i = 0; i < 4; ++i) quad.attribute[i].assign(3, 0.25 * static_cast<double>(i));
  }
  for (std::size_t q = 0; q < input.quads.size(); ++q) input.quads[q].id = static_cast<std::uint32_t>(q);
  DrawState& state = input.state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  state.znear = 0.3, state.zfar = 0.9;
  state.perspective = in_perspective;
  state.skip |= skip_plane;
  return input;
}

std::vector<int> values_of(const ConfigKey& key) {
  std::set<int> values{key.minimum, key.maximum};
  const int middle = Config().resolved(key.name);
  for (const int step : {-2, 1})
    if (middle + step >= key.minimum && middle + step <= key.maximum) values.insert(middle + step);
  return {values.begin(), values.end()};
}

/// The columns of points.csv that errors and clocks are in: those behind the configuration, save those of the whole
/// table. The rest follows from the configuration alone.
std::string columns(const Config& config, PointResult result) {
  PointRow row;
  row.config = config;
  row.result = std::move(result);
  const bool ok = row.result.refused.empty();
  if (ok) complete_row(row, CostWeights{}, false, true);
  return point_table(std::span(&row, 1));
}

struct Point {
  std::string what;
  Config config;
};

std::vector<Point> points_around(const std::string& name, const Config& base) {
  std::vector<Point> points{{name, base}};
  for (const ConfigKey& key : Config::keys())
    for (const int value : values_of(key)) {
      Point point{name + ", " + std::string(key.name) + " " + std::to_string(value), base};
      point.config.set(key.name, value);
      try {
        point.config.validate();
      } catch (const ConfigError&) {
        continue;
      }
      points.push_back(point);
    }
  return points;
}

class EveryKey : public testing::TestWithParam<bool> {};

TEST_P(EveryKey, IsOnAnAxisWhatItIsAlone) {
  const SweepInput input = input_for_every_key(GetParam());
  Config other;
  for (const auto& [key, value] : {std::pair{"significand_bits", 11},
                                   {"subpixel_bits", 6},
                                   {"depth_bits", 12},
                                   {"attribute_frac_bits", 14},
                                   {"sqrt_segments_log2", 4},
                                   {"recip_segments_log2", 4},
                                   {"quadratic_frac_bits", 8},
                                   {"dot_units", 4}})
    other.set(key, value);
  std::vector<Point> points = points_around("default", Config());
  for (const Point& point : points_around("other", other)) points.push_back(point);
  std::vector<Config> configs;
  for (const Point& point : points) configs.push_back(point.config);

  Evaluator together(input, {.threads = 2});
  std::vector<PointResult> results(points.size());
  together.evaluate(configs, [&](const Batch& batch) {
    for (std::size_t n = 0; n < batch.points.size(); ++n) results[batch.points[n]] = batch.results[n];
  });
  std::set<std::string> errors, clocks;
  std::size_t refused = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    Evaluator alone(input, {});
    const PointResult wanted = alone.evaluate(configs[n]);
    EXPECT_EQ(columns(configs[n], results[n]), columns(configs[n], wanted)) << points[n].what;
    refused += !wanted.refused.empty();
    if (!wanted.refused.empty()) continue;
    for (const ConfigKey& key : Config::keys()) {
      if (configs[n].get(key.name) == configs[0].get(key.name) || points[n].what.starts_with("other")) continue;
      PointResult same_clocks = wanted;
      same_clocks.cycles = results[0].cycles;
      if (columns(Config(), same_clocks) != columns(Config(), results[0])) errors.insert(std::string(key.name));
      if (wanted.cycles != results[0].cycles) clocks.insert(std::string(key.name));
    }
  }
  EXPECT_LT(refused, 20u);
  // What the input cannot show it cannot test.
  for (const char* key :
       {"viewport_bits", "guard_bits", "subpixel_bits", "homogeneous_frac_bits", "quadratic_frac_bits",
        "significand_bits", "sqrt_segments_log2", "sqrt_degree", "recip_segments_log2", "recip_degree",
        "align_guard_bits", "attribute_int_bits", "attribute_frac_bits", "depth_bits", "plane_quads"})
    EXPECT_TRUE(errors.contains(key)) << key << " moves no error of this input";
  for (const char* key : {"depth_bits", "tile_log2", "pixels_per_clock", "dot_units", "quad_slots_log2",
                          "tile_slots_log2", "stamp_fifo_log2"})
    EXPECT_TRUE(clocks.contains(key)) << key << " moves no clock of this input";
  std::string moved;
  for (const std::string& key : errors) moved += " " + key;
  moved += "; clocks:";
  for (const std::string& key : clocks) moved += " " + key;
  std::printf("%zu points, %zu refused; errors:%s\n", points.size(), refused, moved.c_str());
}

INSTANTIATE_TEST_SUITE_P(Projections, EveryKey, testing::Bool(),
                         [](const auto& p) { return p.param ? "Perspective" : "Screen"; });

/// A key that no list names may move anything: it enters at the first level.
TEST(StageKeys, EveryKeyThatMovesErrorsEntersSomewhere) {
  for (const ConfigKey& key : Config::keys()) {
    Config changed;
    for (const int value : values_of(key)) {
      if (value == Config().resolved(key.name)) continue;
      changed.set(key.name, value);
      break;
    }
    bool enters = false;
    for (std::size_t level = 0; level < level_count; ++level)
      enters = enters || level_key(changed, static_cast<Level>(level)) != level_key({}, static_cast<Level>(level));
    const bool moves = affects_error(key.name) && key.name != "quad_id_bits";
    EXPECT_EQ(enters, moves) << key.name;
  }
}

}  // namespace
}  // namespace quadrille::sweep
