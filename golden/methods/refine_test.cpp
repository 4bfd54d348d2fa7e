// Bilinear refinement: identities with the split, convergence to the bilinear surface, cracks, eye-crossing quads.
#include "golden/methods/builders.hpp"
#include "golden/methods/surface_test_support.hpp"

#include <algorithm>
#include <map>

namespace quadrille::golden::methods {
namespace {

using namespace test;

constexpr View view64{64, 64, true};

TEST(Refine, ByOneIsTheSplit) {
  Prng prng(1);
  std::size_t compared = 0;
  for (int n = 0; n < 100; ++n) {
    Quad quad = random_quad(prng, 64, n % 2 == 1);
    if (n % 10 == 0) {
      quad.vertex[3] = quad.vertex[2];
    }
    const View view{64, 64, n % 3 != 0};
    const auto refined = draw(*make_refine(1), quad, view), split = draw(*make_split(Diagonal::v0_v2), quad, view);
    ASSERT_EQ(refined.size(), split.size());
    for (std::size_t i = 0; i < split.size(); ++i) {
      ASSERT_EQ(refined[i].x, split[i].x);
      ASSERT_EQ(refined[i].y, split[i].y);
      ASSERT_EQ(refined[i].front, split[i].front);
      ASSERT_EQ(refined[i].z, split[i].z);
      ASSERT_EQ(refined[i].lambda, split[i].lambda);
    }
    compared += split.size();
  }
  EXPECT_GT(compared, 50'000u);
}

TEST(Refine, ReproducesCornersAndIsLinearOnEdges) {
  for (const int n : {1, 2, 7, 20}) expect_corners_and_linear_edges(*make_refine(n), view64);
}

/// Corner 2 is off the bilinear map's parallelogram and all w differ: neither the split nor a plane is right.
TEST(Refine, ErrorFallsWithTheSquareOfN) {
  const Quad quad = screen_quad({{{12.3, 9.1}, {240.2, 31.7}, {170.4, 180.9}, {20.8, 230.6}}}, {1, 1.7, 2.2, 1.4});
  const View view{256, 256, true};
  double previous = 0;
  for (const int n : {4, 8, 16, 32}) {
    const auto samples = draw(*make_refine(n), quad, view);
    ASSERT_GT(samples.size(), 20'000u);
    double error = 0;
    for (const MethodSample& sample : samples) error = std::fmax(error, bilinear_error(quad, sample));
    if (n > 4) {
      EXPECT_GT(previous / error, 3.3) << n;
      EXPECT_LT(previous / error, 4.7) << n;
    }
    previous = error;
  }
  EXPECT_LT(previous, 5e-4);
}

/// The sample's surface point sum(lambda_i V_i) is at its pixel and has its depth (H&T section 3.1), on both layers of
/// a fold.
TEST(Refine, WeightsReproducePixelAndDepth) {
  Prng prng(2);
  int compared = 0, folded = 0;
  for (int n = 0; n < 40; ++n) {
    const Quad quad = random_quad(prng, 64, n % 2 == 1);
    std::map<std::array<int, 2>, int> layers;
    for (const MethodSample& sample : draw(*make_refine(9), quad, view64)) {
      std::array<double, 4> p{};
      double size = 0, sum = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const WindowVertex& v = quad.vertex[i];
        for (const auto& [k, c] : {std::pair<std::size_t, double>{0, v.x}, {1, v.y}, {2, v.z}, {3, v.w}})
          p[k] += sample.lambda[i] * c;
        size += std::abs(sample.lambda[i]) * std::hypot(v.x, v.y);
        sum += sample.lambda[i];
        ASSERT_GE(sample.lambda[i], 0);
      }
      ASSERT_GT(p[3], 0);
      ASSERT_NEAR(sum, 1, 1e-14);
      ASSERT_NEAR(p[0], (sample.x + 0.5) * p[3], 1e-12 * size);
      ASSERT_NEAR(p[1], (sample.y + 0.5) * p[3], 1e-12 * size);
      ASSERT_NEAR(p[2], sample.z * p[3], 1e-12 * size);
      folded += ++layers[{sample.x, sample.y}] == 2 ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_GT(compared, 20'000);
  EXPECT_GT(folded, 100);  // random quads are not planar
}

/// A mesh over the whole view, a plane in space: every pixel exactly once. With all points on pixel centres many grid
/// points are on pixel centres too, but for their rounding.
TEST(Refine, NeighboursLeaveNoPixelOutAndDrawNoneTwice) {
  Prng prng(3);
  for (const int n : {1, 3, 5, 10, 20}) {
    for (int round = 0; round < 12; ++round) {
      const double spread = round % 2 == 0 ? 0 : 4;
      const bool affine = round % 4 == 0;
      std::array<std::array<Point, 4>, 4> points{};
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i)
          points[j][i] = {-13.5 + 30 * static_cast<double>(i) + prng.uniform(-spread, spread),
                          -13.5 + 30 * static_cast<double>(j) + prng.uniform(-spread, spread)};
      auto quads = quad_mesh(prng, 3, 3, [&](std::size_t i, std::size_t j) { return points[j][i]; });
      if (affine)
        for (Quad& quad : quads)
          for (WindowVertex& v : quad.vertex) v = {v.x / v.w, v.y / v.w, v.z / v.w, 1};
      const auto count = counts(*make_refine(n), quads, view64);
      ASSERT_TRUE(std::ranges::all_of(count, [](int c) { return c == 1; })) << n << ", " << round;
    }
  }
}

/// The outline of a refined cell: the points of an edge have the same bits from both of its quads.
TEST(Refine, SharedEdgesHaveTheSamePoints) {
  Prng prng(4);
  for (int round = 0; round < 50; ++round) {
    const Quad quad = random_quad(prng, 64, round % 2 == 1);
    const auto bottom_row = [](const Quad& q, int n) {
      std::vector<std::array<double, 4>> points;
      const auto cells = make_refine(n)->wireframe(q, view64);
      for (int i = 0; i < n; ++i) {
        const WindowVertex& v = cells[static_cast<std::size_t>(i)][0];
        points.push_back({v.x, v.y, v.z, v.w});
      }
      const WindowVertex& last = cells[static_cast<std::size_t>(n) - 1][1];
      points.push_back({last.x, last.y, last.z, last.w});
      return points;
    };
    // Edge 01 of the quad; as edge 10 of one with other corners elsewhere; as edge 12 and 30 by renumbering.
    Quad neighbour = random_quad(prng, 64, false);
    neighbour.vertex[0] = quad.vertex[1];
    neighbour.vertex[1] = quad.vertex[0];
    const int n = static_cast<int>(prng.integer(1, 30));
    const auto one = bottom_row(quad, n);
    auto other = bottom_row(neighbour, n);
    std::ranges::reverse(other);
    ASSERT_EQ(one, other);
    // The quad given from corner 3 has its old edge 01 as edge 12: the last cell of every row.
    const auto cells = make_refine(n)->wireframe(renumbered(quad, 3, false), view64);
    for (int j = 0; j < n; ++j) {
      const WindowVertex& v = cells[static_cast<std::size_t>(j * n + n - 1)][1];
      ASSERT_EQ((std::array<double, 4>{v.x, v.y, v.z, v.w}), one[static_cast<std::size_t>(j)]);
    }
  }
}

TEST(Refine, WithoutPerspectiveCellsAreLinearOnTheScreen) {
  const Quad quad = centred_quad(centred_corners);
  const View screen{64, 64, false};
  // One cell is the split: equation 4 with areas of equation 5, w out of the game.
  for (const MethodSample& sample : draw(*make_refine(1), quad, screen)) {
    Point p{};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 2; ++k) p[k] += sample.lambda[i] * centred_corners[i][k];
    ASSERT_NEAR(p[0], sample.x + 0.5, 1e-12);
    ASSERT_NEAR(p[1], sample.y + 0.5, 1e-12);
  }
  // With equal w the two interpolations are one.
  const Quad flat = screen_quad(centred_corners, {2, 2, 2, 2});
  const auto a = draw(*make_refine(6), flat, screen), b = draw(*make_refine(6), flat, view64);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) ASSERT_NEAR(a[i].lambda[k], b[i].lambda[k], 1e-14);
  // With many cells the weights go to those of the surface in space: a cell's w hardly varies.
  for (const MethodSample& sample : draw(*make_refine(60), quad, screen)) ASSERT_LT(bilinear_error(quad, sample), 2e-4);
}

TEST(Refine, CensusCountsCells) {
  const Quad quad = centred_quad(centred_corners);
  Quad collapsed = triangle_quad();
  collapsed.texture[3] = {0, 1};
  Census expected;
  expected.quads = 3;
  expected.emitted_quads = 3 * 25;
  // Five cells of the triangle have a collapsed edge; with two textures at its ends it is a quad's.
  expected.triangles = 50 + 45 + 50;
  EXPECT_EQ(make_refine(5)->census(std::vector{quad, triangle_quad(), collapsed}, view64), expected);
  EXPECT_EQ(make_refine(5)->wireframe(quad, view64).size(), 25u);
  EXPECT_EQ(make_refine(20)->name(), "refine:20");
}

}  // namespace
}  // namespace quadrille::golden::methods
