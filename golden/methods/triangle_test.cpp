// The lecture's integer rasterizer against hand-made cases and exact edge functions, and how precise its numbers are.
#include "golden/methods/triangle.hpp"

#include "golden/methods/builders.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace quadrille::golden::methods {
namespace {

using integer_triangle::EdgeEquation;
using integer_triangle::FloatPoint;
using integer_triangle::PlaneEquation;
using integer_triangle::Point;
using integer_triangle::Triangle;

using Corners = std::array<Point, 3>;
using Pixel = std::pair<int, int>;

constexpr int view_size = 128;

/// Vertices in units of 2^-fraction pixel, fraction <= 16, and their edge functions in exact integers (units
/// 2^-2 fraction), whichever way the vertices turn.
struct ExactTriangle {
  int fraction = 8;
  std::array<std::int64_t, 3> x{}, y{};

  Corners corners() const {
    Corners out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = {std::ldexp(x[i], -fraction), std::ldexp(y[i], -fraction)};
    return out;
  }
  std::int64_t area() const { return (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]); }
  /// Of edge i to i + 1: the cross product of the edge with the way from its first vertex to the pixel, positive
  /// inside.
  std::int64_t edge(std::size_t i, int px, int py) const {
    const std::size_t j = (i + 1) % 3;
    const std::int64_t unit = 1 << fraction;
    const std::int64_t e = (x[j] - x[i]) * (py * unit - y[i]) - (y[j] - y[i]) * (px * unit - x[i]);
    return area() < 0 ? -e : e;
  }
  bool inside(int px, int py) const {
    return area() != 0 && edge(0, px, py) >= 0 && edge(1, px, py) >= 0 && edge(2, px, py) >= 0;
  }
  double square_pixels(std::int64_t value) const { return std::ldexp(static_cast<double>(value), -2 * fraction); }
};

/// Up to a quarter of the view outside of it on every side; every fourth is small, every fourth thin.
ExactTriangle random_triangle(Prng& prng, int fraction = 8) {
  const std::int64_t pixel = 1 << fraction, low = -32 * pixel, high = (view_size + 32) * pixel;
  ExactTriangle t{.fraction = fraction};
  for (std::size_t i = 0; i < 3; ++i) t.x[i] = prng.integer(low, high), t.y[i] = prng.integer(low, high);
  const std::uint64_t kind = prng.below(4);
  if (kind == 0) {
    for (std::size_t i = 1; i < 3; ++i) {
      t.x[i] = t.x[0] + prng.integer(-6 * pixel, 6 * pixel);
      t.y[i] = t.y[0] + prng.integer(-6 * pixel, 6 * pixel);
    }
  } else if (kind == 1) {
    t.x[2] = (t.x[0] + t.x[1]) / 2 + prng.integer(-pixel, pixel);
    t.y[2] = (t.y[0] + t.y[1]) / 2 + prng.integer(-pixel, pixel);
  }
  return t;
}

std::vector<Pixel> pixels(const Corners& corners, int bits, int size = view_size, bool early_exit = true) {
  std::vector<Pixel> out;
  if (const auto t = integer_triangle::set_up(corners, size, size, bits)) {
    integer_triangle::scan(*t, std::array<PlaneEquation, 0>{}, early_exit,
                           [&](int x, int y, const std::array<std::int64_t, 0>&) { out.emplace_back(x, y); });
  }
  return out;
}

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

std::map<Pixel, int> count(const std::vector<MethodSample>& samples) {
  std::map<Pixel, int> out;
  for (const MethodSample& s : samples) ++out[{s.x, s.y}];
  return out;
}

TEST(LectureEdge, CoefficientsByHand) {
  // A = 1 - 3, B = 6 - 2; -2 x + 4 y + C is 0 at (2, 1) with C = 0.
  const EdgeEquation edge({2, 1}, {6, 3}, 12);
  EXPECT_EQ(edge.a, -2 * 4096);
  EXPECT_EQ(edge.b, 4 * 4096);
  EXPECT_EQ(edge.c, 0);
  EXPECT_EQ(edge.flag, 1);
  EXPECT_EQ(EdgeEquation({6, 3}, {2, 1}, 12).flag, 8);
  EXPECT_EQ(EdgeEquation({5, 5}, {5, 5}, 12).flag, 9);
  // Towards 0 on both sides: with 4 bits 0.99 units become 0, and -1.99 units -1.
  EXPECT_EQ(EdgeEquation({0, 0.99 / 16}, {0, 0}, 4).a, 0);
  EXPECT_EQ(EdgeEquation({0, 0}, {0, 0.99 / 16}, 4).a, 0);
  EXPECT_EQ(EdgeEquation({1.99 / 16, 0}, {0, 0}, 4).b, -1);
  // A = -1/4, B = 2, and at (1, 1.5) -C = A + 1.5 B = 2.75: 44 units of 1/16; of the 5.5 halves 5 stay.
  EXPECT_EQ(EdgeEquation({1, 1.5}, {3, 1.75}, 4).c, -44);
  EXPECT_EQ(EdgeEquation({1, 1.5}, {3, 1.75}, 1).c, -5);
}

TEST(LectureEdge, BackwardsIsExactlyNegated) {
  Prng prng(1);
  for (int i = 0; i < 10000; ++i) {
    const Point p{prng.uniform(-50, 200), prng.uniform(-50, 200)}, q{prng.uniform(-50, 200), prng.uniform(-50, 200)};
    for (const int bits : {4, 12, 20}) {
      const EdgeEquation forth(p, q, bits), back(q, p, bits);
      ASSERT_EQ(forth.a, -back.a);
      ASSERT_EQ(forth.b, -back.b);
      ASSERT_EQ(forth.c, -back.c);
    }
  }
}

TEST(LectureBoundingBox, FlagsFindTheExtremes) {
  Prng prng(2);
  std::set<std::pair<int, int>> patterns;
  for (int i = 0; i < 20000; ++i) {
    ExactTriangle t = random_triangle(prng);
    if (i % 2 == 0) {  // few different coordinates: every tie
      for (std::size_t k = 0; k < 3; ++k) t.x[k] = prng.integer(0, 2) * 1000, t.y[k] = prng.integer(0, 2) * 1000;
    }
    const Corners c = t.corners();
    const auto set_up = integer_triangle::set_up(c, view_size, view_size, 12);
    ASSERT_EQ(set_up.has_value(), t.area() != 0);
    if (!set_up) continue;
    const auto [x_min, x_max] = std::minmax({c[0].x, c[1].x, c[2].x});
    const auto [y_min, y_max] = std::minmax({c[0].y, c[1].y, c[2].y});
    ASSERT_EQ(set_up->x_min, std::max(static_cast<int>(x_min), 0));
    ASSERT_EQ(set_up->x_max, std::min(static_cast<int>(x_max + 1), view_size - 1));
    ASSERT_EQ(set_up->y_min, std::max(static_cast<int>(y_min), 0));
    ASSERT_EQ(set_up->y_max, std::min(static_cast<int>(y_max + 1), view_size - 1));
    int flags = 0;
    for (std::size_t k = 0; k < 3; ++k) flags += EdgeEquation(c[k], c[(k + 1) % 3], 12).flag << k;
    patterns.emplace(flags & 7, flags >> 3);
  }
  EXPECT_EQ(patterns.size(), 36u);  // six orders in x times six in y
}

TEST(LectureBoundingBox, AllThreeFlagsOfATriangleThinnerThanAUnit) {
  // Steps of x: 2/16384, -1/16384, -1/16384, all 0 units of 1/4096. Twice the area is
  // 2/16384 * 20 - 100 * 1/16384 = -60/16384 = -15/4096: not degenerate.
  const Corners thin{Point{5, 0}, {5 + 0x2p-14, 100}, {5 + 0x1p-14, 20}};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(EdgeEquation(thin[i], thin[(i + 1) % 3], 12).flag & 1, 1);
  const auto t = integer_triangle::set_up(thin, view_size, view_size, 12);
  ASSERT_TRUE(t);
  EXPECT_TRUE(t->flipped);
  EXPECT_EQ(t->x_min, 5);
  EXPECT_EQ(t->x_max, 6);
  EXPECT_EQ(t->y_min, 0);
  EXPECT_EQ(t->y_max, 101);
}

TEST(LectureScan, TiesOnAllEdgesAreDrawn) {
  // x >= 2, y >= 2, x + y <= 8: rows of 5, 4, 3, 2, 1 pixels.
  std::vector<Pixel> expected;
  for (int y = 2; y <= 6; ++y) {
    for (int x = 2; x + y <= 8; ++x) expected.emplace_back(x, y);
  }
  ASSERT_EQ(expected.size(), 15u);
  EXPECT_EQ(pixels({Point{2, 2}, {6, 2}, {2, 6}}, 12), expected);
  EXPECT_TRUE(pixels({Point{2, 2}, {4, 4}, {8, 8}}, 12).empty());
}

TEST(LectureScan, EarlyExitLeavesThePixelsAlone) {
  Prng prng(3);
  std::size_t drawn = 0;
  for (int i = 0; i < 1500; ++i) {
    const Corners c = random_triangle(prng).corners();
    const int bits = static_cast<int>(prng.integer(1, 20));
    const std::vector<Pixel> some = pixels(c, bits);
    drawn += some.size();
    ASSERT_EQ(some, pixels(c, bits, view_size, false));
  }
  EXPECT_GT(drawn, 1000000u);
}

TEST(LectureScan, OrientationAndFirstVertexLeaveThePixelsAlone) {
  Prng prng(3);
  std::size_t drawn = 0, other_boxes = 0;
  for (int i = 0; i < 3000; ++i) {
    const Corners c = random_triangle(prng).corners();
    const int bits = static_cast<int>(prng.integer(1, 20));
    const auto t = integer_triangle::set_up(c, view_size, view_size, bits);
    for (const Corners& other : {Corners{c[0], c[2], c[1]}, Corners{c[1], c[2], c[0]}}) {
      const auto o = integer_triangle::set_up(other, view_size, view_size, bits);
      ASSERT_EQ(t.has_value(), o.has_value());
      if (!t) continue;
      ASSERT_EQ(t->area, o->area);
      // A difference that truncates to 0 counts as not negative either way round, so that the flags may take another of
      // two vertices that are that close, and the box another pixel on its rim: cut there, truncated edges that stick
      // out show different pixels. From 8 bits on no difference of these vertices truncates to 0.
      const bool same_box =
          t->x_min == o->x_min && t->x_max == o->x_max && t->y_min == o->y_min && t->y_max == o->y_max;
      if (bits >= 8) {
        ASSERT_TRUE(same_box);
      }
      other_boxes += same_box ? 0 : 1;
      const auto common = [&](std::vector<Pixel> all) {
        std::erase_if(all, [&](const Pixel& p) {
          return p.first < std::max(t->x_min, o->x_min) || p.first > std::min(t->x_max, o->x_max) ||
                 p.second < std::max(t->y_min, o->y_min) || p.second > std::min(t->y_max, o->y_max);
        });
        return all;
      };
      const std::vector<Pixel> some = common(pixels(c, bits));
      drawn += some.size();
      ASSERT_EQ(some, common(pixels(other, bits)));
    }
  }
  EXPECT_GT(drawn, 1000000u);
  EXPECT_GT(other_boxes, 0u);
}

TEST(LectureScan, TruncationAddsPixels) {
  // The upper edge falls by 1/32 over 32 pixels, half a unit of 4 fraction bits: A becomes 0 and the edge level.
  // Exactly only the vertex is inside in row 0. The right edge, -31.96875 x - 32 y + 1024, still lets x = 32 pass.
  const Corners c{Point{0, 0}, {32, 1.0 / 32}, {0, 32}};
  const std::vector<Pixel> coarse = pixels(c, 4), fine = pixels(c, 5);
  for (int x = 1; x <= 32; ++x) {
    EXPECT_TRUE(std::ranges::count(coarse, Pixel{x, 0}) == 1) << x;
    EXPECT_TRUE(std::ranges::count(fine, Pixel{x, 0}) == 0) << x;
  }
  EXPECT_EQ(std::ranges::count(fine, Pixel{0, 0}), 1);
}

TEST(LectureScan, TruncationLeavesPixelsOut) {
  // x/32 + 32 y - 1/2 >= 0: exactly row 0 is inside from x = 16, a tie, to 31. With 4 bits A is 0 and C = -1/2 stays.
  const Corners c{Point{0, 1.0 / 64}, {32, -1.0 / 64}, {0, 32}};
  const std::vector<Pixel> coarse = pixels(c, 4), fine = pixels(c, 6);
  for (int x = 0; x <= 32; ++x) {
    EXPECT_EQ(std::ranges::count(coarse, Pixel{x, 0}), 0) << x;
    EXPECT_EQ(std::ranges::count(fine, Pixel{x, 0}), x >= 16 && x <= 31 ? 1 : 0) << x;
  }
}

/// The largest edge function, in square pixels, of a pixel that truncation misjudges; over the edge's length it is the
/// distance from the edge's line. A, B and C are each off by less than a unit u = 2^-bits, so an edge function is off
/// by less than (1 + x + y) u. The area is off by less than 3 u: where that makes it 0 or turns its sign, the whole
/// triangle is no thicker than that. A and B are exact where the vertices have no more bits than they.
double misjudged_below(int x, int y, int bits, int fraction) {
  return std::ldexp(bits >= fraction ? 3 : 3 + x + y, -bits);
}

struct Misjudged {
  std::size_t added = 0, missing = 0;
};

/// The pixels of random triangles, vertices with `fraction` bits, against exact edge functions.
Misjudged misjudged(int triangles, int bits, int fraction) {
  Misjudged out;
  Prng prng(4);
  for (int i = 0; i < triangles; ++i) {
    const ExactTriangle t = random_triangle(prng, fraction);
    const std::vector<Pixel> drawn = pixels(t.corners(), bits);
    auto next = drawn.begin();
    for (int y = 0; y < view_size; ++y) {
      for (int x = 0; x < view_size; ++x) {
        const bool got = next != drawn.end() && *next == Pixel{x, y};
        if (got) ++next;
        const bool expected = t.inside(x, y);
        if (got == expected) continue;
        ++(got ? out.added : out.missing);
        bool explained = false;
        for (std::size_t k = 0; k < 3; ++k)
          explained |= std::abs(t.square_pixels(t.edge(k, x, y))) < misjudged_below(x, y, bits, fraction);
        EXPECT_TRUE(explained) << "pixel " << x << ", " << y << " with " << bits << " bits";
      }
    }
    EXPECT_TRUE(next == drawn.end());
  }
  return out;
}

TEST(LectureCoverage, DifferencesFromExactShrinkWithTheBits) {
  constexpr int triangles = 800, last = 20;
  for (const int fraction : {8, 16}) {
    std::array<std::size_t, last + 1> wrong{};
    for (int bits = 1; bits <= last; ++bits) {
      const Misjudged m = misjudged(triangles, bits, fraction);
      wrong[static_cast<std::size_t>(bits)] = m.added + m.missing;
      if (bits == 4) {
        EXPECT_GT(m.added, 0u);
        EXPECT_GT(m.missing, 0u);
      }
    }
    for (std::size_t bits = 1; bits <= 5; ++bits) EXPECT_GT(wrong[bits], 3 * wrong[bits + 3]) << bits;
    // A and B are exact from 8 bits on, and C from 16 on.
    if (fraction == 8) {
      for (std::size_t bits = 16; bits <= last; ++bits) EXPECT_EQ(wrong[bits], 0u) << bits;
    }
  }
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
