// The truth against mathematics: the properties of the paper, an evaluation by angles, and every singular class.
#include "golden/reference/rsqrt.hpp"
#include "golden/reference/truth_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille::golden {
namespace {

/// lambda' of the truth before rounding to double.
std::array<Float113, 4> lambda128(const TruthQuad& truth, const SnappedQuad& quad, int px, int py) {
  auto m = truth.homogeneous_weights(px, py);
  Float113 sum = 0;
  for (int i = 0; i < 4; ++i) sum += m[i] *= port_double(quad.vertex[i].k);
  for (auto& v : m) v /= sum;
  return m;
}

TEST(Float128, RsqrtHasFullPrecision) {
  Random random(1);
  for (int n = 0; n < 200'000; ++n) {
    // All 113 bits of the argument are random; exponents of both parities.
    const Float113 a =
        scalbnq(1 + static_cast<Float113>(random.real(0, 1)) + static_cast<Float113>(random.real(0, 1)) * 0x1p-53,
                random.integer(-200, 200));
    const Float113 expected = 1 / sqrtq(a);  // two roundings of 2^-113
    ASSERT_LE(static_cast<double>(fabsq(rsqrt(a) / expected - 1)), 0x1p-110);
  }
  EXPECT_EQ(rsqrt(4), 0.5);
}

// ---------------------------------------------------------------- properties of the paper, section 3

TEST(Truth, QuarterAtTheCentreOfASquare) {
  SnappedQuad quad = make_quad({Point{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  const double k[4] = {1, 2, 0.5, 4};
  for (int i = 0; i < 4; ++i) quad.vertex[i].k = port(k[i]);
  const auto s = truth_of(quad).sample(2, 2);
  ASSERT_TRUE(s.covered && s.visible);
  EXPECT_EQ(s.flags & ~flag_tie, 0);
  EXPECT_TRUE(s.flags & flag_tie) << "the diagonal runs through the centre";
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(s.lambda[i], k[i] / 7.5, double_ulp);  // lambda = 1/4 each, eq. 10 with 1/w = k
    // b = 1 at vertex i: sum(M b) / sum(M k); of vertex 0 a base of 1 and -1 at the others.
    EXPECT_NEAR(s.attribute[i], i == 0 ? 1 - 3 / 7.5 : 1 / 7.5, double_ulp);
  }
  EXPECT_NEAR(s.z, (0 + 1 + 2 + 3) / 4.0, 3 * double_ulp);
  EXPECT_NEAR(s.condition, 1, double_ulp);
  EXPECT_NEAR(s.visible_margin, 1, double_ulp);
}

TEST(Truth, LagrangeProperty) {
  // Starting the square at each corner in turn puts each vertex on the pixel that the tie rule keeps, the top left one.
  const std::array<Point, 4> square{Point{0, 0}, {0, 4}, {4, 4}, {4, 0}};
  for (int shift = 0; shift < 4; ++shift) {
    std::array<Point, 4> turned;
    for (int i = 0; i < 4; ++i) turned[(i + shift) % 4] = square[i];
    const auto s = truth_of(make_quad(turned)).sample(0, 0);
    ASSERT_TRUE(s.covered);
    EXPECT_TRUE(s.front) << "down, right, up is counter-clockwise as seen when y points down";
    EXPECT_EQ(s.flags, flag_on_vertex | flag_tie);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(s.lambda[i], i == shift ? 1.0 : 0.0);
    EXPECT_EQ(s.z, shift);
  }
}

TEST(Truth, WeightTendsToOneAtAVertex) {
  for (int bits = 1; bits <= 15; ++bits) {
    SnappedQuad quad = make_quad({Point{0, 0}, {0, 4}, {4, 4}, {4, 0}});
    quad.vertex[0].x = quad.vertex[0].y = -(one >> bits);
    const auto s = truth_of(quad).sample(0, 0);
    ASSERT_TRUE(s.covered);
    // The weights are smooth next to a convex corner, with a gradient of the order of 1/side = 1/4.
    EXPECT_GT(s.lambda[0], 1 - std::exp2(-bits));
    EXPECT_LT(s.lambda[0], 1);
  }
}

TEST(Truth, LinearAlongEdgesWithPerspective) {
  SnappedQuad quad = make_quad({Point{0, 0}, {0, 8}, {8, 8}, {8, 0}});
  const double k[4] = {1, 3, 0.5, 0.25};
  for (int i = 0; i < 4; ++i) quad.vertex[i].k = port(k[i]);
  const TruthQuad truth = truth_of(quad);
  for (int p = 1; p < 8; ++p) {
    const double s = p / 8.0;
    const auto left = truth.sample(0, p), top = truth.sample(p, 0);
    ASSERT_TRUE(left.covered && top.covered);
    EXPECT_EQ(left.flags & ~flag_tie, flag_on_edge);
    EXPECT_EQ(top.flags & ~flag_tie, flag_on_edge);
    EXPECT_NEAR(left.lambda[0], (1 - s) * k[0] / ((1 - s) * k[0] + s * k[1]), double_ulp);
    EXPECT_NEAR(left.lambda[1], s * k[1] / ((1 - s) * k[0] + s * k[1]), double_ulp);
    EXPECT_EQ(left.lambda[2], 0);
    EXPECT_EQ(left.lambda[3], 0);
    EXPECT_NEAR(top.lambda[3], s * k[3] / ((1 - s) * k[0] + s * k[3]), double_ulp);
    EXPECT_EQ(top.lambda[1], 0);
    EXPECT_NEAR(left.z, s, double_ulp);  // z of vertices 0, 1 is 0, 1; eq. 4 is linear on the screen
    EXPECT_NEAR(top.z, 3 * s, 3 * double_ulp);
    EXPECT_EQ(left.condition, 1);
    EXPECT_FALSE(truth.sample(8, p).covered) << "right edge";
    EXPECT_FALSE(truth.sample(p, 8).covered) << "bottom edge";
  }
}

TEST(Truth, LinearPrecisionAndPositivityOnRandomQuads) {
  Random random(2);
  int tested = 0, convex = 0, concave = 0, bow_tie = 0;
  while (tested < 100'000) {
    SnappedQuad quad = test::random_ordinary(random, 64);
    for (auto& v : quad.vertex) v.k = port(1);
    const auto& v = quad.vertex;
    int left_turns = 0;
    for (int i = 0; i < 4; ++i) {
      const auto &a = v[i], &b = v[(i + 1) & 3], &c = v[(i + 2) & 3];
      left_turns +=
          static_cast<std::int64_t>(b.x - a.x) * (c.y - b.y) > static_cast<std::int64_t>(b.y - a.y) * (c.x - b.x);
    }
    const TruthQuad truth = truth_of(quad);
    for (int n = 0; n < 8; ++n) {
      const int px = random.integer(-64, 64), py = random.integer(-64, 64);
      const auto s = truth.sample(px, py);
      if (!s.covered) continue;
      ++tested;
      (left_turns % 4 == 0 ? convex : left_turns == 2 ? bow_tie : concave)++;
      ASSERT_TRUE(s.visible);
      long double x = 0, y = 0, sum = 0;
      for (int i = 0; i < 4; ++i) {
        ASSERT_GE(s.lambda[i], 0);
        x += static_cast<long double>(s.lambda[i]) * v[i].x / one;
        y += static_cast<long double>(s.lambda[i]) * v[i].y / one;
        sum += s.lambda[i];
      }
      // Each lambda is rounded to double, an error of at most 2^-54 where the values add up to 1 (2^-53 for one of
      // them).
      const double tolerance = 64 * 3 * 0x1p-53;
      ASSERT_NEAR(static_cast<double>(x), px, tolerance);
      ASSERT_NEAR(static_cast<double>(y), py, tolerance);
      ASSERT_NEAR(static_cast<double>(sum), 1, 3 * 0x1p-53);
    }
  }
  EXPECT_GT(convex, 10'000);
  EXPECT_GT(concave, 10'000);
  EXPECT_GT(bow_tie, 10'000);
}

TEST(Truth, HomogeneousIdentityAndOneSignExactlyInside) {
  // Eq. 6 in homogeneous form, sum(M_i S_i) = 0, everywhere; and the M_i have one sign exactly where (12) says inside.
  Random random(3);
  int inside = 0, outside = 0, behind = 0;
  for (int n = 0; n < 150'000; ++n) {
    const SnappedQuad quad = n % 2 ? test::random_any_w(random, 16) : test::random_ordinary(random, 16);
    const TruthQuad truth = truth_of(quad);
    const int px = random.integer(-8, 8), py = random.integer(-8, 8);
    const auto s = truth.sample(px, py);
    if (s.flags & flag_tie) continue;
    const auto m = truth.homogeneous_weights(px, py);
    Float113 x = 0, y = 0, size = 0;
    int positive = 0, negative = 0;
    for (int i = 0; i < 4; ++i) {
      const auto& v = quad.vertex[i];
      const std::int64_t sx = v.x - static_cast<std::int64_t>(v.w) * px, sy = v.y - static_cast<std::int64_t>(v.w) * py;
      x += m[i] * sx;
      y += m[i] * sy;
      size += fabsq(m[i]) * static_cast<Float113>(std::abs(sx) + std::abs(sy));
      positive += m[i] > 0;
      negative += m[i] < 0;
    }
    // M carries 2^-108 times its own cancellation, which for these sizes (16 px in 2^-15 units) stays below 2^20.
    ASSERT_LE(static_cast<double>(fabsq(x) + fabsq(y)), static_cast<double>(size) * 0x1p-85);
    ASSERT_EQ(s.covered, positive == 4 || negative == 4);
    (s.covered ? inside : outside)++;
    behind += s.covered && !s.visible;
  }
  EXPECT_GT(inside, 20'000);
  EXPECT_GT(outside, 20'000);
  EXPECT_GT(behind, 1'000);
}

// ---------------------------------------------------------------- eq. 8 by angles

struct ByAngles {
  std::array<Float113, 4> lambda;
  Float113 tolerance;
  bool in_front;
};

/// Eq. 8 and 10 word by word: project, take the signed angles by atan2, the exterior angle pi + alpha and the exterior
/// distance -r of section 3.2, tangents of half angles. Nothing is shared with the truth. W must not be 0 and the pixel
/// not singular.
///
/// Tolerance, first order, u = 2^-113: s = v - p is off by u (|v| + |s|), so an angle by dalpha = 4 u + u sum over its
/// two arms of (|v| + |s|) / |s|; its tangent by (1 + t^2)/2 dalpha + 4 u |t|; lambda' by 2 sum(dmu/w) / |sum(mu/w)|.
/// The switched form is better than that. A factor of 4 covers what was left out.
ByAngles by_angles(const SnappedQuad& quad, int px, int py) {
  std::array<Float113, 4> x, y, r, arm, t, dt, inverse_w;
  for (int i = 0; i < 4; ++i) {
    const auto& v = quad.vertex[i];
    const Float113 w = static_cast<Float113>(v.w) / one;
    const Float113 vx = static_cast<Float113>(v.x) / one / w, vy = static_cast<Float113>(v.y) / one / w;
    x[i] = vx - px;
    y[i] = vy - py;
    r[i] = hypotq(x[i], y[i]);
    arm[i] = (hypotq(vx, vy) + r[i]) / r[i];
    if (v.w < 0) r[i] = -r[i];
    inverse_w[i] = port_double(v.k) / w;
  }
  for (int i = 0; i < 4; ++i) {
    const int n = (i + 1) & 3;
    Float113 alpha = atan2q(x[i] * y[n] - y[i] * x[n], x[i] * x[n] + y[i] * y[n]);
    if (r[i] * r[n] < 0) alpha += 2 * atan2q(1, 0);  // pi
    t[i] = tanq(alpha / 2);
    dt[i] = 0x1p-113 * ((1 + t[i] * t[i]) / 2 * (4 + arm[i] + arm[n]) + 4 * fabsq(t[i]));
  }
  ByAngles out;
  Float113 sum = 0, sum_mu = 0, error = 0;
  for (int i = 0; i < 4; ++i) {
    const int before = (i + 3) & 3;
    const Float113 mu = (t[before] + t[i]) / r[i];
    out.lambda[i] = mu * inverse_w[i];
    sum += out.lambda[i];
    sum_mu += mu;
    error += (dt[before] + dt[i]) * fabsq(inverse_w[i] / r[i]) + 0x1p-113 * (arm[i] + 4) * fabsq(out.lambda[i]);
  }
  for (auto& l : out.lambda) l /= sum;
  out.tolerance = 4 * 2 * error / fabsq(sum);
  out.in_front = sum * sum_mu > 0;
  return out;
}

TEST(Truth, AgreesWithAnglesOnInteriorPoints) {
  Random random(4);
  int ordinary = 0, homogeneous = 0, sharp = 0;
  for (int n = 0; ordinary + homogeneous < 30'000; ++n) {
    const SnappedQuad quad = n % 3 ? test::random_any_w(random, 16) : test::random_ordinary(random, 16);
    const int px = random.integer(-3, 3), py = random.integer(-3, 3);
    const TruthQuad truth = truth_of(quad);
    const auto s = truth.sample(px, py);
    if (!s.covered || (s.flags & (flag_on_edge | flag_two_edge | flag_on_vertex | flag_two_corner))) continue;
    if (std::ranges::any_of(quad.vertex, [](const auto& v) { return v.w == 0; })) continue;
    const auto expected = by_angles(quad, px, py);
    const auto lambda = lambda128(truth, quad, px, py);
    for (int i = 0; i < 4; ++i) {
      ASSERT_LE(fabsq(lambda[i] - expected.lambda[i]), expected.tolerance) << static_cast<double>(expected.tolerance);
      ASSERT_NEAR(s.lambda[i], static_cast<double>(expected.lambda[i]),
                  0x1p-53 + static_cast<double>(expected.tolerance));
    }
    if (std::abs(s.visible_margin) > 1e-20) {
      ASSERT_EQ(s.visible, expected.in_front);
    }
    sharp += expected.tolerance < 1e-28;
    (s.flags & flag_homogeneous ? homogeneous : ordinary)++;
  }
  EXPECT_GT(ordinary, 3'000);
  EXPECT_GT(homogeneous, 10'000);
  EXPECT_GT(sharp, (ordinary + homogeneous) * 9 / 10) << "the tolerance must say something";
}

TEST(Truth, AgreesWithAnglesOnGridQuads) {
  // Small integers: pixels on the lines of edges (t = 0), straight corners, collapsed edges, notches of every kind.
  Random random(5);
  int tested = 0, on_a_line = 0;
  while (tested < 10'000) {
    std::array<Point, 4> points;
    for (auto& p : points) p = {random.integer(0, 4), random.integer(0, 4)};
    const SnappedQuad quad = make_quad(points);
    const TruthQuad truth = truth_of(quad);
    for (int p = 0; p < 25; ++p) {
      const auto s = truth.sample(p % 5, p / 5);
      if (!s.covered || (s.flags & (flag_on_edge | flag_two_edge | flag_on_vertex | flag_two_corner))) continue;
      const auto expected = by_angles(quad, p % 5, p / 5);
      const auto lambda = lambda128(truth, quad, p % 5, p / 5);
      for (int i = 0; i < 4; ++i) ASSERT_LE(fabsq(lambda[i] - expected.lambda[i]), expected.tolerance);
      ++tested;
      on_a_line += (s.flags & flag_tie) != 0;
    }
  }
  EXPECT_GT(on_a_line, 1'000);
}

}  // namespace
}  // namespace quadrille::golden
