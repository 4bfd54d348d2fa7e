// Every fragment of the stress families against the truth on the same snapped input: the fragments are the right ones,
// |Δλ'| <= 2^-(s-3), and the weights sum to 1 within the bound; notch_exact decides one flag and nothing else.
#include "golden/reference/truth.hpp"
#include "golden/scenes/stress.hpp"
#include "model/snap.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

namespace quadrille::campaign {
namespace {

constexpr int size = 64;
constexpr double bound_units = 8;                ///< 2^-(s-3) in units of 2^-s
constexpr std::size_t samples_per_run = 12'000;  ///< of one family, width and setting
constexpr unsigned singular_flags = flag_on_edge | flag_on_vertex | flag_two_corner | flag_two_edge;

struct Worst {
  double lambda = 0, sum = 0;  ///< units of 2^-s
  std::size_t samples = 0, singular = 0, homogeneous = 0, notches = 0;
};

Worst measure(golden::StressFamily family, const Config& config, std::uint64_t seed) {
  DrawState draw;
  draw.width = draw.height = draw.scissor_x1 = draw.scissor_y1 = size;
  draw.depth = false;
  const int s = config.significand_bits;
  Worst worst;
  UntimedModel model(config, draw, PixelEngine::plain), lanes(config, draw, PixelEngine::lanes);
  Config unflagged = config;
  unflagged.set("notch_exact", 0);
  UntimedModel without(unflagged, draw, PixelEngine::lanes);
  for (const WindowQuad& quad : golden::make_stress(family, 400, seed, 1.0, size, size, 4)) {
    if (worst.samples >= samples_per_run) break;
    const SnappedQuad snapped = snap_quad(quad, config, draw);
    const golden::TruthQuad truth(snapped, config, draw);
    std::vector<Fragment> fragments, quick, unmarked;
    model.draw(snapped, [&](std::span<const Fragment> f) { fragments.insert(fragments.end(), f.begin(), f.end()); });
    lanes.draw(snapped, [&](std::span<const Fragment> f) { quick.insert(quick.end(), f.begin(), f.end()); });
    EXPECT_EQ(fragments, quick) << "the engines differ";
    without.draw(snapped, [&](std::span<const Fragment> f) { unmarked.insert(unmarked.end(), f.begin(), f.end()); });
    for (Fragment& f : quick) f.flags &= static_cast<std::uint8_t>(~flag_notch);
    EXPECT_EQ(unmarked, quick) << "notch_exact decides more than its flag";
    std::set<std::pair<int, int>> drawn;
    for (const Fragment& f : fragments) {
      drawn.insert({f.x, f.y});
      const golden::ReferenceSample t = truth.sample(f.x, f.y);
      EXPECT_TRUE(t.covered) << "quad " << quad.id << " at " << f.x << ", " << f.y;
      EXPECT_EQ(t.front, f.front);
      EXPECT_TRUE(t.visible || (t.eye_in_hull && std::fabs(t.visible_margin) < std::ldexp(1.0, 4 - s)));
      EXPECT_EQ(f.flags & (singular_flags | flag_tie | flag_homogeneous), t.flags);
      double sum = 0;
      ++worst.samples;
      worst.singular += (f.flags & singular_flags) != 0;
      worst.homogeneous += (f.flags & flag_homogeneous) != 0;
      worst.notches += (f.flags & flag_notch) != 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const double lambda = std::ldexp(static_cast<double>(f.attribute[i]), -config.attribute_frac());
        sum += lambda;
        worst.lambda = std::max(worst.lambda, std::ldexp(std::fabs(lambda - t.lambda[i]), s));
      }
      worst.sum = std::max(worst.sum, std::ldexp(std::fabs(sum - 1), s));
    }
    EXPECT_EQ(drawn.size(), fragments.size()) << "a pixel twice";
    // What was not drawn is not covered or not visible.
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        if (drawn.contains({x, y})) continue;
        const golden::Coverage c = truth.cover(x, y);
        if (c.covered && c.visible) {
          EXPECT_TRUE(c.eye_in_hull && std::fabs(truth.sample(x, y).visible_margin) < std::ldexp(1.0, 4 - s))
              << "quad " << quad.id << " misses " << x << ", " << y;
        }
      }
    if (testing::Test::HasFailure()) break;
  }
  return worst;
}

class ErrorBound : public testing::TestWithParam<int> {};

TEST_P(ErrorBound, HoldsOnStress) {
  const auto& info = golden::stress_families()[static_cast<std::size_t>(GetParam())];
  for (const int s : {12, 18, 24}) {
    Config config;
    config.set("significand_bits", s);
    config.validate();
    const Worst w = measure(info.family, config, static_cast<std::uint64_t>(s));
    std::printf(
        "%-16s s %2d: lambda %8.3f, sum %6.3f units; %zu samples, %zu singular, %zu homogeneous, %zu with a notch\n",
        std::string(info.name).c_str(), s, w.lambda, w.sum, w.samples, w.singular, w.homogeneous, w.notches);
    if (HasFailure()) return;
    EXPECT_GT(w.samples, 100u);
    EXPECT_LE(w.lambda, bound_units);
    EXPECT_LE(w.sum, bound_units);
  }
}
INSTANTIATE_TEST_SUITE_P(EveryFamily, ErrorBound, testing::Range(0, static_cast<int>(golden::stress_families().size())),
                         [](const auto& p) {
                           return std::string(golden::stress_families()[static_cast<std::size_t>(p.param)].name);
                         });

}  // namespace
}  // namespace quadrille::campaign
