// The lecture's integer rasterizer against hand-made cases and exact edge functions, and how precise its numbers are.
#include "golden/methods/triangle.hpp"
#include "golden/methods/builders.hpp"
#include "golden/methods/triangle_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

namespace quadrille::golden::methods {
namespace {

/// A quad from points on the screen.
Quad make_quad(const std::array<Point, 4>& p, const std::array<double, 4>& w = {1, 1, 1, 1},
               const std::array<double, 4>& z = {}) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {p[i].x * w[i], p[i].y * w[i], z[i] * w[i], w[i]};
  return quad;
}

std::vector<MethodSample> draw(const Quad& quad, int bits = 12, int size = view_size, bool perspective = true) {
  std::vector<MethodSample> out;
  make_triangle(bits)->draw(quad, {size, size, perspective}, out);
  return out;
}

TEST(LecturePlane, ValuesByHand) {
  // Twice the area is 256: nothing is truncated. Value 255 at vertex 0, 0 on the opposite edge.
  const auto t = integer_triangle::set_up({Point{2, 2}, {18, 2}, {2, 18}}, view_size, view_size, 12);
  ASSERT_TRUE(t);
  EXPECT_FALSE(t->flipped);
  EXPECT_EQ(t->area, 256 * 4096);
  const PlaneEquation plane = integer_triangle::plane_equation(*t, {255, 0, 0}, 12);
  EXPECT_EQ(plane.a, -255 * 256);
  EXPECT_EQ(plane.b, -255 * 256);
  EXPECT_EQ(plane.c, 255 * 256 * 20);
  // x + 10 y + 100 through (2, 2), (18, 2), (2, 18).
  const PlaneEquation other = integer_triangle::plane_equation(*t, {122, 138, 282}, 12);
  EXPECT_EQ(other.a, 4096);
  EXPECT_EQ(other.b, 10 * 4096);
  EXPECT_EQ(other.c, 100 * 4096);
}

TEST(LecturePlane, ValuesNearExactBarycentricCoordinates) {
  Prng prng(5);
  double worst = 0;
  std::size_t checked = 0;
  for (int i = 0; i < 1500; ++i) {
    const ExactTriangle t = random_triangle(prng);
    const int bits = static_cast<int>(prng.integer(4, 20));
    const double u = std::ldexp(1.0, -bits), area = t.square_pixels(std::abs(t.area()));
    if (area < 8 * u) continue;
    const std::array<double, 3> p{prng.uniform(0, 255), prng.uniform(0, 255), prng.uniform(0, 255)};
    const auto set_up = integer_triangle::set_up(t.corners(), view_size, view_size, bits);
    ASSERT_TRUE(set_up);
    const std::array<PlaneEquation, 1> plane{integer_triangle::plane_equation(*set_up, p, bits)};
    integer_triangle::scan(*set_up, plane, true, [&](int x, int y, const std::array<std::int64_t, 1>& value) {
      // lambda_k = e_k / area. The integers' e_k is off by less than (1 + x + y) u and their area by less than 3 u, so
      // the quotient by less than ((1 + x + y) u + |lambda| 3 u) / (area - 3 u). The plane's own A, B, C then lose less
      // than a unit each.
      double exact = 0, bound = (1 + x + y) * u + 1e-9;
      for (std::size_t k = 0; k < 3; ++k) {
        const double lambda = t.square_pixels(t.edge((k + 1) % 3, x, y)) / area;
        exact += p[k] * lambda;
        bound += p[k] * ((1 + x + y) * u + std::abs(lambda) * 3 * u) / (area - 3 * u);
      }
      const double error = std::abs(static_cast<double>(value[0]) * u - exact);
      EXPECT_LT(error, bound) << "pixel " << x << ", " << y << " with " << bits << " bits";
      worst = std::max(worst, error / bound);
      ++checked;
    });
  }
  EXPECT_GT(checked, 1000000u);
  EXPECT_GT(worst, 0.3);  // the bound is no idle one
}

TEST(LecturePlane, SlopesOfSliversSaturate) {
  // Area of one unit of 20 bits, slopes beyond 2^45 units: the scan stays inside 64 bits (the sanitizers watch) and the
  // samples inside their range.
  const Quad sliver = make_quad({Point{0.5, 0.5}, {4000.5, 4000.5}, {2000.5, 2000.5 + 0x1p-31}, {0.5, 3000.5}});
  const std::vector<MethodSample> samples = draw(sliver, 20, 4096);
  EXPECT_GT(samples.size(), 4000u);
  for (const MethodSample& s : samples) {
    for (const double lambda : s.lambda) ASSERT_TRUE(lambda >= 0 && lambda <= 1);
  }
}

TEST(TriangleMethod, CornersAndEdges) {
  // Corners on pixel centres; clockwise on the screen. Sides of 16: all coefficients are exact.
  const Quad quad =
      make_quad({Point{2.5, 2.5}, {18.5, 2.5}, {18.5, 18.5}, {2.5, 18.5}}, {1, 1, 1, 1}, {0, 0.5, 1, 0.5});
  const std::vector<MethodSample> samples = draw(quad);
  // 17 x 17 pixels, the 17 on the diagonal twice: of two triangles both draw a tie.
  EXPECT_EQ(samples.size(), 17u * 17u + 17u);
  for (const MethodSample& s : samples) {
    EXPECT_FALSE(s.front);
    EXPECT_FALSE(s.undefined);
    const double u = (s.x - 2) / 16.0, v = (s.y - 2) / 16.0;
    ASSERT_TRUE(u >= 0 && u <= 1 && v >= 0 && v <= 1);
    const std::array<double, 4> expected =
        v <= u ? std::array<double, 4>{1 - u, u - v, v, 0} : std::array<double, 4>{1 - v, 0, u, v - u};
    EXPECT_EQ(s.lambda, expected) << s.x << ", " << s.y;
    EXPECT_EQ(s.z, (u + v) / 2);
  }
  for (const auto& [pixel, times] : count(samples)) EXPECT_EQ(times, pixel.first == pixel.second ? 2 : 1);

  Quad turned = quad;
  std::swap(turned.vertex[1], turned.vertex[3]);
  for (const MethodSample& s : draw(turned)) EXPECT_TRUE(s.front);
}

TEST(TriangleMethod, NeighboursBothDrawTiesAndLeaveNothingOut) {
  const Quad left = make_quad({Point{2, 2}, {6.5, 2}, {6.5, 9}, {2, 9}});
  const Quad right = make_quad({Point{6.5, 2}, {12, 2}, {12, 9}, {6.5, 9}});
  std::vector<MethodSample> both = draw(left);
  const std::vector<MethodSample> more = draw(right);
  // Centres 2.5 to 11.5 and 2.5 to 8.5; column 6 lies on the shared edge.
  std::set<Pixel> seen, first;
  for (const MethodSample& s : both) first.emplace(s.x, s.y);
  seen = first;
  std::set<Pixel> shared;
  for (const MethodSample& s : more) {
    if (first.contains({s.x, s.y})) shared.emplace(s.x, s.y);
    seen.emplace(s.x, s.y);
  }
  std::set<Pixel> column;
  for (int y = 2; y < 9; ++y) column.emplace(6, y);
  EXPECT_EQ(shared, column);
  EXPECT_EQ(seen.size(), 10u * 7u);

  // Convex quads, the diagonal anywhere: at every pixel at least one of the two triangles' shared edges says inside, so
  // only the outline decides. Pixels deep inside are never missing, with however few bits.
  Prng prng(6);
  for (int i = 0; i < 300; ++i) {
    std::array<Point, 4> p{Point{20, 20}, {100, 20}, {100, 100}, {20, 100}};
    for (Point& q : p) q.x += prng.uniform(-15, 15), q.y += prng.uniform(-15, 15);
    const int bits = static_cast<int>(prng.integer(4, 20));
    const auto drawn = count(draw(make_quad(p), bits));
    const double rim = (3 + 2 * view_size) * std::ldexp(1.0, -bits);
    for (int y = 0; y < view_size; ++y) {
      for (int x = 0; x < view_size; ++x) {
        bool deep = true;
        for (std::size_t k = 0; k < 4; ++k) {
          const Point &a = p[k], &b = p[(k + 1) & 3];
          deep &= (b.x - a.x) * (y + 0.5 - a.y) - (b.y - a.y) * (x + 0.5 - a.x) > rim;
        }
        if (deep) {
          ASSERT_TRUE(drawn.contains({x, y})) << x << ", " << y << " with " << bits << " bits";
        }
      }
    }
  }
}

TEST(TriangleMethod, NoPerspectiveCorrection) {
  const std::array<Point, 4> p{Point{10, 12}, {90, 20}, {80, 99}, {5, 70}};
  const std::array<double, 4> z{0.1, 0.7, 0.4, 0.9};
  const std::vector<MethodSample> flat = draw(make_quad(p, {1, 1, 1, 1}, z));
  ASSERT_GT(flat.size(), 4000u);
  for (const bool perspective : {false, true}) {
    const std::vector<MethodSample> deep = draw(make_quad(p, {1, 4, 0.5, 2}, z), 12, view_size, perspective);
    ASSERT_EQ(deep.size(), flat.size());
    for (std::size_t i = 0; i < flat.size(); ++i) {
      ASSERT_EQ(deep[i].x, flat[i].x);
      ASSERT_EQ(deep[i].y, flat[i].y);
      ASSERT_EQ(deep[i].lambda, flat[i].lambda);
      ASSERT_EQ(deep[i].z, flat[i].z);
    }
  }
}

TEST(TriangleMethod, WeightsAreClampedAndNearlySumToOne) {
  Prng prng(8);
  std::size_t drawn = 0, zero = 0;
  for (int i = 0; i < 1000; ++i) {
    std::array<Point, 4> p;
    for (Point& q : p) q = {prng.uniform(0, 128), prng.uniform(0, 128)};
    const int bits = static_cast<int>(prng.integer(4, 12));
    const double u = std::ldexp(1.0, -bits);
    for (const std::size_t third : {1u, 3u}) {  // triangles 012 and 032, corners 2 and 3 of the quad coinciding
      const std::array<Point, 3> t{p[0], p[third], p[2]};
      const double area = std::abs((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x));
      if (area < 1000) continue;
      for (const MethodSample& s : draw(make_quad({t[0], t[1], t[2], t[2]}), bits)) {
        double sum = 0;
        for (const double lambda : s.lambda) {
          ASSERT_TRUE(lambda >= 0 && lambda <= 1);
          sum += lambda;
        }
        // Of each of three weights, as in ValuesNearExactBarycentricCoordinates; the exact ones lie in [0, 1] but for
        // as much again.
        const double steps = 1 + s.x + s.y;
        ASSERT_NEAR(sum, 1, 3 * steps * u / 255 + 2 * 3 * (steps + 6) * u / (area - 3 * u));
        ASSERT_EQ(s.lambda[3], 0);
        ++drawn;
        zero += s.lambda[0] == 0 || s.lambda[1] == 0 || s.lambda[2] == 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(drawn, 1000000u);
  EXPECT_GT(zero, 1000u);
}

TEST(TriangleMethod, CensusAndRefusals) {
  const std::array<Point, 4> p{Point{1, 1}, {9, 1}, {9, 9}, {1, 9}};
  std::vector<Quad> quads{make_quad(p), make_quad({p[0], p[1], p[2], p[2]}), make_quad(p), make_quad(p), make_quad(p)};
  quads[2].vertex[1].w = 0;
  quads[3].vertex[3].w = -1;
  quads[4].vertex[0].x = 0x1p21;  // beyond the guard band
  quads.push_back(quads[1]);
  quads.back().texture[3] = {0, 1};  // a collapsed edge with two textures: a quad
  const auto method = make_triangle(12);
  const Census expected{.quads = 6, .refused = 3, .emitted_quads = 3, .triangles = 5};
  EXPECT_EQ(method->census(quads, {}), expected);
  for (std::size_t i = 2; i < 5; ++i) EXPECT_TRUE(draw(quads[i]).empty()) << i;
  // Centres with x - 1 >= y - 1, both edges of length 8 without their ends' ties: 8 + 7 + ... + 1.
  EXPECT_EQ(draw(quads[1]).size(), 36u);
  EXPECT_EQ(draw(quads[5]).size(), 36u);
  // Corners are told apart by x + 2 y: 3, 11, 27, 19.
  const auto outlines = [&](const Quad& quad) {
    std::vector<std::vector<double>> out;
    for (const auto& polygon : method->wireframe(quad, {})) {
      out.emplace_back();
      for (const WindowVertex& v : polygon) out.back().push_back(v.x + 2 * v.y);
    }
    return out;
  };
  EXPECT_EQ(outlines(quads[0]), (std::vector<std::vector<double>>{{3, 11, 27}, {3, 27, 19}}));
  EXPECT_EQ(outlines(quads[1]), (std::vector<std::vector<double>>{{3, 11, 27}}));
  EXPECT_EQ(outlines(quads[5]), (std::vector<std::vector<double>>{{3, 11, 27}, {3, 27, 27}}));
  EXPECT_TRUE(outlines(quads[2]).empty());
  EXPECT_EQ(method->name(), "triangle:12");
  EXPECT_EQ(make_triangle(7)->name(), "triangle:7");
}

TEST(LecturePrecision, ByHand) {
  // 4097 * 4099 = 16793603 is odd and above 2^24: a float holds 16793604. 4098 * 4097 = 16789506 fits. Exactly C =
  // 4097, naively 4098: a pixel squared too much. A = -2, B = 1: -(-2 * 8195 + 8196) / 2 = 4097.
  const std::array<std::array<FloatPoint, 2>, 2> edges{{{{{4097, 4097}, {4098, 4099}}}, {{{0, 0}, {1, 1}}}}};
  const auto precision = integer_triangle::edge_precision(edges, 12);
  EXPECT_EQ(precision.naive.max, 4096);
  EXPECT_DOUBLE_EQ(precision.naive.rms, 4096 / std::sqrt(2.0));
  for (const auto& error : {precision.averaged, precision.printed}) {
    EXPECT_EQ(error.max, 0);
    EXPECT_EQ(error.rms, 0);
  }
  EXPECT_EQ(integer_triangle::edge_precision({}, 12).naive.rms, 0);
}

TEST(LecturePrecision, AveragingBeatsTheNaiveForm) {
  std::printf("from the origin  naive max, rms  averaged max, rms  printed max, rms (units of 2^-12)\n");
  for (const double far : {128.0, 512.0, 2048.0, 4096.0}) {
    Prng prng(7);
    std::vector<std::array<FloatPoint, 2>> edges(200000);
    for (auto& [p, q] : edges) {
      const double x = prng.uniform(far / 2, far - 8), y = prng.uniform(far / 2, far - 8);
      p = {static_cast<float>(x), static_cast<float>(y)};
      q = {static_cast<float>(x + prng.uniform(0, 7.9)), static_cast<float>(y + prng.uniform(-7.9, 7.9))};
    }
    const auto [naive, averaged, printed] = integer_triangle::edge_precision(edges, 12);
    std::printf("%8.0f  %.4g, %.4g  %.4g, %.4g  %.4g, %.4g\n", far, naive.max, naive.rms, averaged.max, averaged.rms,
                printed.max, printed.rms);
    // A float below the power of two V is rounded by at most 2^-25 V. Naive: two products below far^2; their difference
    // is exact. Averaged: two sums below 2 far, times at most 8, two products below 16 far and their sum below 32 far,
    // all halved. Printed: the two sums alone.
    const double unit = std::ldexp(1.0, 12 - 25);
    EXPECT_LE(naive.max, 2 * far * far * unit);
    EXPECT_LE(averaged.max, (2 * 8 * 2 * far + 2 * 16 * far + 32 * far) / 2 * unit);
    EXPECT_LE(printed.max, 2 * 8 * 2 * far / 2 * unit);
    EXPECT_GT(naive.rms, far / 64 * averaged.rms);
    EXPECT_GT(averaged.rms, printed.rms);
  }
}

}  // namespace
}  // namespace quadrille::golden::methods
