// The pseudo-code in double and in single precision against the truth where it should work, and its documented failures
// where it should not.
#include "golden/reference/paper_float.hpp"

#include "golden/reference/test_quads.hpp"
#include "golden/reference/truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

namespace quadrille::golden {
namespace {

using test::make_quad;
using test::Point;
using test::port;
using test::Random;

const Config config;
const DrawState draw;

double port_double(const PortNumber& p) {
  return (p.neg ? -1.0 : 1.0) * p.sig * std::exp2(p.exp - (config.significand_bits - 1));
}

struct ErrorBound {
  double lambda = 0;  ///< of lambda'
  double z = 0;       ///< of z, for |z_i| <= 2
};

/// Half a unit in the last place of 1: 2^-53 or 2^-24.
template <class Real>
constexpr double unit_roundoff = std::numeric_limits<Real>::epsilon() / 2;

/// First-order error of the pseudo-code in Real, u = unit_roundoff<Real>; the test quads' own numbers have at most 24
/// bits, so that reading them costs nothing:
///   v is off by u |v|, s by ds = u (|v| + |s|) per coordinate (two coordinates: factor 2 below);
///   A and D by e = 2 (|s| ds' + |s'| ds) + 3 u |s| |s'|, as is r r' (with its two roots and one product);
///   t = (r r' - D)/A by 2 e/|A| + |t| e/|A| + 2 u |t|;  mu = (t + t')/r by (dt + dt')/r + |mu| (ds/r + 3 u);
///   lambda' by 2 sum(d(mu/w)) / |sum(mu/w)| + 4 u, z by (sum(dmu) (2 + |z|) + 8 u sum|mu|) / |sum(mu)|.
/// The final factor 2 stands for second-order terms; the bound is used only where it is small.
template <class Real>
ErrorBound error_bound(const SnappedQuad& quad, int px, int py, double z) {
  constexpr double u = unit_roundoff<Real>;
  std::array<double, 4> x, y, r, ds, w, t, dt;
  for (int i = 0; i < 4; ++i) {
    const auto& v = quad.vertex[i];
    w[i] = std::ldexp(v.w, -test::frac) / port_double(v.k);
    const double vx = static_cast<double>(v.x) / v.w, vy = static_cast<double>(v.y) / v.w;
    x[i] = vx - px;
    y[i] = vy - py;
    r[i] = std::hypot(x[i], y[i]) * (v.w < 0 ? -1 : 1);
    ds[i] = u * (std::hypot(vx, vy) + std::abs(r[i]));
  }
  for (int i = 0; i < 4; ++i) {
    const int n = (i + 1) & 3;
    const double area = x[i] * y[n] - y[i] * x[n], dot = x[i] * x[n] + y[i] * y[n];
    const double e = 2 * (std::abs(r[i]) * ds[n] + std::abs(r[n]) * ds[i]) + 3 * u * std::abs(r[i] * r[n]);
    // Either form of t: whichever does not cancel in this evaluation.
    const double both = r[i] * r[n];
    t[i] = both * dot < 0 ? (both - dot) / area : area / (both + dot);
    dt[i] = (2 + std::abs(t[i])) * e / std::abs(area) + 2 * u * std::abs(t[i]);
  }
  double sum = 0, sum_mu = 0, size_mu = 0, error = 0, error_mu = 0;
  for (int i = 0; i < 4; ++i) {
    const int b = (i + 3) & 3;
    const double mu = (t[b] + t[i]) / r[i];
    const double dmu = (dt[b] + dt[i]) / std::abs(r[i]) + std::abs(mu) * (ds[i] / std::abs(r[i]) + 3 * u);
    sum += mu / w[i];
    sum_mu += mu;
    size_mu += std::abs(mu);
    error += (dmu + 3 * u * std::abs(mu)) / std::abs(w[i]);
    error_mu += dmu;
  }
  return {2 * (2 * error / std::abs(sum) + 4 * u),
          2 * ((error_mu * (2 + std::abs(z)) + 8 * u * size_mu * (2 + std::abs(z))) / std::abs(sum_mu))};
}

template <class Real>
class PaperFloat : public testing::Test {
 protected:
  static constexpr bool single = std::is_same_v<Real, float>;
};
struct PrecisionName {
  template <class Real>
  static std::string GetName(int) {
    return std::is_same_v<Real, float> ? "Single" : "Double";
  }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PaperFloat, Precisions, PrecisionName);

TYPED_TEST(PaperFloat, AgreesWithTruthAwayFromSingularities) {
  constexpr double u = unit_roundoff<TypeParam>;
  constexpr double useful = TestFixture::single ? 0x1p-6 : 0x1p-20;  // bounds above say nothing
  Random random(30);
  int tested = 0, behind = 0, mixed = 0, sharp = 0, skipped = 0;
  for (int n = 0; n < 400'000; ++n) {
    const SnappedQuad quad = n % 4 ? test::random_any_w(random, 16) : test::random_ordinary(random, 16);
    const int px = random.integer(-3, 3), py = random.integer(-3, 3);
    const auto s = TruthQuad(quad, config, draw).sample(px, py);
    if (!s.covered || (s.flags & flag_tie)) continue;
    if (std::ranges::any_of(quad.vertex, [](const auto& v) { return v.w == 0; })) continue;
    const auto p = PaperQuad<TypeParam>(quad, config, draw).sample(px, py);
    const ErrorBound bound = error_bound<TypeParam>(quad, px, py, s.z);
    if (!(bound.lambda < useful)) {
      ++skipped;
      continue;
    }
    ++tested;
    ASSERT_TRUE(p.covered);
    ASSERT_FALSE(p.undefined);
    ASSERT_EQ(p.front, s.front);
    for (int i = 0; i < 4; ++i) {
      ASSERT_NEAR(p.lambda[i], s.lambda[i], bound.lambda);
      // sum(lambda' a) with |a_i| = |base| + |b_i| / k_i <= 5, and the rounding of each product and sum.
      ASSERT_NEAR(p.attribute[i], s.attribute[i], 20 * (bound.lambda + 9 * u));
    }
    // The sign of sum(mu) can be trusted where it stands clear of its own error.
    if (std::abs(s.visible_margin) > 0x1p-10 && bound.z < 0x1p-12 && std::abs(s.z) < 100) {
      ASSERT_EQ(p.visible, s.visible);
      ASSERT_NEAR(p.z, s.z, bound.z);
    }
    sharp += bound.lambda < 1e5 * u;
    behind += !s.visible;
    mixed += (s.flags & flag_homogeneous) != 0;
  }
  EXPECT_GT(tested, 30'000);
  EXPECT_GT(behind, 3'000);
  EXPECT_GT(mixed, 15'000);
  EXPECT_GT(sharp, tested * 9 / 10) << "the bound must say something";
  EXPECT_LT(skipped, tested / (TestFixture::single ? 5 : 20));
}

TYPED_TEST(PaperFloat, SnappedAndGivenQuadsAgree) {
  using Quad = PaperQuad<TypeParam>;
  constexpr double u = unit_roundoff<TypeParam>;
  // k = 1/w as an ordinary vertex has it, a power of two, so both readings hold the same numbers.
  Random random(31);
  int tested = 0;
  for (int n = 0; n < 20'000; ++n) {
    SnappedQuad quad = test::random_ordinary(random, 8);
    WindowQuad given;
    for (int i = 0; i < 4; ++i) {
      auto& v = quad.vertex[i];
      const double w = std::exp2(random.integer(-3, 3));
      v.k = port(1 / w);
      given.vertex[i] = {(std::ldexp(v.x, -test::frac) + 0.5) * w, (std::ldexp(v.y, -test::frac) + 0.5) * w,
                         (std::ldexp(quad.base.depth, -config.depth_bits) + port_double(v.z)) * w, w};
      for (int a = 0; a < 4; ++a) {
        const double base = std::ldexp(static_cast<double>(quad.base.attribute[a]), -config.attribute_frac());
        given.attribute[i].push_back(i == 0 ? base : base + port_double(v.attribute[a]) * w);
      }
    }
    const int px = random.integer(-4, 4), py = random.integer(-4, 4);
    const auto s = Quad(quad, config, draw).sample(px, py);
    const auto g = Quad(given, draw).sample(px, py);
    ASSERT_EQ(s.covered, g.covered);
    ASSERT_EQ(s.undefined, g.undefined);
    if (!s.covered || s.undefined) continue;
    ++tested;
    const ErrorBound bound = error_bound<TypeParam>(quad, px, py, s.z);
    const double tolerance = 2 * bound.lambda;
    if (!(tolerance < 1e7 * u)) continue;
    ASSERT_EQ(s.visible, g.visible);
    for (int i = 0; i < 4; ++i) {
      ASSERT_NEAR(s.lambda[i], g.lambda[i], tolerance);
      ASSERT_NEAR(s.attribute[i], g.attribute[i], 72 * (tolerance + 9 * u));  // four weights of either side, |a_i| <= 9
    }
    ASSERT_NEAR(s.z, g.z, 2 * bound.z);
  }
  EXPECT_GT(tested, 3'000);
}

TYPED_TEST(PaperFloat, WithoutPerspective) {
  constexpr double u = unit_roundoff<TypeParam>;
  DrawState flat;
  flat.perspective = false;
  SnappedQuad quad = make_quad({Point{0, 0}, {0, 4}, {4, 4}, {4, 0}});
  for (int i = 0; i < 4; ++i) quad.vertex[i].k = port(i + 1);  // must not matter
  const auto s = PaperQuad<TypeParam>(quad, config, flat).sample(2, 2);
  ASSERT_TRUE(s.covered && s.front && s.visible && !s.undefined);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(s.lambda[i], 0.25, 2 * u);
    EXPECT_NEAR(s.attribute[i], 0.25, 2 * u);
  }
  EXPECT_NEAR(s.z, 1.5, 8 * u);
}

TYPED_TEST(PaperFloat, UndefinedWhereItDividesByZero) {
  using Quad = PaperQuad<TypeParam>;
  // On an edge A = 0, at a vertex r = 0 (section 4.2); w = 0 has no screen position (eq. 1).
  const Quad square(make_quad({Point{0, 0}, {0, 4}, {4, 4}, {4, 0}}), config, draw);
  const auto edge = square.sample(0, 2), vertex = square.sample(0, 0), inner = square.sample(1, 2);
  ASSERT_TRUE(edge.covered && vertex.covered && inner.covered);
  EXPECT_TRUE(edge.undefined);
  EXPECT_TRUE(edge.flags & flag_on_edge);
  EXPECT_TRUE(vertex.undefined);
  EXPECT_TRUE(vertex.flags & flag_on_vertex);
  EXPECT_FALSE(inner.undefined);
  const auto zero_w = Quad(make_quad({Point{-4, -4}, {4, -4}, {1, 1, 0}, {-4, 4}}), config, draw).sample(0, 0);
  ASSERT_TRUE(zero_w.covered);
  EXPECT_TRUE(zero_w.undefined);
  // A collapsed edge has A = 0 everywhere: the printed t is 0/0.
  const auto triangle = Quad(make_quad({Point{0, 0}, {0, 4}, {4, 4}, {4, 4}}), config, draw).sample(1, 2);
  ASSERT_TRUE(triangle.covered);
  EXPECT_TRUE(triangle.undefined);
}

TYPED_TEST(PaperFloat, CoverageAgreesWithTruthOnTheGrid) {
  // Small integers are exact in either precision, so the tie rule must give the same answer.
  Random random(32);
  for (int n = 0; n < 20'000; ++n) {
    std::array<Point, 4> q;
    for (auto& p : q) p = {random.integer(0, 4), random.integer(0, 4), n % 2 ? random.integer(-1, 1) : 1};
    if (std::ranges::any_of(q, [](const auto& p) { return p.x == 0 && p.y == 0 && p.w == 0; })) continue;
    const SnappedQuad quad = make_quad(q);
    const TruthQuad truth(quad, config, draw);
    const PaperQuad<TypeParam> paper(quad, config, draw);
    for (int p = 0; p < 25; ++p) {
      const auto s = truth.cover(p % 5, p / 5);
      const auto f = paper.sample(p % 5, p / 5);
      ASSERT_EQ(f.covered, s.covered);
      ASSERT_EQ(f.front, s.front);
      ASSERT_EQ(f.flags & (flag_tie | flag_homogeneous), s.flags);
    }
  }
}

TYPED_TEST(PaperFloat, RoundsEveryStepInItsOwnPrecision) {
  // A corner on the straight line between its neighbours, n = 4096 to the right of the pixel and 1 from each: t of both
  // edges is (n sqrt(n^2 + 1) - n^2) / n = sqrt(n^2 + 1) - n, about 1/(2n). With the far corner n to the left
  // mu = (1/n^2, 2, 4, 2) up to relative 1/n^2, so lambda_0 = 1/(8 n^2) = 2^-27. But n^2 + 1 = 2^24 + 1 has 25 bits: in
  // single precision r is n, t is 0 and lambda_0 is 0. In double n sqrt(n^2 + 1) - n^2 = 1/2 loses 25 bits.
  constexpr int n = 4096;
  const auto quad = make_quad({Point{n, 0}, {n, 1}, {-n, 0}, {n, -1}});
  ASSERT_NEAR(TruthQuad(quad, config, draw).sample(0, 0).lambda[0], 0x1p-27, 0x1p-27 * 0x1p-22);
  const auto sample = PaperQuad<TypeParam>(quad, config, draw).sample(0, 0);
  ASSERT_TRUE(sample.covered);
  ASSERT_FALSE(sample.undefined);
  if (TestFixture::single)
    EXPECT_EQ(sample.lambda[0], 0);
  else
    EXPECT_NEAR(sample.lambda[0], 0x1p-27, 0x1p-27 * 0x1p-22);
}

TYPED_TEST(PaperFloat, SampleIsThePseudoCodeWhereCovered) {
  Random random(33);
  int covered = 0;
  for (int i = 0; i < 2'000; ++i) {
    const PaperQuad<TypeParam> quad(test::random_any_w(random, 16), config, draw);
    const auto sample = quad.sample(0, 0);
    if (!sample.covered) continue;
    const auto pixel = quad.interpolate(0, 0);
    static_assert(std::is_same_v<std::decay_t<decltype(pixel.t[0] + pixel.lambda[0] + pixel.z)>, TypeParam>);
    ++covered;
    ASSERT_EQ(sample.undefined, !pixel.defined);
    if (sample.undefined) continue;
    ASSERT_EQ(sample.z, pixel.z);
    for (int v = 0; v < 4; ++v) {
      ASSERT_EQ(sample.lambda[v], pixel.lambda[v]);
      ASSERT_EQ(sample.attribute[v], pixel.attribute[v]);
    }
  }
  EXPECT_GT(covered, 300);
}

}  // namespace
}  // namespace quadrille::golden
