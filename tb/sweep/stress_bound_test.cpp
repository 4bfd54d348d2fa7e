// The arithmetic bound c 2^-(s-3) of weights, the first of which is what the others leave of its base, and the proved
// one, for every s from 8 to 26 on every stress family.
#include "golden/analysis/error_bound.hpp"
#include "golden/scenes/stress.hpp"
#include "model/snap.hpp"
#include "model/untimed.hpp"
#include "tb/sweep/evaluator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace quadrille::sweep {
namespace {

constexpr int size = 192;  // pixels
constexpr std::uint64_t enough_fragments = 12'000;

class StressBound : public testing::TestWithParam<std::size_t> {};

TEST_P(StressBound, HoldsForEverySignificand) {
  const golden::StressFamilyInfo& family = golden::stress_families()[GetParam()];
  SweepInput input;
  input.state.width = input.state.height = input.state.scissor_x1 = input.state.scissor_y1 = size;
  // Quads of the family until there are enough fragments.
  UntimedModel counter(Config{}, input.state);
  for (const WindowQuad& quad : golden::make_stress(family.family, 2000, 7, 1, size, size, 0)) {
    if (counter.stats().fragments >= enough_fragments) break;
    input.quads.push_back(quad);
    counter.draw(snap_quad(quad, Config{}, input.state), [](std::span<const Fragment>) {});
  }
  std::vector<Config> points;
  for (int s = 8; s <= 26; ++s) {
    Config& point = points.emplace_back();
    point.significand_bits = s;
  }
  Evaluator::Settings settings;
  settings.threads = 2;
  settings.cycles = false;
  Evaluator evaluator(input, settings);
  std::size_t seen = 0;
  double worst = 0;
  int worst_s = 0;
  evaluator.evaluate(points, [&](const Batch& batch) {
    for (std::size_t i = 0; i < batch.points.size(); ++i) {
      const PointResult& result = batch.results[i];
      const int s = points[batch.points[i]].significand_bits;
      ASSERT_EQ(result.refused, "");
      EXPECT_GT(result.fragments, 1000u);
      const double error = result.arithmetic[0].max;
      const Config& point = points[batch.points[i]];
      EXPECT_LE(error, std::ldexp(value_bound_factor(point), 3 - s) + std::ldexp(0.5, -point.attribute_frac()))
          << family.name << ", s = " << s << ", quad " << result.worst.index << ", pixel " << result.worst.x << ","
          << result.worst.y;
      const ErrorBound bound = bound_attribute(point, 1);
      EXPECT_TRUE(bound.proved);
      EXPECT_LE(error, bound.value) << family.name << ", s = " << s;
      if (std::ldexp(error, s) > worst) worst = std::ldexp(error, s), worst_s = s;
      ++seen;
    }
  });
  EXPECT_EQ(seen, points.size());
  // Against zeros measured for want of fragments: a truncating machine is off by more than half a unit somewhere.
  EXPECT_GT(worst, 0.5);
  std::printf("%s: worst %.2f units of 2^-s (s = %d), bound 8\n", std::string(family.name).c_str(), worst, worst_s);
}

std::string family_name(const testing::TestParamInfo<std::size_t>& info) {
  return std::string(golden::stress_families()[info.param].name);
}

INSTANTIATE_TEST_SUITE_P(Families, StressBound, testing::Range(std::size_t{0}, golden::stress_families().size()),
                         family_name);

}  // namespace
}  // namespace quadrille::sweep
