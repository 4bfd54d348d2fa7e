// Quads left out before their tiles are walked: the same fragments with and without, every quad of small grids and many
// drawn around each rule's limit; and that what can be left out is.
#include "model/snap.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/model_test/both_ways.hpp"
#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
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
  std::printf("%llu quads have fragments\n", static_cast<unsigned long long>(drawn));
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

/// Corners within some units of the last place of a limit, on either side, at every width and number of guard bits.
TEST(QuadReject, DepthAtItsLimits) {
  Prng rng(5);
  RejectCounts total{};
  std::uint64_t kept_without_fragment = 0;
  for (int n = 0; n < 4000 && !HasFailure(); ++n) {
    Config c = tiny();
    c.significand_bits = static_cast<int>(rng.integer(8, 26));
    c.align_guard_bits = static_cast<int>(rng.below(7));
    c.depth_bits = static_cast<int>(rng.integer(8, 30));
    c.validate();
    DrawState state;
    state.width = state.height = state.scissor_x1 = state.scissor_y1 = 4;
    state.attributes = 0;
    state.znear = rng.uniform(0.0, 0.5);
    state.zfar = rng.uniform(state.znear, 1.0);
    const bool far = rng.chance(0.5), homogeneous = rng.chance(0.3);
    const double limit = std::ldexp(depth_code(far ? state.zfar : state.znear, c), -c.depth_bits);
    SnappedQuad q;
    for (std::size_t i = 0; i < 4; ++i) {
      const int one = 1 << c.frac();
      SnappedVertex& v = q.vertex[i];
      v.w = homogeneous ? static_cast<std::int32_t>(rng.integer(one / 2, one)) : one;
      v.x = ((i == 1 || i == 2) ? 4 * v.w : -v.w) + static_cast<std::int32_t>(rng.integer(0, one / 4));
      v.y = (i >= 2 ? 4 * v.w : -v.w) + static_cast<std::int32_t>(rng.integer(0, one / 4));
      v.k = {false, 0, 1u << (c.significand_bits - 1)};
      // A corner's depth near the limit, by up to twenty units of the last place towards the outside and four inwards.
      const double units = rng.uniform(-4, 20) * (far ? 1 : -1);
      const double u = std::ldexp(1.0, 1 - c.significand_bits);
      const double z = limit * (1 + units * u) * v.w / one;
      if (z <= 0) continue;
      int exponent = 0;
      const double fraction = std::frexp(z, &exponent);
      v.z = {false, exponent - 1, static_cast<std::uint32_t>(std::ldexp(fraction, c.significand_bits))};
    }
    BothWays both(c, state, skip_quads);
    const std::size_t fragments = both.draw(q);
    add(total, both.rejected());
    kept_without_fragment += fragments == 0 && both.rejected()[0] != 0;
  }
  print("near the limits", total);
  std::printf("%llu kept that have no fragment\n", static_cast<unsigned long long>(kept_without_fragment));
  EXPECT_GT(total[static_cast<std::size_t>(QuadReject::depth)], 300u);
  EXPECT_GT(kept_without_fragment, 300u);
}

/// Beyond the margin no quad is kept whose W are a power of two.
TEST(QuadReject, DepthIsUsedFully) {
  const Config c = tiny();
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 4;
  state.znear = 0.25;
  state.zfar = 0.5;
  const int one = 1 << c.frac();
  const std::uint32_t low = 1u << (c.significand_bits - 1);
  const auto quad_at = [&](int exponent, std::uint32_t sig, bool neg) {
    SnappedQuad q;
    for (std::size_t i = 0; i < 4; ++i) {
      SnappedVertex& v = q.vertex[i];
      v = {(i == 1 || i == 2) ? 3 * one : 0, i >= 2 ? 3 * one : 0, one, {false, 0, low}, {neg, exponent, sig}, {}};
    }
    return q;
  };
  const auto steps = static_cast<std::uint32_t>(depth_margin_steps(c));
  const auto reject = [&](const SnappedQuad& q) { return reject_by_vertices(q, c, state); };
  // Any power of two is as good a W as 1, down to one unit.
  for (int log2 = 0; log2 <= c.frac(); ++log2) {
    const auto scaled = [&](int exponent, std::uint32_t sig) {
      SnappedQuad q = quad_at(exponent - log2, sig, false);
      for (SnappedVertex& v : q.vertex) v.w = one >> log2, v.x >>= log2, v.y >>= log2;
      return reject(q);
    };
    EXPECT_EQ(scaled(-1, low + steps), QuadReject::none) << "W 2^-" << log2;
    EXPECT_EQ(scaled(-1, low + steps + 1), QuadReject::depth) << "W 2^-" << log2;
  }
  // zfar: the code after it is 0.5 + 2^-24, truncated 0.5, and the next number is beyond it.
  EXPECT_EQ(reject(quad_at(-1, low + steps, false)), QuadReject::none);
  EXPECT_EQ(reject(quad_at(-1, low + steps + 1, false)), QuadReject::depth);
  EXPECT_EQ(reject(quad_at(-3, 2 * low - steps + 1, false)), QuadReject::none);
  EXPECT_EQ(reject(quad_at(-3, 2 * low - steps, false)), QuadReject::depth);
  EXPECT_EQ(reject(quad_at(-2, low, true)), QuadReject::depth);
  EXPECT_EQ(reject(quad_at(-c.depth_bits - 1, low, true)), QuadReject::depth) << "below znear, whatever its sign";
  state.znear = 0;
  EXPECT_EQ(reject(quad_at(-c.depth_bits - 1, low, true)), QuadReject::none) << "minus a code of 0 is not outside";
  EXPECT_EQ(reject(quad_at(-c.depth_bits, low + steps - 1, true)), QuadReject::none);
  EXPECT_EQ(reject(quad_at(-c.depth_bits, low + steps, true)), QuadReject::depth);
  state.depth = false;
  EXPECT_EQ(reject(quad_at(-2, low, true)), QuadReject::none);
  state.depth = true;
  state.skip = 0;
  EXPECT_EQ(reject(quad_at(-2, low, true)), QuadReject::none);
}

/// What the margin is made of, by the tables that the machine has.
TEST(QuadReject, MarginCoversTheReciprocal) {
  for (int s = 8; s <= 26; ++s)
    for (const int degree : {1, 2}) {
      Config c;
      c.significand_bits = s;
      c.recip_degree = degree;
      try {
        c.validate();
      } catch (const ConfigError&) {
        continue;
      }
      ASSERT_TRUE(depth_margin_holds(c));
      const double u = std::ldexp(1.0, 1 - s);
      const TableError table = reciprocal_error(c);
      for (int g = 0; g <= 6; ++g) {
        c.align_guard_bits = g;
        const double sum = u * (1 + 3 * std::ldexp(1.0, -g));
        const double margin = depth_margin(c) * u;
        EXPECT_LE(std::expm1(table.high) + 1, (1 + margin) * (1 - sum))
            << "s " << s << " degree " << degree << " g " << g;
        EXPECT_GE((1 - sum) * std::exp(table.low), 1 - margin) << "s " << s << " degree " << degree << " g " << g;
        // So many ranks are as far where they are least, below a power of two: u/2 each.
        const double ranks = depth_margin_steps(c) * u / 2;
        EXPECT_LE(std::expm1(table.high) + 1, (1 + ranks) * (1 - sum))
            << "s " << s << " degree " << degree << " g " << g;
        EXPECT_GE((1 - sum) * std::exp(table.low), 1 - ranks) << "s " << s << " degree " << degree << " g " << g;
      }
      const int automatic = c.recip_segments();
      if (automatic > 3) {
        c.recip_segments_log2 = automatic - 1;
        EXPECT_FALSE(depth_margin_holds(c));
      }
    }
}

}  // namespace
}  // namespace quadrille
