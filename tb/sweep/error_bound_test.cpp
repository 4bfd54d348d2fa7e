// The proved bounds of weights, attributes and depth against samples: every fragment of the stress families, as the
// untimed model draws it, with exact arithmetic on the same snapped quads.
#include "golden/analysis/error_bound.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace quadrille {
namespace {

constexpr int size = 64;
constexpr std::size_t samples_per_run = 1500;  ///< of one family and configuration

/// What is proved of a configuration: of values at a spread of 0, half a code, and of 1.
struct Bounds {
  ErrorBound lambda, still_attribute, attribute, still_depth, depth;

  explicit Bounds(const Config& config)
      : lambda(bound_lambda(config)),
        still_attribute(bound_attribute(config, 0)),
        attribute(bound_attribute(config, 1)),
        still_depth(bound_depth(config, 0)),
        depth(bound_depth(config, 1)) {}
  static double at(double spread, const ErrorBound& still, const ErrorBound& one) {
    return still.value + (one.value - still.value) * spread;
  }
};

/// Largest errors as shares of their bounds. Slots 0-3 carry the weights, of which the first is what is left of its
/// base, 4 a value in [-1, 1].
struct Worst {
  double lambda = 0, first = 0, attribute = 0, depth = 0;
  std::size_t fragments = 0, depths = 0;
};

/// Largest minus least of numbers at the port over their factors, with the base, which is 0.
double spread_of(const std::array<double, 4>& difference, const std::array<double, 4>& factor) {
  double low = 0, high = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    low = std::min(low, difference[i] / factor[i]);
    high = std::max(high, difference[i] / factor[i]);
  }
  return high - low;
}

/// In every quad vertex i has the attributes e_i and then one value that is not a weight.
void sample(Worst& worst, golden::StressFamily family, const Config& config, const Bounds& bounds, bool perspective) {
  DrawState draw;
  draw.width = draw.height = draw.scissor_x1 = draw.scissor_y1 = size;
  draw.depth = false;
  draw.perspective = perspective;
  draw.attributes = 5;
  DrawState with_depth = draw;
  with_depth.depth = true;
  UntimedModel model(config, draw), depth_model(config, with_depth);
  std::size_t samples = 0;
  const int s = config.significand_bits;
  for (const WindowQuad& quad : golden::make_stress(family, 120, static_cast<std::uint64_t>(s), 1.0, size, size, 5)) {
    if (samples >= samples_per_run) break;
    const SnappedQuad snapped = snap_quad(quad, config, draw);
    const bool ordinary = is_ordinary(snapped, config);
    if (!perspective && !ordinary) continue;
    const golden::TruthQuad truth(snapped, config, draw);
    const auto output = [&](const Fragment& f, std::size_t j) {
      return std::ldexp(static_cast<double>(f.attribute[j]), -config.attribute_frac());
    };
    std::array<double, 4> k{}, w{}, z{}, b{};
    for (std::size_t i = 0; i < 4; ++i) {
      const SnappedVertex& v = snapped.vertex[i];
      w[i] = std::ldexp(v.w, -config.frac());
      k[i] = perspective ? golden::port_value(v.k, s) : w[i];
      z[i] = golden::port_value(v.z, s);
      b[i] = i == 0 ? 0 : golden::port_value(v.attribute[4], s);
    }
    const double attribute_bound = Bounds::at(spread_of(b, k), bounds.still_attribute, bounds.attribute);
    std::size_t seen = 0;
    const auto compare = [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) {
        if (seen++ >= samples_per_run / 4) return;
        const golden::ReferenceSample t = truth.sample(f.x, f.y);
        for (std::size_t i = 1; i < 4; ++i)
          worst.lambda = std::max(worst.lambda, std::fabs(output(f, i) - t.lambda[i]) / bounds.lambda.value);
        worst.first = std::max(worst.first, std::fabs(output(f, 0) - t.lambda[0]) / bounds.attribute.value);
        worst.attribute = std::max(worst.attribute, std::fabs(output(f, 4) - t.attribute[4]) / attribute_bound);
      }
    };
    model.draw(snapped, compare);
    seen = std::min(seen, samples_per_run / 4);
    samples += seen;
    worst.fragments += seen;
    if (!ordinary) continue;
    const double depth_bound = Bounds::at(spread_of(z, w), bounds.still_depth, bounds.depth);
    seen = 0;
    depth_model.draw(snapped, [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) {
        if (seen++ >= samples_per_run / 8) return;
        ++worst.depths;
        const double code = std::ldexp(static_cast<double>(f.depth), -config.depth_bits);
        worst.depth = std::max(worst.depth, std::fabs(code - truth.sample(f.x, f.y).z) / depth_bound);
      }
    });
  }
}

struct Case {
  int s, align_guard_bits, degree;
  bool perspective;
};

class SampledError : public testing::TestWithParam<Case> {};

TEST_P(SampledError, StaysBelowTheProof) {
  const Case& p = GetParam();
  Config config;
  config.significand_bits = p.s;
  config.align_guard_bits = p.align_guard_bits;
  config.sqrt_degree = config.recip_degree = p.degree;
  config.attribute_slots = 5;
  config.depth_bits = 30;
  config.validate();
  const Bounds bounds(config);
  Worst worst;
  for (const auto& info : golden::stress_families()) sample(worst, info.family, config, bounds, p.perspective);

  std::printf(
      "s %2d align %d degree %d %s: of the bounds lambda %.2f, the first %.2f, attribute %.2f, depth %.2f; c = %.3f; "
      "%zu fragments, %zu depths\n",
      p.s, p.align_guard_bits, p.degree, p.perspective ? "perspective" : "screen space", worst.lambda, worst.first,
      worst.attribute, worst.depth, value_bound_factor(config), worst.fragments, worst.depths);
  EXPECT_TRUE(bounds.lambda.proved && bounds.attribute.proved && bounds.depth.proved);
  EXPECT_LE(worst.lambda, 1);
  EXPECT_LE(worst.first, 1);
  EXPECT_LE(worst.attribute, 1);
  EXPECT_LE(worst.depth, 1);
  EXPECT_GT(worst.fragments, 10'000u);
  EXPECT_GT(worst.depths, 5'000u);
  // Random samples come within a factor of ten; what climbing finds is in golden/analysis/error_bound_test.cpp.
  EXPECT_GT(worst.lambda, 0.1);
  EXPECT_GT(worst.attribute, 0.05);
  EXPECT_GT(worst.depth, 0.05);
}

constexpr Case cases[] = {
    {8, 2, 2, true},   {8, 0, 1, true},   {9, 2, 2, true},  {12, 2, 2, true}, {12, 0, 2, true}, {12, 6, 1, true},
    {12, 2, 2, false}, {15, 2, 2, true},  {15, 4, 1, true}, {18, 2, 2, true}, {18, 0, 2, true}, {18, 6, 2, true},
    {18, 2, 1, true},  {18, 2, 2, false}, {21, 2, 2, true}, {24, 2, 2, true}, {24, 1, 1, true}, {26, 2, 2, true},
};
INSTANTIATE_TEST_SUITE_P(EveryFamily, SampledError, testing::ValuesIn(cases), [](const auto& p) {
  return "s" + std::to_string(p.param.s) + "_align" + std::to_string(p.param.align_guard_bits) + "_degree" +
         std::to_string(p.param.degree) + (p.param.perspective ? "" : "_screen");
});

}  // namespace
}  // namespace quadrille
