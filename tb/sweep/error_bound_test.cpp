// The proved bounds of weights, attributes and depth against samples: every fragment of the stress families, as the
// untimed model draws it, with exact arithmetic on the same snapped quads.
#include "golden/analysis/error_bound.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/stress.hpp"
#include "model/snap.hpp"
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

/// Largest absolute errors. Slots 0-3 carry the weights, 4 an attribute in [-1, 1].
struct Worst {
  double lambda = 0, attribute = 0, depth = 0;
  std::size_t fragments = 0, depths = 0;
};

/// In every quad vertex i has the attributes e_i and then one value that is not a weight.
void sample(Worst& worst, golden::StressFamily family, const Config& config, bool perspective) {
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
    std::size_t seen = 0;
    const auto compare = [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) {
        if (seen++ >= samples_per_run / 4) return;
        const golden::ReferenceSample t = truth.sample(f.x, f.y);
        for (std::size_t i = 0; i < 4; ++i)
          worst.lambda = std::max(worst.lambda, std::fabs(output(f, i) - t.lambda[i]));
        worst.attribute = std::max(worst.attribute, std::fabs(output(f, 4) - t.attribute[4]));
      }
    };
    model.draw(snapped, compare);
    seen = std::min(seen, samples_per_run / 4);
    samples += seen;
    worst.fragments += seen;
    if (!ordinary) continue;
    seen = 0;
    depth_model.draw(snapped, [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) {
        if (seen++ >= samples_per_run / 8) return;
        ++worst.depths;
        const double z = std::ldexp(static_cast<double>(f.depth), -config.depth_bits);
        worst.depth = std::max(worst.depth, std::fabs(z - truth.sample(f.x, f.y).z));
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
  Worst worst;
  for (const auto& info : golden::stress_families()) sample(worst, info.family, config, p.perspective);

  const double unit = std::ldexp(1.0, -p.s);
  const ErrorBound lambda = bound_lambda(config), attribute = bound_attribute(config, 1), depth = bound_depth(config);
  std::printf(
      "s %2d align %d degree %d %s: lambda %6.3f of %6.3f (%.2f), attribute %6.3f of %6.3f (%.2f), depth %6.3f of "
      "%6.3f (%.2f) units of 2^-s; %zu fragments, %zu depths\n",
      p.s, p.align_guard_bits, p.degree, p.perspective ? "perspective" : "screen space", worst.lambda / unit,
      lambda.value / unit, worst.lambda / lambda.value, worst.attribute / unit, attribute.value / unit,
      worst.attribute / attribute.value, worst.depth / unit, depth.value / unit, worst.depth / depth.value,
      worst.fragments, worst.depths);
  EXPECT_TRUE(lambda.proved && attribute.proved && depth.proved);
  EXPECT_LE(worst.lambda, lambda.value);
  EXPECT_LE(worst.attribute, attribute.value);
  EXPECT_LE(worst.depth, depth.value);
  EXPECT_GT(worst.fragments, 10'000u);
  EXPECT_GT(worst.depths, 5'000u);
  // Random samples come within a factor of ten; what climbing finds is in golden/analysis/error_bound_test.cpp.
  EXPECT_GT(worst.lambda, 0.1 * lambda.value);
  EXPECT_GT(worst.attribute, 0.05 * attribute.value);
  EXPECT_GT(worst.depth, 0.05 * depth.value);
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
