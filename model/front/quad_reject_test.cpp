// Quads left out before their tiles are walked: the same fragments with and without, every quad of small grids and many
// drawn around each rule's limit; and that what can be left out is.
#include "model/port/snap.hpp"

#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"
#include "model/skips/both_ways_test_support.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

/// Every quad of a 3 by 3 grid with w of -1, 0 and 1, but one in `stride`; rejected ones are a third and more of them.
void grid(std::uint64_t stride) {
  const Config c = tiny();
  const std::vector<SnappedVertex> vertices = grid_vertices(c);
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 5;
  state.attributes = 0;
  RejectCounts total{};
  std::uint64_t drawn = 0;
  for (const Cull cull : {Cull::none, Cull::front, Cull::back}) {
    state.cull = cull;
    BothWays both(c, state, skip_quads);
    const std::uint64_t n = vertices.size();
    for (std::uint64_t i = static_cast<std::uint64_t>(cull); i < n * n * n * n && !testing::Test::HasFailure();
         i += stride) {
      drawn += both.draw(grid_quad(vertices, i)) != 0;
      if (testing::Test::HasFailure()) std::printf("quad %llu\n", static_cast<unsigned long long>(i));
    }
    add(total, both.rejected());
  }
  print("grid", total);
  for (const QuadReject r : {QuadReject::behind, QuadReject::line, QuadReject::culled})
    EXPECT_GT(total[static_cast<std::size_t>(r)], 100u) << reject_reasons[static_cast<std::size_t>(r)];
  EXPECT_GE(total[0], drawn);
  EXPECT_GT(drawn, 1000u);
}

TEST(QuadReject, SomeOfASmallGrid) { grid(101); }
TEST(QuadReject, AllOfASmallGrid) { grid(1); }

/// Families in draw states at random: scissors, culling, depth limits at corners' depths.
TEST(QuadReject, FamiliesKeepTheirFragments) {
  RejectCounts total{};
  std::uint64_t fragments = 0;
  for (const golden::StressFamilyInfo& info : golden::stress_families())
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      Config c;
      c.set("viewport_bits", 8);
      c.set("align_guard_bits", static_cast<int>(seed) - 1);
      const int size = 64;
      const std::vector<WindowQuad> quads = golden::make_stress(info.family, 60, seed, 1.0, size, size, 4);
      const DrawState state = golden::random_draw_state(c, size, size, quads, seed);
      BothWays both(c, state, skip_quads);
      for (const WindowQuad& q : quads) fragments += both.draw(snap_quad(q, c, state));
      add(total, both.rejected());
    }
  print("families", total);
  EXPECT_GT(fragments, 100'000u);
  for (std::size_t i = 0; i < total.size(); ++i)
    if (i != static_cast<std::size_t>(QuadReject::depth)) {
      EXPECT_GT(total[i], 10u) << reject_reasons[i];
    }
}

/// Corners some codes from a limit, on either side, at every width and number of guard bits: a quad is left out when
/// all four are outside on one side, and only then.
TEST(QuadReject, DepthAtItsLimits) {
  Prng rng(5);
  RejectCounts total{};
  std::uint64_t fragments = 0;
  for (int n = 0; n < 4000 && !HasFailure(); ++n) {
    Config c = tiny();
    c.significand_bits = static_cast<int>(rng.integer(8, 26));
    c.align_guard_bits = static_cast<int>(rng.below(7));
    c.depth_bits = static_cast<int>(rng.integer(8, 30));
    c.validate();
    DrawState state;
    state.width = state.height = state.scissor_x1 = state.scissor_y1 = 4;
    state.attributes = 0;
    const std::int64_t one = std::int64_t{1} << c.depth_bits;
    const std::int64_t near = rng.integer(0, one / 2), far = rng.integer(near, one);
    state.znear = std::ldexp(static_cast<double>(near), -c.depth_bits);
    state.zfar = std::ldexp(static_cast<double>(far), -c.depth_bits);
    const bool homogeneous = rng.chance(0.3);
    const std::int64_t from = (rng.chance(0.5) ? far : near) + rng.integer(-4, 4);
    WindowQuad given;
    bool below = true, beyond = true;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t code = from + rng.integer(-2, 2);  // below 0 and above 1 too
      below = below && code < near;
      beyond = beyond && code > far;
      // Beside the code by less than half of one; w with few bits, so that the depth is exact.
      const double w = homogeneous ? static_cast<double>(rng.integer(1, 8)) / 4 : 1;
      const double z = std::ldexp(static_cast<double>(code) + rng.uniform(-0.49, 0.49), -c.depth_bits);
      const double x = (i == 1 || i == 2) ? 4.5 : -0.5, y = i >= 2 ? 4.5 : -0.5;
      given.vertex[i] = {x * w, y * w, z * w, w};
    }
    const SnappedQuad q = snap_quad(given, c, state);
    EXPECT_EQ(reject_by_vertices(q, c, state) == QuadReject::depth, below || beyond)
        << q.base.depth_low << " " << q.base.depth_high << " in " << near << " " << far;
    BothWays both(c, state, skip_quads);
    fragments += both.draw(q);
    add(total, both.rejected());
  }
  print("near the limits", total);
  EXPECT_GT(total[static_cast<std::size_t>(QuadReject::depth)], 300u);
  EXPECT_GT(total[0], 300u);
  EXPECT_GT(fragments, 3000u);
}

/// A code inside is enough to be kept, whatever the rest; limits and corners at the ends of [0, 1].
TEST(QuadReject, DepthIsUsedFully) {
  const Config c = tiny();
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 4;
  const int one = 1 << c.frac();
  const std::int32_t whole = 1 << c.depth_bits;
  const auto reject = [&](std::int32_t low, std::int32_t high) {
    SnappedQuad q;
    q.base.depth = static_cast<std::uint32_t>(std::clamp(low, 0, whole));
    q.base.depth_low = low;
    q.base.depth_high = high;
    for (std::size_t i = 0; i < 4; ++i) {
      SnappedVertex& v = q.vertex[i];
      v = {(i == 1 || i == 2) ? 3 * one : 0,
           i >= 2 ? 3 * one : 0,
           one,
           {false, 0, 1u << (c.significand_bits - 1)},
           {},
           {}};
    }
    return reject_by_vertices(q, c, state);
  };
  const std::int32_t near = whole / 4, far = whole / 2;
  state.znear = 0.25;
  state.zfar = 0.5;
  EXPECT_EQ(reject(near - 9, near - 1), QuadReject::depth);
  EXPECT_EQ(reject(near - 9, near), QuadReject::none);
  EXPECT_EQ(reject(far, far + 9), QuadReject::none);
  EXPECT_EQ(reject(far + 1, far + 9), QuadReject::depth);
  EXPECT_EQ(reject(near - 1, far + 1), QuadReject::none);
  EXPECT_EQ(reject(-1, whole + 1), QuadReject::none);
  state.znear = 0;
  state.zfar = 1;
  EXPECT_EQ(reject(-1, -1), QuadReject::depth);
  EXPECT_EQ(reject(-1, 0), QuadReject::none);
  EXPECT_EQ(reject(whole, whole + 1), QuadReject::none);
  EXPECT_EQ(reject(whole + 1, whole + 1), QuadReject::depth);
  state.depth = false;
  EXPECT_EQ(reject(-1, -1), QuadReject::none);
  state.depth = true;
  state.skip = 0;
  EXPECT_EQ(reject(-1, -1), QuadReject::none);
}

}  // namespace
}  // namespace quadrille
