// The truth against mathematics: the properties of the paper, an evaluation by angles, and every singular class.
#include "golden/reference/truth.hpp"

#include "golden/reference/exact_coverage.hpp"
#include "golden/reference/float128.hpp"
#include "golden/reference/test_quads.hpp"

#include <gtest/gtest.h>
#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace quadrille::golden {
namespace {

using test::make_quad;
using test::one;
using test::Point;
using test::port;
using test::Random;

const Config config;
const DrawState draw;
constexpr double double_ulp = 0x1p-52;  // of 1: every double result is a rounded value of magnitude about 1

TruthQuad truth_of(const SnappedQuad& quad) { return {quad, config, draw}; }

double port_double(const PortNumber& p) {
  return (p.neg ? -1.0 : 1.0) * p.sig * std::exp2(p.exp - (config.significand_bits - 1));
}

/// lambda' of the truth before rounding to double.
std::array<__float128, 4> lambda128(const TruthQuad& truth, const SnappedQuad& quad, int px, int py) {
  auto m = truth.homogeneous_weights(px, py);
  __float128 sum = 0;
  for (int i = 0; i < 4; ++i) sum += m[i] *= port_double(quad.vertex[i].k);
  for (auto& v : m) v /= sum;
  return m;
}

TEST(Float128, RsqrtHasFullPrecision) {
  Random random(1);
  for (int n = 0; n < 200'000; ++n) {
    // All 113 bits of the argument are random; exponents of both parities.
    const __float128 a =
        scalbnq(1 + static_cast<__float128>(random.real(0, 1)) + static_cast<__float128>(random.real(0, 1)) * 0x1p-53,
                random.integer(-200, 200));
    const __float128 expected = 1 / sqrtq(a);  // two roundings of 2^-113
    ASSERT_LE(static_cast<double>(fabsq(rsqrt(a) / expected - 1)), 0x1p-110);
  }
  EXPECT_EQ(rsqrt(4), 0.5Q);
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
    __float128 x = 0, y = 0, size = 0;
    int positive = 0, negative = 0;
    for (int i = 0; i < 4; ++i) {
      const auto& v = quad.vertex[i];
      const std::int64_t sx = v.x - static_cast<std::int64_t>(v.w) * px, sy = v.y - static_cast<std::int64_t>(v.w) * py;
      x += m[i] * sx;
      y += m[i] * sy;
      size += fabsq(m[i]) * static_cast<__float128>(std::abs(sx) + std::abs(sy));
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
  std::array<__float128, 4> lambda;
  __float128 tolerance;
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
  std::array<__float128, 4> x, y, r, arm, t, dt, inverse_w;
  for (int i = 0; i < 4; ++i) {
    const auto& v = quad.vertex[i];
    const __float128 w = static_cast<__float128>(v.w) / one;
    const __float128 vx = static_cast<__float128>(v.x) / one / w, vy = static_cast<__float128>(v.y) / one / w;
    x[i] = vx - px;
    y[i] = vy - py;
    r[i] = hypotq(x[i], y[i]);
    arm[i] = (hypotq(vx, vy) + r[i]) / r[i];
    if (v.w < 0) r[i] = -r[i];
    inverse_w[i] = port_double(v.k) / w;
  }
  for (int i = 0; i < 4; ++i) {
    const int n = (i + 1) & 3;
    __float128 alpha = atan2q(x[i] * y[n] - y[i] * x[n], x[i] * x[n] + y[i] * y[n]);
    if (r[i] * r[n] < 0) alpha += M_PIq;
    t[i] = tanq(alpha / 2);
    dt[i] = 0x1p-113Q * ((1 + t[i] * t[i]) / 2 * (4 + arm[i] + arm[n]) + 4 * fabsq(t[i]));
  }
  ByAngles out;
  __float128 sum = 0, sum_mu = 0, error = 0;
  for (int i = 0; i < 4; ++i) {
    const int before = (i + 3) & 3;
    const __float128 mu = (t[before] + t[i]) / r[i];
    out.lambda[i] = mu * inverse_w[i];
    sum += out.lambda[i];
    sum_mu += mu;
    error += (dt[before] + dt[i]) * fabsq(inverse_w[i] / r[i]) + 0x1p-113Q * (arm[i] + 4) * fabsq(out.lambda[i]);
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
    sharp += expected.tolerance < 1e-28Q;
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

// ---------------------------------------------------------------- singular pixels

TEST(TruthSingular, TwoCorners) {
  // A triangle as a quad whose first edge is collapsed on the pixel that the tie rule keeps.
  SnappedQuad quad = make_quad({Point{0, 0}, {0, 0}, {4, 0}, {0, 4}});
  quad.vertex[1].k = port(0.5);
  quad.vertex[1].z = port(0.25);
  const auto s = truth_of(quad).sample(0, 0);
  ASSERT_TRUE(s.covered && s.visible && !s.front);
  EXPECT_EQ(s.flags, flag_two_corner | flag_tie);
  EXPECT_EQ(s.lambda, (std::array<double, 4>{0.5, 0.5, 0, 0}));
  // M_0 = k_1 = 1/2, M_1 = k_0 = 1: z = (0 * 1/2 + 1/4 * 1) / (1/2 + 1), a_0 = 1 - 1, a_1 = 1 over sum(M k) = 1.
  EXPECT_NEAR(s.z, 1.0 / 6, double_ulp);
  EXPECT_EQ(s.attribute[0], 0);
  EXPECT_EQ(s.attribute[1], 1);
  EXPECT_EQ(s.condition, 1);
}

TEST(TruthSingular, OneCornerBeforeAnotherEdge) {
  // Vertex 0 lies on the pixel and the pixel on edge 1-2 as well: the corner wins. The quad is the triangle 0, 2, 3, to
  // the right of the pixel and, there, above the line y = x/2; the moved pixel centre (eps, eps^2) is in it.
  const auto s = truth_of(make_quad({Point{0, 0}, {0, 4}, {0, -4}, {4, 2}})).sample(0, 0);
  ASSERT_TRUE(s.covered);
  EXPECT_EQ(s.flags, flag_on_vertex | flag_tie);
  EXPECT_EQ(s.lambda, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(s.z, 0);
  EXPECT_EQ(s.condition, 1);
}

TEST(TruthSingular, CrossingOfABowTie) {
  SnappedQuad quad = make_quad({Point{0, 0}, {6, 6}, {3, 0}, {1, 4}});
  const double k[4] = {1, 0.5, 2, 4};
  for (int i = 0; i < 4; ++i) quad.vertex[i].k = port(k[i]);
  const auto s = truth_of(quad).sample(2, 2);
  ASSERT_TRUE(s.covered);
  EXPECT_EQ(s.flags & ~flag_tie, flag_two_edge);
  // The pixel divides edge 01 as 1:2 (rho as 2:1) and edge 23 as 1:1 (rho equal); |edge 23| is not |edge 01|.
  const double e0 = 2 * k[0] + k[1], e2 = k[2] + k[3];
  const std::array<double, 4> expected{2 * k[0] / e0 / 2, k[1] / e0 / 2, k[2] / e2 / 2, k[3] / e2 / 2};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(s.lambda[i], expected[i], double_ulp);
  // z by the same M = lambda'/k, with W = 1 and Z = 0..3.
  double up = 0, down = 0;
  for (int i = 0; i < 4; ++i) {
    up += expected[i] / k[i] * i;
    down += expected[i] / k[i];
  }
  EXPECT_NEAR(s.z, up / down, 4 * double_ulp);
}

TEST(TruthSingular, TwoNeighbouringEdgesWithTheEyeInTheirTriangle) {
  // S_0, S_1, S_2 = (1,0), (-1,0), (2,0) at pixel (0, 0): edges 01 and 12 run through it. V_0 + 3 V_1 + V_2 = 0.
  const auto s = truth_of(make_quad({Point{1, 0, 1}, {-1, 0, 0}, {2, 0, -1}, {0, 5, 1}})).sample(0, 0);
  ASSERT_TRUE(s.covered);
  EXPECT_TRUE(s.eye_in_hull);
  EXPECT_EQ(s.flags, flag_two_edge | flag_tie | flag_homogeneous);
  // Edge 01: 1/2, 1/2. Edge 12 with rho 1, 1/2: 2/3, 1/3. Mean:
  const std::array<double, 4> expected{1.0 / 4, 7.0 / 12, 1.0 / 6, 0};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(s.lambda[i], expected[i], double_ulp);
  EXPECT_TRUE(s.visible) << "sum(lambda w) = 1/4 - 1/6 > 0";
  EXPECT_NEAR(s.visible_margin, (1.0 / 4 - 1.0 / 6) / (1.0 / 4 + 1.0 / 6), double_ulp);
  EXPECT_NEAR(s.z, (7.0 / 12 + 2.0 / 6) / (1.0 / 12), 32 * double_ulp);  // Z = 0, 1, 2, 3
}

TEST(TruthSingular, AntipodalNeighboursCoverNothing) {
  // V_{i+1} = -2 V_i: the all-zero edge is false in either sense, and E20 is a negative multiple of the neighbouring
  // edge that the clause needs, or a positive one of an edge that it needs to be opposite.
  Random random(12);
  for (int n = 0; n < 500; ++n) {
    SnappedQuad quad = test::random_any_w(random, 8);
    const auto& v = quad.vertex[n & 3];
    auto& next = quad.vertex[(n + 1) & 3];
    next.x = -2 * v.x;
    next.y = -2 * v.y;
    next.w = -2 * v.w;
    const TruthQuad truth = truth_of(quad);
    for (int p = 0; p < 81; ++p) ASSERT_FALSE(truth.cover(p % 9 - 4, p / 9 - 4).covered);
  }
}

TEST(TruthSingular, EdgeOnAroundTheEyeIsNeverVisible) {
  // All four vertices in the plane y = 0 with the eye among them: sum(M w) = 0 exactly, off that plane.
  const TruthQuad truth = truth_of(make_quad({Point{2, 0, 1}, {-3, 0, 1}, {-1, 0, -1}, {4, 0, -1}}));
  int covered = 0;
  for (int y = -4; y <= 4; ++y) {
    for (int x = -4; x <= 4; ++x) {
      const auto s = truth.sample(x, y);
      if (!s.covered || y == 0) continue;
      ++covered;
      EXPECT_FALSE(s.visible);
      EXPECT_EQ(s.visible_margin, 0);
    }
  }
  EXPECT_GT(covered, 10);
}

TEST(Truth, CollapsedEdgeIsTheTriangle) {
  Random random(6);
  int tested = 0;
  while (tested < 5'000) {
    SnappedQuad quad = test::random_ordinary(random, 16);
    const int at = random.integer(0, 3), twin = (at + 1) & 3;
    quad.vertex[twin] = quad.vertex[at];
    for (auto& v : quad.vertex) v.k = port(1);
    const int px = random.integer(-8, 8), py = random.integer(-8, 8);
    const auto s = truth_of(quad).sample(px, py);
    if (!s.covered) continue;
    ++tested;
    // Barycentric coordinates of the triangle by areas (eq. 5), in integers.
    const std::array<SnappedVertex, 3> v{quad.vertex[at], quad.vertex[(at + 2) & 3], quad.vertex[(at + 3) & 3]};
    std::array<long double, 3> area;
    for (int i = 0; i < 3; ++i) {
      const auto &a = v[(i + 1) % 3], &b = v[(i + 2) % 3];
      const std::int64_t ax = a.x - px * one, ay = a.y - py * one, bx = b.x - px * one, by = b.y - py * one;
      area[i] = static_cast<long double>(ax * by - ay * bx);
    }
    const long double sum = area[0] + area[1] + area[2];
    ASSERT_NEAR(s.lambda[at] + s.lambda[twin], static_cast<double>(area[0] / sum), double_ulp);
    ASSERT_NEAR(s.lambda[(at + 2) & 3], static_cast<double>(area[1] / sum), double_ulp);
    ASSERT_NEAR(s.lambda[(at + 3) & 3], static_cast<double>(area[2] / sum), double_ulp);
  }
}

// ---------------------------------------------------------------- notches

TEST(Truth, ConditionOfANotchAndItsMeaning) {
  // Vertex 3 within 2^-6 px of the pixel. Where the pixel sees it at a reflex corner, t_2 and t_3 cancel. The exact sum
  // follows from T (1 - t_2 t_3), T the half-angle tangent between S_2 and S_0; every lambda' must agree with it.
  Random random(13);
  int notches = 0;
  double worst = 1;
  while (notches < 1'000) {
    SnappedQuad quad = test::random_ordinary(random, 16);
    quad.vertex[3].x = random.integer(-512, 512);
    quad.vertex[3].y = random.integer(-512, 512);
    const auto s = truth_of(quad).sample(0, 0);
    if (!s.covered || (s.flags & flag_tie)) continue;
    const auto half_tangent = [&](int i, int j) {
      const __float128 xi = quad.vertex[i].x, yi = quad.vertex[i].y, xj = quad.vertex[j].x, yj = quad.vertex[j].y;
      const __float128 area = xi * yj - yi * xj, dot = xi * xj + yi * yj;
      const __float128 both = hypotq(xi, yi) * hypotq(xj, yj);
      return dot < 0 ? (both - dot) / area : area / (both + dot);
    };
    const __float128 t0 = half_tangent(0, 1), t1 = half_tangent(1, 2), t2 = half_tangent(2, 3), t3 = half_tangent(3, 0);
    const auto m = [&](int i, __float128 sum) {
      return sum * port_double(quad.vertex[i].k) / hypotq(quad.vertex[i].x, quad.vertex[i].y);
    };
    const auto size = [](__float128 a, __float128 b) { return fabsq(a) + fabsq(b); };
    const std::array<__float128, 4> mk{m(0, t3 + t0), m(1, t0 + t1), m(2, t1 + t2),
                                       m(3, half_tangent(2, 0) * (1 - t2 * t3))};
    const __float128 sum = mk[0] + mk[1] + mk[2] + mk[3];
    const __float128 spread = m(0, size(t3, t0)) + m(1, size(t0, t1)) + m(2, size(t1, t2)) + m(3, size(t2, t3));
    for (int i = 0; i < 4; ++i) ASSERT_NEAR(s.lambda[i], static_cast<double>(mk[i] / sum), double_ulp);
    ASSERT_NEAR(s.condition / static_cast<double>(spread / fabsq(sum)), 1, 1e-14);
    notches += s.condition > 1.5;
    worst = std::max(worst, s.condition);
  }
  EXPECT_GT(worst, 4);
}

// ---------------------------------------------------------------- coverage

TEST(Truth, NotchIsWhereNeighbouringAnglesTurnAgainstEachOther) {
  // A dart with its notch at (0, 0): seen from between the arms the two edges at the notch turn the other way.
  const TruthQuad dart(make_quad({{{0, 0}, {8, -8}, {-16, 0}, {8, 8}}}), Config{}, DrawState{.attributes = 0});
  EXPECT_TRUE(dart.sample(-1, 2).covered);
  EXPECT_TRUE(dart.sample(-1, 2).notch);  // beyond the line of one edge of the notch
  EXPECT_TRUE(dart.sample(-4, 0).covered);
  EXPECT_FALSE(dart.sample(-4, 0).notch);  // sees the notch from behind: all four turn alike
  const TruthQuad square(make_quad({{{-4, -4}, {4, -4}, {4, 4}, {-4, 4}}}), Config{}, DrawState{.attributes = 0});
  for (int y = -4; y < 4; ++y)
    for (int x = -4; x < 4; ++x) EXPECT_FALSE(square.sample(x, y).notch) << x << ", " << y;
  // On one of the edges at the notch there is one neighbour less; at the crossing of a bow-tie the edges decide.
  const TruthQuad bowtie(make_quad({{{-4, -4}, {4, 4}, {4, -4}, {-4, 4}}}), Config{}, DrawState{.attributes = 0});
  EXPECT_FALSE(bowtie.sample(0, 0).notch);
  EXPECT_TRUE(bowtie.sample(-2, 0).covered);
  EXPECT_TRUE(bowtie.sample(-2, 0).notch);  // both crossing edges turn against the left one
}

TEST(TruthCoverage, MeshIsDrawnExactlyOnce) {
  // Integer vertices, so edges and corners meet pixel centres all the time; every winding and starting corner; cells
  // may be concave, never self-intersecting (displacements of at most 3 on a lattice of 8).
  Random random(7);
  for (int round = 0; round < 40; ++round) {
    Point lattice[5][5];
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 5; ++i) {
        const bool inner_x = i > 0 && i<4, inner_y = j> 0 && j < 4;
        lattice[j][i] = {8 * i + (inner_x ? random.integer(-3, 3) : 0), 8 * j + (inner_y ? random.integer(-3, 3) : 0)};
      }
    }
    std::vector<int> count(36 * 36);
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 4; ++i) {
        std::array<Point, 4> corner{lattice[j][i], lattice[j][i + 1], lattice[j + 1][i + 1], lattice[j + 1][i]};
        std::ranges::rotate(corner, corner.begin() + random.integer(0, 3));
        if (random.integer(0, 1)) std::ranges::reverse(corner);
        std::vector<std::array<Point, 4>> parts{corner};
        if (random.integer(0, 3) == 0) {
          // Along the diagonal through the reflex corner, if any, both triangles lie inside.
          const auto turn = [&](int a) {
            const auto &p = corner[(a + 3) & 3], &q = corner[a], &r = corner[(a + 1) & 3];
            return (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x);
          };
          const int sense = turn(0) + turn(2) > 0 ? 1 : -1;
          const int a = turn(1) * sense <= 0 || turn(3) * sense <= 0 ? 1 : 0;
          const auto at = [&](int n) { return corner[(a + n) & 3]; };
          parts = {{at(0), at(1), at(2), at(2)}, {at(0), at(0), at(2), at(3)}};
        }
        for (const auto& part : parts) {
          const TruthQuad truth = truth_of(make_quad(part));
          for (int p = 0; p < 36 * 36; ++p) count[p] += truth.cover(p % 36 - 2, p / 36 - 2).covered;
        }
      }
    }
    for (int p = 0; p < 36 * 36; ++p) {
      const int x = p % 36 - 2, y = p / 36 - 2;
      ASSERT_EQ(count[p], x >= 0 && x < 32 && y >= 0 && y < 32) << x << ' ' << y << " round " << round;
    }
  }
}

TEST(TruthCoverage, CoverIsTheCoveragePartOfSample) {
  Random random(8);
  int hull = 0, visible = 0;
  for (int n = 0; n < 60'000; ++n) {
    const TruthQuad truth = truth_of(test::random_any_w(random, 8));
    const int px = random.integer(-4, 4), py = random.integer(-4, 4);
    const auto s = truth.sample(px, py);
    const auto c = truth.cover(px, py);
    ASSERT_EQ(c.covered, s.covered);
    ASSERT_EQ(c.front, s.front);
    ASSERT_EQ(c.visible, s.visible);
    ASSERT_EQ(c.eye_in_hull, s.eye_in_hull);
    ASSERT_EQ(c.flags, s.flags & (flag_tie | flag_homogeneous));
    // The determinants decide what the sign of sum(M w) says.
    if (s.covered) {
      ASSERT_EQ(s.visible, s.visible_margin > 0);
    }
    hull += s.covered && s.eye_in_hull;
    visible += s.visible;
  }
  EXPECT_GT(hull, 1'000);
  EXPECT_GT(visible, 1'000);
}

TEST(TruthCoverage, BoundsHoldEveryCoveredPixel) {
  Random random(9);
  DrawState state;
  state.scissor_x0 = 3;
  state.scissor_y0 = 5;
  state.scissor_x1 = 40;
  state.scissor_y1 = 30;
  int covered = 0;
  for (int n = 0; n < 300; ++n) {
    const TruthQuad truth(test::random_ordinary(random, 32), config, state);
    const PixelRect box = truth.bounds();
    for (int y = state.scissor_y0; y < state.scissor_y1; ++y) {
      for (int x = state.scissor_x0; x < state.scissor_x1; ++x) {
        if (!truth.cover(x, y).covered) continue;
        ++covered;
        ASSERT_TRUE(x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1);
      }
    }
  }
  EXPECT_GT(covered, 10'000);
  EXPECT_EQ(TruthQuad(make_quad({Point{10, 7}, {20, 7}, {20, 9}, {10, 9}}), config, state).bounds(),
            (PixelRect{10, 7, 21, 10}));
  EXPECT_TRUE(TruthQuad(make_quad({Point{-10, 7}, {-5, 7}, {-5, 9}, {-10, 9}}), config, state).bounds().empty());
}

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
