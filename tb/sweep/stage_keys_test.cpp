// Every key of the configuration: a point that shares stages with others has in every column of points.csv what it has
// alone. A key whose stage or clocks are wrong (ConfigKey) shows here.
#include "tb/sweep/stage_keys.hpp"

#include "model/every_key_test_support.hpp"
#include "tb/device/verilate.hpp"
#include "tb/sweep/evaluator.hpp"
#include "tb/sweep/point_table.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::sweep {
namespace {

SweepInput input_for_every_key(bool in_perspective) {
  SweepInput input{quads_for_every_key(), every_key_attributes, state_for_every_key()};
  input.state.perspective = in_perspective;
  return input;
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
  Config config;
  const ConfigKey* key;  ///< that differs from the base; none: it is the base
  std::size_t base;      ///< its place
};

void add_points_around(const Config& base, std::vector<Point>& points) {
  const std::size_t place = points.size();
  points.push_back({base, nullptr, place});
  for (const ConfigKey& key : Config::keys())
    for (const Config& config : configs_around(base, key)) points.push_back({config, &key, place});
}

class EveryKey : public testing::TestWithParam<bool> {};

TEST_P(EveryKey, IsOnAnAxisWhatItIsAlone) {
  const SweepInput input = input_for_every_key(GetParam());
  std::vector<Point> points;
  for (const Config& base : std::span(bases_for_every_key()).first(2)) add_points_around(base, points);
  std::vector<Config> configs;
  for (const Point& point : points) configs.push_back(point.config);

  Evaluator together(input, {.threads = 2});
  std::vector<PointResult> results(points.size());
  together.evaluate(configs, [&](const Batch& batch) {
    for (std::size_t n = 0; n < batch.points.size(); ++n) results[batch.points[n]] = batch.results[n];
  });
  std::set<std::string_view> errors, clocks;
  std::size_t refused = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const auto& [config, key, base] = points[n];
    Evaluator alone(input, {});
    const PointResult wanted = alone.evaluate(config);
    EXPECT_EQ(columns(config, results[n]), columns(config, wanted)) << tb::summary(config);
    refused += !wanted.refused.empty();
    if (!wanted.refused.empty() || key == nullptr) continue;
    PointResult same_clocks = wanted;
    same_clocks.cycles = results[base].cycles;
    if (columns(Config(), same_clocks) != columns(Config(), results[base])) errors.insert(key->name);
    if (wanted.cycles != results[base].cycles) clocks.insert(key->name);
  }
  EXPECT_LT(refused, 40u);
  // What the input cannot show it cannot test.
  for (const ConfigKey& key : Config::keys()) {
    EXPECT_EQ(errors.contains(key.name), key.stage != Level::none) << key.name;
    if (key.name == "hierarchical_z_tiles_log2") continue;  // a sweep hides no tile
    EXPECT_EQ(clocks.contains(key.name), key.has(ConfigKey::clocks)) << key.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Projections, EveryKey, testing::Bool(),
                         [](const auto& p) { return p.param ? "Perspective" : "Screen"; });

}  // namespace
}  // namespace quadrille::sweep
