#include "golden/methods/builders.hpp"
#include "golden/methods/triangle.hpp"
#include "golden/methods/triangle_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

namespace quadrille::golden::methods {
namespace {

std::vector<Pixel> pixels(const Corners& corners, int bits, int size = view_size, bool early_exit = true) {
  std::vector<Pixel> out;
  if (const auto t = integer_triangle::set_up(corners, size, size, bits)) {
    integer_triangle::scan(*t, std::array<PlaneEquation, 0>{}, early_exit,
                           [&](int x, int y, const std::array<std::int64_t, 0>&) { out.emplace_back(x, y); });
  }
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

}  // namespace
}  // namespace quadrille::golden::methods
