// The snapping rules of snap.hpp, against 113-bit arithmetic.
#include "model/snap.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace quadrille {
namespace {

using golden::Prng;
using Real = __float128;

const Config standard;
const DrawState draw;

Real absolute(Real v) { return v < 0 ? -v : v; }
Real power(int e) { return static_cast<Real>(std::ldexp(1.0, e)); }

Real value(const PortNumber& n, const Config& c) {
  const Real m = static_cast<Real>(n.sig) * power(n.exp - (c.significand_bits - 1));
  return n.neg ? -m : m;
}

/// Nearest within half a unit of the last place; long double inputs may add 2^-60 relative.
void expect_nearest(const PortNumber& n, Real exact, const Config& c, const char* what) {
  if (exact == 0) {
    EXPECT_EQ(n.sig, 0u) << what;
    EXPECT_EQ(n.exp, 0) << what;
    EXPECT_FALSE(n.neg) << what;
    return;
  }
  ASSERT_GE(n.sig, 1u << (c.significand_bits - 1)) << what;
  ASSERT_LT(n.sig, 1ull << c.significand_bits) << what;
  ASSERT_GE(n.exp, -(1 << (Config::port_exp_bits - 1))) << what;
  ASSERT_LT(n.exp, 1 << (Config::port_exp_bits - 1)) << what;
  const Real half_ulp = power(n.exp - c.significand_bits);
  EXPECT_LE(static_cast<double>(absolute(value(n, c) - exact) / half_ulp), 1 + 0x1p-30) << what;
}

/// The rule for one vertex.
void expect_snapped(const WindowVertex& v, const SnappedVertex& s, const std::vector<double>& attributes,
                    const Config& c, const DrawState& state) {
  const Real x = static_cast<Real>(v.x) - static_cast<Real>(v.w) / 2,
             y = static_cast<Real>(v.y) - static_cast<Real>(v.w) / 2;
  const Real w = v.w;
  const Real band = power(c.pos_int());
  const std::int64_t limit = std::int64_t{1} << (c.pos_int() + c.frac()), one = std::int64_t{1} << c.frac();
  Real k;
  const auto inside = [&](Real p) { return absolute(p) < band - power(-c.subpixel_bits); };
  const auto outside = [&](Real p) { return absolute(p) > band; };
  const bool ordinary = w > 0 && inside(x / w) && inside(y / w);
  if (!ordinary && w > 0 && !outside(x / w) && !outside(y / w)) return;  // the last grid step: either way is right
  if (ordinary) {
    k = 1 / w;
    ASSERT_EQ(s.w, one);
    EXPECT_EQ(s.x % (1 << c.homogeneous_frac_bits), 0);
    EXPECT_EQ(s.y % (1 << c.homogeneous_frac_bits), 0);
    const Real half_grid = power(-c.subpixel_bits - 1) * (1 + power(-40));
    EXPECT_LE(static_cast<double>(absolute(s.x * power(-c.frac()) - x / w)), static_cast<double>(half_grid));
    EXPECT_LE(static_cast<double>(absolute(s.y * power(-c.frac()) - y / w)), static_cast<double>(half_grid));
  } else {
    Real extent = absolute(w);
    if (absolute(x) / band > extent) extent = absolute(x) / band;
    if (absolute(y) / band > extent) extent = absolute(y) / band;
    k = 1 / extent;
    EXPECT_TRUE(std::llabs(s.x) == limit || std::llabs(s.y) == limit || std::llabs(s.w) == one)
        << "the limit is hit exactly";
    EXPECT_LE(std::llabs(s.x), limit);
    EXPECT_LE(std::llabs(s.y), limit);
    EXPECT_LE(std::llabs(s.w), one);
    const Real half = (static_cast<Real>(1) / 2) * (1 + power(-20));
    EXPECT_LE(static_cast<double>(absolute(s.x - k * x * power(c.frac()))), static_cast<double>(half));
    EXPECT_LE(static_cast<double>(absolute(s.y - k * y * power(c.frac()))), static_cast<double>(half));
    EXPECT_LE(static_cast<double>(absolute(s.w - k * w * power(c.frac()))), static_cast<double>(half));
  }
  EXPECT_FALSE(s.k.neg);
  EXPECT_NE(s.k.sig, 0u);
  expect_nearest(s.k, k, c, "k");
  expect_nearest(s.z, k * static_cast<Real>(v.z), c, "Z");
  const Real scale = state.perspective ? k : s.w * power(-c.frac());
  for (std::size_t j = 0; j < attributes.size(); ++j)
    expect_nearest(s.attribute[j], scale * static_cast<Real>(attributes[j]), c, "b");
}

double wild(Prng& rng, double low, double high) { return rng.sign() * rng.log2_spread(low, high); }

WindowVertex random_vertex(Prng& rng) {
  WindowVertex v;
  v.w = rng.chance(0.6) ? rng.log2_spread(-10, 10) : rng.chance(0.2) ? 0 : wild(rng, -60, 60);
  if (v.w != 0 && rng.chance(0.6)) {
    v.x = v.w * rng.uniform(-100, 700);
    v.y = v.w * rng.uniform(-100, 700);
  } else {
    v.x = wild(rng, -40, 60);
    v.y = wild(rng, -40, 60);
  }
  v.z = rng.chance(0.1) ? 0 : v.w * rng.uniform(-1, 2);
  return v;
}

TEST(Snap, RandomVerticesFollowTheRules) {
  Prng rng(11);
  for (const auto& [vp, guard, sub, hom, s] :
       {std::array{12, 3, 8, 7, 18}, {12, 3, 8, 7, 26}, {6, 4, 2, 10, 8}, {14, 1, 8, 7, 24}, {10, 2, 4, 4, 12}}) {
    Config c;
    c.viewport_bits = vp;
    c.guard_bits = guard;
    c.subpixel_bits = sub;
    c.homogeneous_frac_bits = hom;
    c.significand_bits = s;
    c.attribute_slots = 8;
    c.validate();
    for (const bool perspective : {true, false}) {
      DrawState state;
      state.perspective = perspective;
      int ordinary = 0, homogeneous = 0;
      for (int n = 0; n < 4000 && !testing::Test::HasFailure(); ++n) {
        const WindowVertex v = random_vertex(rng);
        std::vector<double> a(8);
        for (double& value : a) value = rng.chance(0.2) ? 0 : rng.uniform(-7.9, 7.9);
        const SnappedVertex out = snap_vertex(v, a.data(), 8, c, state);
        expect_snapped(v, out, a, c, state);
        (out.w == 1 << c.frac() ? ordinary : homogeneous) += 1;
      }
      EXPECT_GT(ordinary, 500);
      EXPECT_GT(homogeneous, 500);
    }
  }
}

TEST(Snap, PixelCentresAndHalfGrids) {
  // Pixel (px, py) has its centre at px + 0.5; k = 1/w for any w.
  for (const double w : {1.0, 2.0, 0.25, 3.0}) {
    const SnappedVertex s = snap_vertex({w * 10.5, w * 20.5, w * 0.5, w}, nullptr, 0, standard, draw);
    EXPECT_EQ(s.x, 10 << 15);
    EXPECT_EQ(s.y, 20 << 15);
    EXPECT_EQ(s.w, 1 << 15);
    expect_nearest(s.k, 1 / static_cast<Real>(w), standard, "k");
    expect_nearest(s.z, 0.5, standard, "Z");
  }
  const auto at = [](double x) { return snap_vertex({x, 0.5, 0, 1}, nullptr, 0, standard, draw).x >> 7; };
  EXPECT_EQ(at(0.5 + 1.49 / 256), 1);
  EXPECT_EQ(at(0.5 + 1.51 / 256), 2);
  EXPECT_EQ(at(0.5 - 1.49 / 256), -1);
  EXPECT_EQ(at(0.5 - 1.51 / 256), -2);
}

TEST(Snap, HomogeneousLimitsAreHitExactly) {
  const int one = 1 << 15, limit = 1 << 30;
  const auto snap = [](double x, double y, double w) { return snap_vertex({x, y, 0, w}, nullptr, 0, standard, draw); };
  EXPECT_EQ(snap(100, 200, -1).w, -one) << "exactly -1 for an on-screen vertex behind the eye";
  EXPECT_EQ(snap(-100, -200, -2).w, -one);
  EXPECT_EQ(snap(-100, -200, -2).x, static_cast<int>((-100 + 1) * 0.5 * one));
  EXPECT_EQ(snap(3, 1, 0).x, limit);
  EXPECT_EQ(snap(3, 1, 0).y, static_cast<int>(std::nearbyint(limit / 3.0)));
  EXPECT_EQ(snap(3, 1, 0).w, 0);
  EXPECT_EQ(snap(1, -7, 0).y, -limit);
  EXPECT_EQ(snap(-0x1p70, 1, 0x1p-70).x, -limit);
  Prng rng(5);
  for (int n = 0; n < 20000; ++n) {
    // Rounding must not pass the limit, whatever the mantissas.
    const SnappedVertex s = snap(wild(rng, -79, 79), wild(rng, -79, 79), wild(rng, -79, 79));
    ASSERT_LE(std::llabs(s.x), limit);
    ASSERT_LE(std::llabs(s.y), limit);
    ASSERT_LE(std::llabs(s.w), one);
    ASSERT_TRUE(s.x != 0 || s.y != 0 || s.w != 0);
  }
}

/// The edge to a vertex that crosses the guard band: inside a 512x512 viewport the snapped edge lies within 0.0005 px
/// of the exact one on either side of the border, so what it jumps is not more than twice that (at most 0.001 px).
TEST(Snap, GuardBandCrossingIsSmooth) {
  constexpr double largest_error = 0.0005;
  Prng rng(6);
  double worst[2] = {0, 0};
  int reduced_w = 0;
  for (int n = 0; n < 40000; ++n) {
    const double side = rng.sign(), w = rng.log2_spread(-3, 3);
    const bool along_x = rng.chance(0.5), outside = rng.chance(0.5);
    const double far = side * (32768.0 + (outside ? 1 : -1) * rng.uniform(0.01, 3)),
                 across = rng.uniform(-20000, 20000);
    const double bx = along_x ? far : across, by = along_x ? across : far;
    const SnappedVertex b = snap_vertex({w * (bx + 0.5), w * (by + 0.5), 0, w}, nullptr, 0, standard, draw);
    if (outside) {
      ASSERT_TRUE(std::abs(b.x) == 1 << 30 || std::abs(b.y) == 1 << 30);
      reduced_w += b.w < 1 << 15;
    } else {
      ASSERT_EQ(b.w, 1 << 15);
    }
    const SnappedVertex a = snap_vertex({rng.uniform(0, 512), rng.uniform(0, 512), 0, 1}, nullptr, 0, standard, draw);
    using Line = std::array<long double, 3>;
    const auto line = [&](long double x, long double y, long double z) -> Line {
      const long double ax = a.x / 32768.0L, ay = a.y / 32768.0L;
      return {ay * z - y, x - ax * z, ax * y - ay * x};
    };
    const Line exact = line(bx, by, 1), snapped = line(b.x / 32768.0L, b.y / 32768.0L, b.w / 32768.0L);
    for (const double c : {0.0, 128.0, 256.0, 511.0}) {
      const long double x = along_x ? c : -(exact[1] * c + exact[2]) / exact[0];
      const long double y = along_x ? -(exact[0] * c + exact[2]) / exact[1] : c;
      if (!(x >= 0 && x <= 511 && y >= 0 && y <= 511)) continue;
      const long double distance = (snapped[0] * x + snapped[1] * y + snapped[2]) / std::hypot(snapped[0], snapped[1]);
      worst[outside] = std::max(worst[outside], static_cast<double>(std::fabs(distance)));
    }
  }
  std::printf("largest edge error at the guard band: %.2e px inside, %.2e px outside\n", worst[0], worst[1]);
  EXPECT_LE(worst[0], largest_error);
  EXPECT_LE(worst[1], largest_error);
  EXPECT_GT(worst[1], 0);
  EXPECT_GT(reduced_w, 1000);
}

WindowQuad good_quad() {
  WindowQuad q;
  q.id = 7;
  q.vertex = {WindowVertex{1, 1, 0.5, 1}, {9, 1, 0.5, 1}, {9, 9, 0.5, 1}, {1, 9, 0.5, 1}};
  for (auto& a : q.attribute) a = {0.5, -1};
  return q;
}

void expect_refused(const WindowQuad& quad, int vertex, const std::string& word, const Config& c = standard) {
  try {
    static_cast<void>(snap_quad(quad, c, draw));
    ADD_FAILURE() << "not refused: " << word;
  } catch (const SnapError& e) {
    const std::string what = e.what();
    EXPECT_EQ(e.quad, quad.id);
    EXPECT_EQ(e.vertex, vertex) << what;
    EXPECT_NE(what.find("quad " + std::to_string(quad.id)), std::string::npos) << what;
    EXPECT_NE(what.find("vertex " + std::to_string(vertex)), std::string::npos) << what;
    EXPECT_NE(what.find(word), std::string::npos) << what;
  }
}

TEST(Snap, RefusalsNameQuadAndVertex) {
  ASSERT_NO_THROW(static_cast<void>(snap_quad(good_quad(), standard, draw)));
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const int vertex = static_cast<int>(i);
    for (double WindowVertex::*field : {&WindowVertex::x, &WindowVertex::y, &WindowVertex::z, &WindowVertex::w}) {
      for (const double bad : {nan, inf, -inf}) {
        WindowQuad q = good_quad();
        q.vertex[i].*field = bad;
        expect_refused(q, vertex, "NaN or infinite");
      }
      for (const double bad : {0x1.1p80, -0x1p300, std::numeric_limits<double>::max()}) {
        WindowQuad q = good_quad();
        q.vertex[i].*field = bad;
        expect_refused(q, vertex, "2^80");
      }
    }
    WindowQuad q = good_quad();
    q.vertex[i] = {0, 0, 1, 0};
    expect_refused(q, vertex, "(0, 0, 0)");
    q.vertex[i] = {-0.0, 0, 1, -0.0};
    expect_refused(q, vertex, "(0, 0, 0)");
    q.vertex[i] = {0x1p-81, 0x1p-90, 1, -0x1p-85};
    expect_refused(q, vertex, "2^-80");
    q.vertex[i] = {std::numeric_limits<double>::denorm_min(), 0, 1, 0};
    expect_refused(q, vertex, "2^-80");
    for (const double bad : {8.0, -8.0, 1e30, nan, inf}) {
      q = good_quad();
      q.attribute[i][1] = bad;
      expect_refused(q, vertex, "attribute 1");
    }
    q = good_quad();
    q.attribute[i][1] = -7.999;
    EXPECT_NO_THROW(static_cast<void>(snap_quad(q, standard, draw)));
  }
  WindowQuad q = good_quad();
  q.id = 1u << 24;
  expect_refused(q, 0, "quad_id_bits");
  // Attributes beyond the slots are not looked at.
  q = good_quad();
  q.attribute[2] = {0, 0, 0, 0, nan};
  EXPECT_NO_THROW(static_cast<void>(snap_quad(q, standard, draw)));
}

TEST(Snap, ExtremesStayInThePortFormat) {
  DrawState state;
  for (const double x : {0x1p80, 0x1p-80, 0.0})
    for (const double y : {0x1p80, -0x1p-80, 0.0})
      for (const double z : {0x1p80, 0x1p-80, -0x1p80})
        for (const double w : {0x1p80, -0x1p80, 0x1p-80, -0x1p-80, 0.0}) {
          if (x == 0 && y == 0 && w == 0) continue;
          const std::vector<double> a{7.99, -0x1p-60};
          const WindowVertex v{x, y, z, w};
          expect_snapped(v, snap_vertex(v, a.data(), 2, standard, state), a, standard, state);
        }
}

/// Nothing but the vertex counts: not its place in the quad, not its neighbours.
TEST(Snap, DependsOnTheVertexOnly) {
  Prng rng(9);
  const auto same = [](const SnappedVertex& a, const SnappedVertex& b) {
    const auto number = [](const PortNumber& p, const PortNumber& q) {
      return p.neg == q.neg && p.exp == q.exp && p.sig == q.sig;
    };
    bool equal = a.x == b.x && a.y == b.y && a.w == b.w && number(a.k, b.k) && number(a.z, b.z);
    for (std::size_t j = 0; j < max_attribute_slots; ++j) equal = equal && number(a.attribute[j], b.attribute[j]);
    return equal;
  };
  for (int n = 0; n < 2000; ++n) {
    WindowQuad a, b;
    for (std::size_t i = 0; i < 4; ++i) {
      a.vertex[i] = random_vertex(rng);
      b.vertex[i] = random_vertex(rng);
      for (int j = 0; j < 4; ++j) {
        a.attribute[i].push_back(rng.uniform(-1, 1));
        b.attribute[i].push_back(rng.uniform(-1, 1));
      }
    }
    b.id = 99;
    const std::size_t from = rng.below(4), to = rng.below(4);
    b.vertex[to] = a.vertex[from];
    b.attribute[to] = a.attribute[from];
    const SnappedQuad s = snap_quad(a, standard, draw), t = snap_quad(b, standard, draw);
    ASSERT_TRUE(same(s.vertex[from], t.vertex[to]));
    ASSERT_TRUE(same(s.vertex[from], snap_vertex(a.vertex[from], a.attribute[from].data(), 4, standard, draw)));
    bool ordinary = true;
    for (const SnappedVertex& v : s.vertex) ordinary = ordinary && v.w == 1 << standard.frac();
    ASSERT_EQ(is_ordinary(s, standard), ordinary);
  }
}

/// In the last half step of the guard band a vertex keeps W = 1 without lying on the grid of ordinary ones.
TEST(Snap, WOneIsNotOrdinaryInTheLastHalfStepOfTheGuardBand) {
  const double edge = std::ldexp(1.0, standard.pos_int()), step = std::ldexp(1.0, -standard.subpixel_bits);
  for (const double from_edge : {0.0, step / 8, step / 4, step, 1.0}) {
    WindowQuad q;
    for (std::size_t i = 0; i < 4; ++i) {
      q.vertex[i] = {edge + 0.5 - from_edge, static_cast<double>(i) + 0.25 + step / 4, 0, 1};
      q.attribute[i].assign(4, 0.0);
    }
    const SnappedQuad s = snap_quad(q, standard, draw);
    EXPECT_TRUE(is_ordinary(s, standard)) << from_edge;
    EXPECT_EQ(has_ordinary_vertices(s, standard), from_edge >= step) << from_edge;
  }
}

}  // namespace
}  // namespace quadrille
