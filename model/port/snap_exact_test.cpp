// Every bit of snap_quad against slow_snap.hpp: random quads of all magnitudes, bases and codes, in each rounding mode,
// and with subnormal numbers taken for 0.
#include "model/port/snap_exact_test_support.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace quadrille {
namespace {

using golden::Prng;

double wild(Prng& rng, double low, double high) { return rng.sign() * rng.log2_spread(low, high); }

/// On the screen before the eye, behind it, at its plane, far outside; `spread` of exponents.
WindowVertex random_vertex(Prng& rng, double spread) {
  WindowVertex v;
  v.w = rng.chance(0.6) ? rng.log2_spread(-spread / 6, spread / 6) : rng.chance(0.2) ? 0 : wild(rng, -spread, spread);
  if (v.w != 0 && rng.chance(0.6)) {
    v.x = v.w * rng.uniform(-100, 700);
    v.y = v.w * rng.uniform(-100, 700);
  } else {
    v.x = wild(rng, -spread, spread);
    v.y = wild(rng, -spread, spread);
  }
  for (double* at : {&v.x, &v.y}) *at = std::fmin(std::fmax(*at, -0x1p80), 0x1p80);
  v.z = rng.chance(0.1) ? 0 : rng.chance(0.1) ? wild(rng, -1000, spread) : v.w * rng.uniform(-0.2, 1.2);
  return v;
}

/// Values far apart, or apart by little from one that is far from 0.
double random_value(Prng& rng, double of, double limit) {
  switch (rng.below(5)) {
    case 0:
      return of;
    case 1:
      return wild(rng, -1000, std::log2(limit) - 0.01);
    case 2:
      return std::nextafter(of, rng.sign() * limit);
    case 3:
      return std::fmin(std::fmax(of + wild(rng, -50, 0), -limit * 0.999), limit * 0.999);
    default:
      return rng.uniform(-limit, limit) * 0.999;
  }
}

TEST(SnapExactly, RandomQuads) {
  Prng rng(11);
  int bounded = 0, homogeneous = 0, drawn = 0;
  for (const auto& [vp, guard, sub, hom, s, depth, whole] : {std::array{12, 3, 8, 7, 18, 24, 7},
                                                             {12, 3, 8, 7, 26, 30, 15},
                                                             {6, 4, 2, 10, 8, 8, 1},
                                                             {14, 1, 8, 7, 24, 24, 3},
                                                             {10, 2, 4, 4, 12, 16, 15}}) {
    Config c;
    c.viewport_bits = vp;
    c.guard_bits = guard;
    c.subpixel_bits = sub;
    c.homogeneous_frac_bits = hom;
    c.significand_bits = s;
    c.attribute_slots = 8;
    c.depth_bits = depth;
    c.attribute_int_bits = whole;
    if (s == 26) c.attribute_frac_bits = 30;
    c.validate();
    for (int n = 0; n < 250; ++n) {
      DrawState state;
      state.perspective = rng.chance(0.6);
      WindowQuad q;
      q.id = static_cast<std::uint32_t>(n);
      const double spread = rng.chance(0.6) ? 20 : 79;
      for (std::size_t i = 0; i < 4; ++i) {
        q.vertex[i] = random_vertex(rng, spread);
        q.attribute[i].resize(rng.chance(0.9) ? 8 : rng.below(8));
        for (std::size_t j = 0; j < q.attribute[i].size(); ++j) {
          const double first = j < q.attribute[0].size() ? q.attribute[0][j] : 0;
          q.attribute[i][j] = random_value(rng, i == 0 ? 0.1 : first, std::ldexp(1.0, whole));
        }
      }
      SCOPED_TRACE("S " + std::to_string(s) + ", quad " + std::to_string(n));
      expect_exact(q, c, state, n % 8 == 0);
      if (HasFailure()) return;
      const SnappedQuad snapped = snap_quad(q, c, state);
      ++drawn;
      bounded += snapped.base.depth_low != -1 || snapped.base.depth_high != c.depth_above();
      homogeneous += !is_ordinary(snapped, c);
    }
  }
  EXPECT_GT(bounded, drawn / 20);
  EXPECT_GT(homogeneous, drawn / 4);
}

/// Numbers 2^0 to 2^240 apart, of all 53 bits, alike at all four vertices: up to where 128 bits hold what is made of
/// them, then 256, and beyond.
TEST(SnapExactly, EveryLengthOfIntegers) {
  Prng rng(14);
  const Config c;
  for (int apart = 0; apart <= 240; ++apart)
    for (int n = 0; n < 6; ++n) {
      DrawState state;
      state.perspective = n % 3 != 0;
      const auto full = [&](int exponent) { return rng.sign() * std::ldexp(rng.uniform(1, 2), exponent); };
      const std::size_t which = rng.below(3);
      WindowQuad q;
      for (std::size_t i = 0; i < 4; ++i) {
        const double far = full(10), near = full(10 - apart);
        q.vertex[i] = {far, which == 1 ? near : full(10), which == 2 ? near : far, which == 0 ? near : full(0)};
        q.attribute[i] = {full(6), full(6 - apart), i % 2 == 0 ? full(6) : full(6 - apart)};
      }
      SCOPED_TRACE("apart " + std::to_string(apart) + ", quad " + std::to_string(n));
      expect_exact(q, c, state, false);
      if (HasFailure()) return;
    }
}

/// Magnitudes at the ends of the range, all of them together.
TEST(SnapExactly, Extremes) {
  const Config c;
  for (const double x : {0x1p80, -0x1.fffffffffffffp-80, 0.0})
    for (const double y : {0x1.8p79, -0x1p-1074, 0.0})
      for (const double z : {0x1p80, 0x1p-80, -0x1p80, 0x1p-1074})
        for (const double w : {0x1p80, -0x1p80, 0x1.123456789abcdp-80, -0x1p-80, 0x1p-1074, -0x1p-1050, 0.0}) {
          if (std::max({std::fabs(x), std::fabs(y), std::fabs(w)}) < 0x1p-80) continue;
          WindowQuad q;
          for (std::size_t i = 0; i < 4; ++i) {
            q.vertex[i] = {x, y, z, w};
            q.attribute[i] = {127.99, -0x1p-60, static_cast<double>(i) * 0x1p-1074};
          }
          q.vertex[3] = {1, 2, 0.5, 1};
          SCOPED_TRACE(testing::Message() << x << " " << y << " " << z << " " << w);
          expect_exact(q, c, DrawState());
          if (HasFailure()) return;
        }
}

/// Bases: to nearest, ties to even, no larger than the largest code. An attribute that is vertex 0's has no difference,
/// whatever its base was rounded to.
TEST(SnapExactly, BasesOfAttributes) {
  const Config c;
  const auto base_of = [&](double value) {
    WindowQuad q = square_of(1);
    for (auto& a : q.attribute) a[0] = value;
    std::int64_t base = 0;
    for (const SnappedQuad& s : in_every_mode(q, c, DrawState())) {
      base = s.base.attribute[0];
      for (const SnappedVertex& v : s.vertex) EXPECT_EQ(v.attribute[0].sig, 0u) << value;
    }
    expect_exact(q, c, DrawState());
    return base;
  };
  EXPECT_EQ(base_of(0.1), 1677722);
  EXPECT_EQ(base_of(-0.1), -1677722);
  EXPECT_EQ(base_of(2.5 * 0x1p-24), 2);
  EXPECT_EQ(base_of(3.5 * 0x1p-24), 4);
  EXPECT_EQ(base_of(-3.5 * 0x1p-24), -4);
  EXPECT_EQ(base_of(std::nextafter(2.5 * 0x1p-24, 1)), 3);
  EXPECT_EQ(base_of(std::nextafter(128.0, 0)), 0x7fffffff);
  EXPECT_EQ(base_of(std::nextafter(-128.0, 0)), -0x7fffffff);
  EXPECT_EQ(base_of(0x1p-1074), 0);
  // The least that differs is a difference.
  WindowQuad q = square_of(1);
  for (auto& a : q.attribute) a[0] = 100;
  q.attribute[3][0] = std::nextafter(100.0, 200);
  EXPECT_EQ(snap_quad(q, c, DrawState()).vertex[3].attribute[0].exp, -46);
}

/// Base of depth: ties to even, in [0, 1], of the first vertex before the eye. Corners: halves up, one code more on
/// either side of [0, 1]; everything where a vertex is not before the eye.
TEST(SnapExactly, CodesOfDepth) {
  const Config c;
  const auto corner = [&](double z, double w) {
    WindowQuad q = square_of(w);
    for (WindowVertex& v : q.vertex) v.z = z;
    QuadBase base;
    for (const SnappedQuad& s : in_every_mode(q, c, DrawState())) {
      base = s.base;
      EXPECT_EQ(base.depth_low, base.depth_high);
    }
    expect_exact(q, c, DrawState(), false);
    return std::pair<int, int>(base.depth, base.depth_low);
  };
  using Codes = std::pair<int, int>;
  constexpr int one = 1 << 24;
  for (const double w : {1.0, 3.0, 0.625}) {
    const auto z = [&](double code) { return w * code * 0x1p-24; };
    EXPECT_EQ(corner(z(2.5), w), Codes(2, 3));
    EXPECT_EQ(corner(z(3.5), w), Codes(4, 4));
    EXPECT_EQ(corner(std::nextafter(z(2.5), 0), w), Codes(2, 2));
    EXPECT_EQ(corner(std::nextafter(z(2.5), 1), w), Codes(3, 3));
    EXPECT_EQ(corner(z(-0.5), w), Codes(0, 0)) << "up is towards 0";
    EXPECT_EQ(corner(std::nextafter(z(-0.5), -1), w), Codes(0, -1));
    EXPECT_EQ(corner(z(-1e9), w), Codes(0, -1));
    EXPECT_EQ(corner(z(one), w), Codes(one, one));
    EXPECT_EQ(corner(std::nextafter(z(one + 0.5), 0), w), Codes(one, one));
    EXPECT_EQ(corner(z(one + 0.5), w), Codes(one, one + 1));
    EXPECT_EQ(corner(z(1e30), w), Codes(one, one + 1));
    EXPECT_EQ(corner(0, w), Codes(0, 0));
    EXPECT_EQ(corner(0x1p-1074, w), Codes(0, 0));
    EXPECT_EQ(corner(-0x1p-1074, w), Codes(0, 0));
  }
  const auto base_with = [&](double w0, double w1) {
    WindowQuad q = square_of(1);
    q.vertex[0].w = w0;
    q.vertex[1].w = w1;
    q.vertex[0].z = 0.25 * w0;
    q.vertex[1].z = 0.5 * w1;
    q.vertex[2].z = 0.75;
    for (const SnappedQuad& s : in_every_mode(q, c, DrawState())) {
      EXPECT_EQ(s.base.depth_low == -1 && s.base.depth_high == one + 1, w0 <= 0 || w1 <= 0);
      EXPECT_EQ(s.base, snap_quad(q, c, DrawState()).base);
    }
    expect_exact(q, c, DrawState(), false);
    return snap_quad(q, c, DrawState()).base.depth;
  };
  EXPECT_EQ(base_with(1, 1), one / 4u);
  EXPECT_EQ(base_with(-1, 1), one / 2u);
  EXPECT_EQ(base_with(0, -1), one / 4u * 3);
  EXPECT_EQ(base_with(1, -1), one / 4u);
}

/// A w below the normal numbers is before the eye, whatever the processor takes it for.
TEST(SnapExactly, TheLeastWIsBeforeTheEye) {
  WindowQuad q = square_of(1);
  q.vertex[0].w = 0x1p-1074;
  q.vertex[0].z = 1;
  expect_exact(q, Config(), DrawState());
  EXPECT_EQ(snap_quad(q, Config(), DrawState()).base.depth, 1u << 24);
}

/// One w and one z: each difference of depth is (z - base) k, rounded once; k = 1/3 is not rounded before.
TEST(SnapExactly, KIsNotRoundedInDifferences) {
  Config c;
  c.significand_bits = 8;
  WindowQuad q = square_of(3);
  q.attribute[0][0] = 0;
  q.attribute[1][0] = 3 * 101 * 0x1p-7;  // k times it is 101 2^-7; a k of 8 bits, 171 2^-9, would make 101.2 of it
  q.attribute[2][0] = 3 * 201.5 * 0x1p-7;
  const SnappedQuad s = snap_quad(q, c, DrawState());
  EXPECT_EQ(s.vertex[1].attribute[0].sig, 202u);
  EXPECT_EQ(s.vertex[2].attribute[0].sig, 202u);
  expect_exact(q, c, DrawState());
}

}  // namespace
}  // namespace quadrille
