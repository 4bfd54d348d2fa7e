#include "golden/reference/truth_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace quadrille::golden {
namespace {

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
      const Float113 xi = quad.vertex[i].x, yi = quad.vertex[i].y, xj = quad.vertex[j].x, yj = quad.vertex[j].y;
      const Float113 area = xi * yj - yi * xj, dot = xi * xj + yi * yj;
      const Float113 both = hypotq(xi, yi) * hypotq(xj, yj);
      return dot < 0 ? (both - dot) / area : area / (both + dot);
    };
    const Float113 t0 = half_tangent(0, 1), t1 = half_tangent(1, 2), t2 = half_tangent(2, 3), t3 = half_tangent(3, 0);
    const auto m = [&](int i, Float113 sum) {
      return sum * port_double(quad.vertex[i].k) / hypotq(quad.vertex[i].x, quad.vertex[i].y);
    };
    const auto size = [](Float113 a, Float113 b) { return fabsq(a) + fabsq(b); };
    const std::array<Float113, 4> mk{m(0, t3 + t0), m(1, t0 + t1), m(2, t1 + t2),
                                     m(3, half_tangent(2, 0) * (1 - t2 * t3))};
    const Float113 sum = mk[0] + mk[1] + mk[2] + mk[3];
    const Float113 spread = m(0, size(t3, t0)) + m(1, size(t0, t1)) + m(2, size(t1, t2)) + m(3, size(t2, t3));
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
        std::rotate(corner.begin(), corner.begin() + random.integer(0, 3), corner.end());
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

}  // namespace
}  // namespace quadrille::golden
