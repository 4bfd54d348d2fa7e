// The snapping rules of snap.hpp: places, limits, refusals. snap_exact_test.cpp has the bits.
#include "model/port/snap.hpp"
#include "model/support/float113.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace quadrille {
namespace {

using golden::Prng;

const Config standard;
const DrawState draw;

/// What a vertex becomes where the other three are the same one.
SnappedVertex snap_vertex(const WindowVertex& v) {
  WindowQuad q;
  q.vertex = {v, v, v, v};
  return snap_quad(q, standard, draw).vertex[0];
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

TEST(Snap, PixelCentresAndHalfGrids) {
  // Pixel (px, py) has its centre at px + 0.5; k = 1/w for any w.
  for (const double w : {1.0, 2.0, 0.25, 3.0}) {
    const SnappedVertex s = snap_vertex({w * 10.5, w * 20.5, w * 0.5, w});
    EXPECT_EQ(s.x, 10 << 15);
    EXPECT_EQ(s.y, 20 << 15);
    EXPECT_EQ(s.w, 1 << 15);
    EXPECT_EQ(s.k.sig * std::ldexp(1.0, s.k.exp - 17), w == 3 ? 174763 * 0x1p-19 : 1 / w);
    EXPECT_EQ(s.z.sig, 0u) << "the base of depth is 1/2 exactly";
  }
  const auto at = [](double x) { return snap_vertex({x, 0.5, 0, 1}).x >> 7; };
  EXPECT_EQ(at(0.5 + 1.49 / 256), 1);
  EXPECT_EQ(at(0.5 + 1.51 / 256), 2);
  EXPECT_EQ(at(0.5 - 1.49 / 256), -1);
  EXPECT_EQ(at(0.5 - 1.51 / 256), -2);
}

TEST(Snap, HomogeneousLimitsAreHitExactly) {
  const int one = 1 << 15, limit = 1 << 30;
  const auto snap = [](double x, double y, double w) { return snap_vertex({x, y, 0, w}); };
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
    const double w = wild(rng, -79, 79), y = wild(rng, -79, 79);
    const SnappedVertex s = snap(wild(rng, -79, 79), y, w);
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
    const SnappedVertex b = snap_vertex({w * (bx + 0.5), w * (by + 0.5), 0, w});
    if (outside) {
      ASSERT_TRUE(std::abs(b.x) == 1 << 30 || std::abs(b.y) == 1 << 30);
      reduced_w += b.w < 1 << 15;
    } else {
      ASSERT_EQ(b.w, 1 << 15);
    }
    const SnappedVertex a = snap_vertex({rng.uniform(0, 512), rng.uniform(0, 512), 0, 1});
    using Line = std::array<Float113, 3>;
    const auto line = [&](Float113 x, Float113 y, Float113 z) -> Line {
      const Float113 ax = a.x / 32768.0, ay = a.y / 32768.0;
      return {ay * z - y, x - ax * z, ax * y - ay * x};
    };
    const Line exact = line(bx, by, 1), snapped = line(b.x / 32768.0, b.y / 32768.0, b.w / 32768.0);
    for (const double c : {0.0, 128.0, 256.0, 511.0}) {
      const Float113 x = along_x ? c : -(exact[1] * c + exact[2]) / exact[0];
      const Float113 y = along_x ? -(exact[0] * c + exact[2]) / exact[1] : c;
      if (!(x >= 0 && x <= 511 && y >= 0 && y <= 511)) continue;
      const double distance = static_cast<double>(snapped[0] * x + snapped[1] * y + snapped[2]) /
                              std::hypot(static_cast<double>(snapped[0]), static_cast<double>(snapped[1]));
      worst[outside] = std::max(worst[outside], std::fabs(distance));
    }
  }
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
    // Not denorm_min(): GCC 12 for aarch64 puts its 16 bytes of long double among the 8 of doubles.
    q.vertex[i] = {0x1p-1074, 0, 1, 0};
    expect_refused(q, vertex, "2^-80");
    for (const double bad : {128.0, -128.0, 1e30, nan, inf}) {
      q = good_quad();
      q.attribute[i][1] = bad;
      expect_refused(q, vertex, "attribute 1");
    }
    q = good_quad();
    q.attribute[i][1] = -127.999;
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

/// X, Y, W and k of a vertex: not its place in the quad counts, nor its neighbours, nor values.
TEST(Snap, PositionDependsOnTheVertexOnly) {
  Prng rng(9);
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
    b.vertex[to].z += 1;
    const SnappedQuad s = snap_quad(a, standard, draw), t = snap_quad(b, standard, draw);
    const SnappedVertex& u = s.vertex[from];
    const SnappedVertex& v = t.vertex[to];
    ASSERT_TRUE(u.x == v.x && u.y == v.y && u.w == v.w && u.k.exp == v.k.exp && u.k.sig == v.k.sig);
    bool ordinary = true;
    for (const SnappedVertex& corner : s.vertex) ordinary = ordinary && corner.w == 1 << standard.frac();
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
