// Expression (12) against the signed sum of two triangles, exhaustively on small grids, with every tie and duplicate.
#include "golden/reference/exact_coverage.hpp"

#include "golden/reference/test_quads.hpp"
#include "golden/reference/truth.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace quadrille::golden {
namespace {

using test::make_quad;
using test::Point;

const Config config;
const DrawState draw;

/// What lies exactly on a pixel, from small integers.
struct Incidence {
  int corners = 0, edges = 0;
};

Incidence incidence(const std::array<Point, 4>& q, int px, int py) {
  Incidence out;
  for (int i = 0; i < 4; ++i) {
    const int ax = q[i].x - px, ay = q[i].y - py, bx = q[(i + 1) & 3].x - px, by = q[(i + 1) & 3].y - py;
    out.corners += ax == 0 && ay == 0;
    out.edges += ax * by == ay * bx && ax * bx + ay * by < 0;  // strictly between the ends
  }
  return out;
}

TEST(ExactCoverage, ByHand) {
  // Square, counter-clockwise as seen (y down): front. The top left rule keeps x = 0 and y = 0.
  const SnappedQuad square = make_quad({Point{0, 0}, {0, 2}, {2, 2}, {2, 0}});
  for (int y = -1; y <= 3; ++y) {
    for (int x = -1; x <= 3; ++x) {
      const auto c = exact_coverage(square, x, y);
      const bool inside = x >= 0 && x < 2 && y >= 0 && y < 2;
      EXPECT_EQ(c.covered, inside);
      EXPECT_EQ(c.front, inside);
      EXPECT_EQ(c.visible, inside);
    }
  }
  // The same square behind the eye (all signs turned) covers the same pixels and is not visible; mirrored it is back
  // facing.
  EXPECT_TRUE(exact_coverage(make_quad({Point{0, 0, -1}, {0, -2, -1}, {-2, -2, -1}, {-2, 0, -1}}), 1, 1).covered);
  EXPECT_FALSE(exact_coverage(make_quad({Point{0, 0, -1}, {0, -2, -1}, {-2, -2, -1}, {-2, 0, -1}}), 1, 1).visible);
  EXPECT_FALSE(exact_coverage(make_quad({Point{0, 0}, {2, 0}, {2, 2}, {0, 2}}), 1, 1).front);
  // A notch from the right, (4,0), (1,1): inside left of it, outside in its mouth.
  const SnappedQuad notch = make_quad({Point{0, 1}, {4, 4}, {2, 1}, {4, -2}});
  EXPECT_TRUE(exact_coverage(notch, 1, 1).covered);
  EXPECT_FALSE(exact_coverage(notch, 3, 1).covered);
}

TEST(ExactCoverage, AllQuadsOfAFiveByFiveGrid) {
  std::int64_t cases = 0, differences = 0, covered = 0, wrong_class = 0, invisible = 0, uncovered_multiple = 0;
  std::int64_t two_corners = 0, corner_and_edge = 0, two_edges = 0;
  std::array<Point, 4> q;
  for (int code = 0; code < 25 * 25 * 25 * 25; ++code) {
    for (int i = 0, rest = code; i < 4; ++i, rest /= 25) q[i] = {rest % 5, rest / 5 % 5};
    const SnappedQuad quad = make_quad(q);
    const TruthQuad truth(quad, config, draw);
    for (int p = 0; p < 25; ++p) {
      const int px = p % 5, py = p / 5;
      const Coverage c = truth.cover(px, py);
      const ExactCoverage e = exact_coverage(quad, px, py);
      ++cases;
      differences += c.covered != e.covered || c.front != e.front || c.visible != e.visible;
      if (!c.covered) continue;
      ++covered;
      invisible += !c.visible;
      const Incidence on = incidence(q, px, py);
      two_corners += on.corners == 2;
      corner_and_edge += on.corners == 1 && on.edges > 0;
      two_edges += on.corners == 0 && on.edges == 2;
      uncovered_multiple += on.corners > 2 || on.edges > 2;
      const int expected = on.corners == 2   ? flag_two_corner
                           : on.corners == 1 ? flag_on_vertex
                           : on.edges == 2   ? flag_two_edge
                           : on.edges == 1   ? flag_on_edge
                                             : 0;
      const ReferenceSample s = truth.sample(px, py);
      double sum = 0;
      for (double l : s.lambda) sum += l;
      const int seen = s.flags & (flag_two_corner | flag_on_vertex | flag_two_edge | flag_on_edge);
      // A bare sum check on top: NaN or a lost weight shows here whatever its class.
      wrong_class += seen != expected || !(std::abs(sum - 1) < 0x1p-51);
    }
  }
  EXPECT_EQ(cases, 9'765'625);
  EXPECT_EQ(differences, 0);
  EXPECT_EQ(wrong_class, 0);
  EXPECT_EQ(invisible, 0);
  EXPECT_EQ(uncovered_multiple, 0) << "three things at a covered pixel";
  EXPECT_EQ(covered, 943'600);
  EXPECT_EQ(two_corners, 8'592);
  EXPECT_EQ(corner_and_edge, 12'352);
  EXPECT_EQ(two_edges, 4'624);
}

TEST(ExactCoverage, AllHomogeneousQuadsOfAThreeByThreeGrid) {
  // x, y, w in {-1, 0, 1} without (0, 0, 0); pixels of the same grid. Quads with an all-zero edge are looked at apart.
  std::vector<Point> points;
  for (int n = 0; n < 27; ++n) {
    if (n != 13) points.push_back({n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1});
  }
  const auto parallel = [](const Point& a, const Point& b) {
    return a.x * b.y == a.y * b.x && a.y * b.w == a.w * b.y && a.w * b.x == a.x * b.w;
  };
  std::int64_t cases = 0, coverage = 0, visibility = 0, covered = 0, hull = 0, margin = 0;
  std::int64_t with_zero_edge = 0, coincident_differences = 0, antipodal_differences = 0, antipodal_covered = 0;
  const int size = static_cast<int>(points.size());
  std::array<Point, 4> q;
  for (int code = 0; code < size * size * size * size; ++code) {
    for (int i = 0, rest = code; i < 4; ++i, rest /= size) q[i] = points[rest % size];
    bool zero = parallel(q[0], q[2]), antipodal = false;
    for (int i = 0; i < 4; ++i) {
      const auto &a = q[i], &b = q[(i + 1) & 3];
      if (!parallel(a, b)) continue;
      zero = true;
      antipodal = antipodal || a.x * b.x + a.y * b.y + a.w * b.w < 0;
    }
    const SnappedQuad quad = make_quad(q);
    const TruthQuad truth(quad, config, draw);
    for (int p = 0; p < 9; ++p) {
      const int px = p % 3 - 1, py = p / 3 - 1;
      const Coverage c = truth.cover(px, py);
      const ExactCoverage e = exact_coverage(quad, px, py);
      const bool differs = c.covered != e.covered || c.front != e.front;
      if (zero) {
        ++with_zero_edge;
        (antipodal ? antipodal_differences : coincident_differences) += differs;
        antipodal_covered += antipodal && c.covered;
        continue;
      }
      ++cases;
      coverage += differs;
      visibility += !c.eye_in_hull && c.visible != e.visible;
      covered += c.covered;
      hull += c.covered && c.eye_in_hull;
      if (c.covered && !c.eye_in_hull) {
        // What the determinants say is the sign of sum(M w).
        const ReferenceSample s = truth.sample(px, py);
        margin += s.visible != (s.visible_margin > 0);
      }
    }
  }
  EXPECT_EQ(cases + with_zero_edge, 9LL * 26 * 26 * 26 * 26);
  EXPECT_EQ(coverage, 0);
  EXPECT_EQ(visibility, 0);
  EXPECT_EQ(margin, 0);
  EXPECT_GT(covered, 100'000);
  EXPECT_GT(hull, 1'000);
  EXPECT_EQ(coincident_differences, 0) << "coincident neighbours and a null diagonal make no difference";
  EXPECT_GT(antipodal_differences, 0) << "the documented difference exists";
  EXPECT_EQ(antipodal_covered, 0) << "(12) covers nothing with an antipodal edge";
}

TEST(ExactCoverage, RandomHomogeneousQuads) {
  test::Random random(20);
  int covered = 0, visible = 0;
  for (int n = 0; n < 300'000; ++n) {
    const SnappedQuad quad = test::random_any_w(random, 8);
    const TruthQuad truth(quad, config, draw);
    const int px = random.integer(-4, 4), py = random.integer(-4, 4);
    const Coverage c = truth.cover(px, py);
    const ExactCoverage e = exact_coverage(quad, px, py);
    ASSERT_EQ(c.covered, e.covered);
    ASSERT_EQ(c.front, e.front);
    if (!c.eye_in_hull) {
      ASSERT_EQ(c.visible, e.visible);
    }
    covered += c.covered;
    visible += c.visible;
  }
  EXPECT_GT(covered, 30'000);
  EXPECT_GT(visible, 3'000);
}

}  // namespace
}  // namespace quadrille::golden
