#include "golden/reference/truth_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace quadrille::golden {
namespace {

// ---------------------------------------------------------------- the two ways in

/// The given quad whose snapped form is `quad`: k divided out, half a pixel added back; exact when k is a power of 2.
WindowQuad unsnapped(const SnappedQuad& quad, bool perspective) {
  WindowQuad out;
  for (int i = 0; i < 4; ++i) {
    const auto& v = quad.vertex[i];
    const double k = port_double(v.k), w = std::ldexp(v.w, -test::frac);
    const double base_z = std::ldexp(quad.base.depth, -config.depth_bits);
    out.vertex[i] = {(std::ldexp(v.x, -test::frac) + w / 2) / k, (std::ldexp(v.y, -test::frac) + w / 2) / k,
                     (port_double(v.z) + base_z * w) / k, w / k};
    for (int a = 0; a < draw.attributes; ++a) {
      const double base = std::ldexp(static_cast<double>(quad.base.attribute[a]), -config.attribute_frac());
      out.attribute[i].push_back(i == 0 ? base : base + port_double(v.attribute[a]) / (perspective ? k : w));
    }
  }
  return out;
}

TEST(Truth, SnappedAndGivenQuadsAgree) {
  Random random(10);
  int tested = 0, hidden = 0;
  for (int n = 0; n < 40'000; ++n) {
    SnappedQuad quad = n % 2 ? test::random_any_w(random, 8) : test::random_ordinary(random, 8);
    for (auto& v : quad.vertex) {
      v.k = port(std::exp2(random.integer(-3, 3)));
      if (v.w != one) v.w = std::max(v.w / 0x800, 1) * 0x800 * (v.w < 0 ? -1 : 1);
    }
    const int px = random.integer(-4, 4), py = random.integer(-4, 4);
    const auto s = truth_of(quad).sample(px, py);
    const auto g = TruthQuad(unsnapped(quad, true), draw).sample(px, py);
    ASSERT_EQ(s.covered, g.covered);
    ASSERT_EQ(s.front, g.front);
    ASSERT_EQ(s.visible, g.visible);
    ASSERT_EQ(s.flags & ~flag_homogeneous, g.flags & ~flag_homogeneous);
    if (!s.covered) continue;
    ++tested;
    hidden += !s.visible;
    for (int i = 0; i < 4; ++i) {
      ASSERT_NEAR(s.lambda[i], g.lambda[i], 0x1p-53);
      // The same with a_i = base + b_i / k_i rounded to double: half an ulp of |a| <= 9, of the quotient, of the sum.
      ASSERT_NEAR(s.attribute[i], g.attribute[i], 9 * 3 * 0x1p-53);
    }
    if (s.z_condition < 16) {
      ASSERT_NEAR(s.z, g.z, 32 * double_ulp);  // of corners' z in [0, 2]
    }
  }
  EXPECT_GT(tested, 5'000);
  EXPECT_GT(hidden, 300);
}

TEST(Truth, WithoutPerspectiveWeightsAreThoseOfTheScreen) {
  DrawState flat;
  flat.perspective = false;
  Random random(11);
  int tested = 0;
  for (int n = 0; n < 20'000; ++n) {
    // W all positive, not 1; the screen positions X/W are exact in doubles because W is a power of two.
    SnappedQuad quad = test::random_ordinary(random, 8);
    SnappedQuad screen = quad;
    for (int i = 0; i < 4; ++i) {
      const int shift = random.integer(0, 2);
      quad.vertex[i].k = port(std::exp2(random.integer(-2, 2)));  // must not matter
      quad.vertex[i].x /= 4;
      quad.vertex[i].y /= 4;
      quad.vertex[i].w = one >> shift;
      quad.vertex[i].z = port(0.125 * i);  // beside the base in [0, 1]
      screen.vertex[i].x = quad.vertex[i].x << shift;
      screen.vertex[i].y = quad.vertex[i].y << shift;
      screen.vertex[i].z = port(0.125 * i * (1 << shift));
      screen.vertex[i].k = port(1);
      screen.vertex[i].attribute = quad.vertex[i].attribute;
      for (int a = 0; a < 4; ++a) {
        screen.vertex[i].attribute[a] = port(port_double(quad.vertex[i].attribute[a]) * (1 << shift));  // a = b / W
      }
    }
    const int px = random.integer(-2, 2), py = random.integer(-2, 2);
    const auto s = TruthQuad(quad, config, flat).sample(px, py);
    if (!s.covered || (s.flags & (flag_two_corner | flag_two_edge))) continue;
    ++tested;
    const auto expected = truth_of(screen).sample(px, py);  // W = k = 1: eq. 7 and 4
    const auto given = TruthQuad(unsnapped(quad, false), flat).sample(px, py);
    for (int i = 0; i < 4; ++i) {
      ASSERT_NEAR(s.lambda[i], expected.lambda[i], 0x1p-53);
      ASSERT_NEAR(given.lambda[i], expected.lambda[i], 0x1p-53);
      ASSERT_NEAR(s.attribute[i], expected.attribute[i], 4 * double_ulp);
      ASSERT_NEAR(given.attribute[i], expected.attribute[i], 4 * double_ulp);
    }
    ASSERT_NEAR(s.z, expected.z, 2 * double_ulp);
  }
  EXPECT_GT(tested, 2'000);
}

TEST(Truth, AddsItsBases) {
  Random random(14);
  int tested = 0;
  for (int n = 0; n < 20'000; ++n) {
    SnappedQuad quad = n % 2 ? test::random_any_w(random, 8) : test::random_ordinary(random, 8);
    SnappedQuad bare = quad, other = quad;
    bare.base = {};
    test::leave_depth(bare.base);
    for (int a = 0; a < 4; ++a) other.vertex[0].attribute[a] = port(random.real(-9, 9));
    const int px = random.integer(-4, 4), py = random.integer(-4, 4);
    const auto s = truth_of(quad).sample(px, py), d = truth_of(bare).sample(px, py);
    if (!s.covered) continue;
    ++tested;
    ASSERT_EQ(truth_of(other).sample(px, py), s) << "of vertex 0 there are no differences";
    for (int a = 0; a < 4; ++a) {
      const double base = std::ldexp(static_cast<double>(quad.base.attribute[a]), -config.attribute_frac());
      ASSERT_EQ(s.attribute_above[a], d.attribute[a]);
      ASSERT_EQ(s.attribute[a], base + d.attribute[a]);
    }
    if (std::fabs(d.z) > 100) continue;
    ASSERT_EQ(s.z_above, d.z);
    ASSERT_EQ(s.z, std::ldexp(quad.base.depth, -config.depth_bits) + d.z);
  }
  EXPECT_GT(tested, 5'000);
}

TEST(Truth, ClampsDepthToTheCornersCodes) {
  SnappedQuad quad = make_quad({Point{0, 0}, {8, 0}, {8, 8}, {0, 8}});
  const double code = 0x1p-24;  // Z = 0 at vertex 0 and 1, 10 codes above the base at the others
  for (int i = 0; i < 4; ++i) quad.vertex[i].z = port(i < 2 ? 0 : 10 * code);
  quad.base.depth = 1'000;
  quad.base.depth_low = 1'003;
  quad.base.depth_high = 1'007;
  const TruthQuad truth = truth_of(quad);
  for (int y = 1; y < 8; ++y) {  // linear from row 0 to 8
    const auto s = truth.sample(4, y);
    const double expected = std::clamp(10 * y / 8.0, 3.0, 7.0);
    EXPECT_NEAR(s.z_above, expected * code, 0x1p-50 * code);
    EXPECT_NEAR(s.z, (1'000 + expected) * code, 0x1p-42 * code);
  }
}

/// A spread of 2^-30 beside a base of 100: differences are as exact, in every way of evaluation, as without the base.
TEST(Truth, DifferencesAreExactRelativeToTheSpread) {
  Random random(15);
  int tested = 0;
  for (int n = 0; n < 2'000; ++n) {
    SnappedQuad quad = test::random_ordinary(random, 8);
    quad.base.attribute[0] = test::base_code(100);
    for (auto& v : quad.vertex) v.attribute[0].exp -= 30, v.z.exp -= 30;
    const TruthQuad truth = truth_of(quad);
    std::array<PixelPlace, 1> at{{{random.integer(-3, 3), random.integer(-3, 3)}}};
    std::array<ReferenceSample, 1> lanes;
    truth.samples(at, lanes);
    const auto quick = truth.sample(at[0].x, at[0].y);
    const auto exact = truth.sample(at[0].x, at[0].y, TruthQuad::Effort::all_bits);
    if (!exact.covered) continue;
    ++tested;
    for (const auto& s : {lanes[0], quick}) {
      ASSERT_NEAR(s.attribute_above[0], exact.attribute_above[0], 0x1p-50 * 0x1p-28);  // |b / k| <= 4 2^-30
      ASSERT_NEAR(s.z_above, exact.z_above, 0x1p-50 * 0x1p-30);
    }
  }
  EXPECT_GT(tested, 300);
}

TEST(Truth, ExtremeIntegersDoNotOverflow) {
  // The largest coordinates of the widest configuration and pixels at the far end of a 16384-pixel viewport.
  const std::int32_t far = std::numeric_limits<std::int32_t>::max();
  SnappedQuad quad = make_quad({Point{0, 0}, {0, 0}, {0, 0}, {0, 0}});
  const std::int32_t x[4] = {-far, far, far, -far}, y[4] = {-far, -far, far, far};
  for (int i = 0; i < 4; ++i) {
    quad.vertex[i].x = x[i];
    quad.vertex[i].y = y[i];
    quad.vertex[i].w = 1;
  }
  const auto s = truth_of(quad).sample(16383, -16383);
  ASSERT_TRUE(s.covered && s.visible);
  // At (X, Y) / far = (e, -e), e = 16383/far, of a square of half side 1: lambda differs from 1/4 by at most e.
  for (double l : s.lambda) EXPECT_NEAR(l, 0.25, 16383.0 / far);
}

TEST(Truth, RefusesWhatIsNoPoint) {
  SnappedQuad quad = make_quad({Point{0, 0}, {4, 0}, {4, 4}, {0, 0, 0}});
  EXPECT_THROW(truth_of(quad), std::invalid_argument);
  WindowQuad given;
  for (auto& v : given.vertex) v = {1, 2, 0, 1};
  EXPECT_NO_THROW(TruthQuad(given, draw));
  given.vertex[2] = {0, 0, 1, 0};
  EXPECT_THROW(TruthQuad(given, draw), std::invalid_argument);
  given.vertex[2] = {std::nan(""), 0, 1, 1};
  EXPECT_THROW(TruthQuad(given, draw), std::invalid_argument);
  DrawState many;
  many.attributes = max_attribute_slots + 1;
  EXPECT_THROW(TruthQuad(make_quad({Point{0, 0}, {4, 0}, {4, 4}, {0, 4}}), config, many), std::invalid_argument);
}

}  // namespace
}  // namespace quadrille::golden
