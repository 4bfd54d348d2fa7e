// Polygons cut into pieces, judged at points by the even-odd rule, which knows nothing of pieces.
#include "golden/scenes/polygon.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace quadrille::golden {
namespace {

bool inside(const std::vector<Vec2>& polygon, const Vec2& p) {
  bool odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) odd = !odd;
  }
  return odd;
}

/// A plane shape in space, the same everywhere: tilted, and mirrored or not.
std::vector<Vec3> tilted(const std::vector<Vec2>& flat, bool mirrored) {
  std::vector<Vec3> corners;
  for (const Vec2& p : flat) {
    const double x = mirrored ? -p[0] : p[0];
    corners.push_back({x - p[1], 0.5 * x + p[1], 2 * p[1] - x});
  }
  return corners;
}

/// Every point in the polygon is in one piece, every other one in none.
void expect_covered_once(const std::vector<Vec2>& polygon, const std::vector<Piece>& pieces, std::uint64_t seed) {
  Prng random(seed);
  for (int n = 0; n < 400; ++n) {
    const Vec2 p{10 * random.uniform() - 5, 10 * random.uniform() - 5};
    int covers = 0;
    for (const Piece& piece : pieces) {
      std::vector<Vec2> shape;
      for (const std::size_t i : piece) shape.push_back(polygon[i]);
      covers += inside(shape, p);
    }
    ASSERT_EQ(covers, inside(polygon, p) ? 1 : 0) << p[0] << ", " << p[1];
  }
}

/// From every first corner, in both directions, in a plane that no axis is perpendicular to.
void expect_cut(std::vector<Vec2> polygon, std::uint64_t seed) {
  for (std::size_t first = 0; first < polygon.size(); ++first) {
    for (const bool reversed : {false, true}) {
      SCOPED_TRACE("first corner " + std::to_string(first) + (reversed ? ", reversed" : ""));
      std::vector<Vec2> shape = polygon;
      if (reversed) std::ranges::reverse(shape);
      expect_covered_once(shape, cut_polygon(tilted(shape, false)), seed);
      expect_covered_once(shape, cut_polygon(tilted(shape, true)), seed);
    }
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
  }
}

const std::vector<Vec2> l_shape{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};

TEST(Polygon, AConvexOneIsAFanFromItsFirstCorner) {
  for (const int corners : {5, 6, 7}) {
    std::vector<Vec2> flat;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners;
      flat.push_back({4 * std::cos(angle), 4 * std::sin(angle)});
    }
    std::vector<Piece> fan{{0, 1, 2, 3}, {0, 3, 4, 4}};
    if (corners > 5) fan[1][3] = 5;
    if (corners > 6) fan.push_back({0, 5, 6, 6});
    EXPECT_EQ(cut_polygon(tilted(flat, false)), fan);
    EXPECT_EQ(cut_polygon(tilted(flat, true)), fan);
  }
  // Corners on a straight line, the first among them.
  const std::vector<Vec2> square{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}};
  EXPECT_EQ(cut_polygon(tilted(square, false)), (std::vector<Piece>{{0, 1, 2, 3}, {0, 3, 4, 5}}));
}

TEST(Polygon, AFanStartsWhereAllIsSeen) {
  // From the reflex corner of an L, and its opposite, all is seen; from the end of an arm it is not.
  std::vector<Vec2> shape = l_shape;
  EXPECT_EQ(cut_polygon(tilted(shape, false)), (std::vector<Piece>{{0, 1, 2, 3}, {0, 3, 4, 5}}));
  std::rotate(shape.begin(), shape.begin() + 1, shape.end());
  EXPECT_EQ(cut_polygon(tilted(shape, false)), (std::vector<Piece>{{2, 3, 4, 5}, {2, 5, 0, 1}}));
  expect_cut(l_shape, 1);
}

TEST(Polygon, WhatNoCornerSeesIsCutByEars) {
  const std::vector<Vec2> comb{{-4, -4}, {4, -4}, {4, 3},  {3, 3},   {3, -3}, {1, -3},
                               {1, 3},   {0, 3},  {0, -3}, {-3, -3}, {-3, 3}, {-4, 3}};
  EXPECT_EQ(cut_polygon(tilted(comb, false)).size(), comb.size() - 2);
  expect_cut(comb, 2);
  const std::vector<Vec2> spiral{{-4, -4}, {4, -4}, {4, 4}, {-3, 4}, {-3, -2}, {2, -2}, {2, 2}, {-1, 2}, {-1, 0},
                                 {0, 0},   {0, 1},  {1, 1}, {1, -1}, {-2, -1}, {-2, 3}, {3, 3}, {3, -3}, {-4, -3}};
  expect_cut(spiral, 3);
}

TEST(Polygon, AHoleJoinedByABridge) {
  const std::vector<Vec2> ring{{-4, -4}, {4, -4}, {4, 4}, {-4, 4}, {-4, -4},
                               {-1, -1}, {-1, 1}, {1, 1}, {1, -1}, {-1, -1}};
  expect_cut(ring, 4);
}

TEST(Polygon, RandomOnes) {
  Prng random(5);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const int corners = 5 + static_cast<int>(random.below(9));
    std::vector<Vec2> polygon;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.9 * random.uniform()) / corners;
      const double radius = 0.3 + 4.5 * random.uniform() * random.uniform();
      polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    expect_cut(polygon, seed);
  }
}

std::string refusal(const std::vector<Vec3>& corners) {
  try {
    cut_polygon(corners);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "cut";
}

TEST(Polygon, WhatCannotBeCutIsRefused) {
  std::vector<Vec2> star;
  for (int i = 0; i < 5; ++i)
    star.push_back({std::cos(0.8 * std::numbers::pi * i), std::sin(0.8 * std::numbers::pi * i)});
  EXPECT_EQ(refusal(tilted(star, false)), "the edges between corners 1-2 and 3-4 cross");
  EXPECT_EQ(refusal(tilted({{0, 0}, {4, 0}, {4, 4}, {2, -1}, {0, 4}}, false)),
            "the edges between corners 1-2 and 3-4 cross");
  EXPECT_NE(refusal(tilted({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}}, false)).find("encloses no area"),
            std::string::npos);
}

}  // namespace
}  // namespace quadrille::golden
