#include "golden/methods/twofold_test_support.hpp"
#include "golden/reference/exact_coverage.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille::golden::methods {
namespace {

/// Vertices in units of 1/256 pixel: whether the ray from a pixel's centre to the left, moved by (+eps, +eps^2), meets
/// the outline an odd number of times; sides of edges as exact products.
bool inside_by_parity(const std::array<std::array<std::int64_t, 2>, 4>& p, int px, int py) {
  const std::int64_t x = 256 * px + 128, y = 256 * py + 128;
  bool odd = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = p[i], &b = p[(i + 1) & 3];
    if ((a[1] <= y) == (b[1] <= y)) continue;
    // x - (a.x + (y - a.y) (b.x - a.x) / (b.y - a.y)), times b.y - a.y.
    const __int128 side =
        static_cast<__int128>(x - a[0]) * (b[1] - a[1]) - static_cast<__int128>(y - a[1]) * (b[0] - a[0]);
    odd ^= b[1] > a[1] ? side >= 0 : side <= 0;
  }
  return odd;
}

TEST(Twofold, CoverageAndSideAreExactOnSnappedQuads) {
  constexpr int size = 24;
  Prng prng(1);
  std::size_t drawn = 0, ties = 0;
  for (int n = 0; n < 4000; ++n) {
    // A grid of half pixels gives ties in plenty, one of 1/256 hardly any.
    const std::int64_t grid = n % 2 == 0 ? 128 : 1;
    std::array<std::array<std::int64_t, 2>, 4> p{};
    Points points;
    SnappedQuad snapped;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        p[i][k] = prng.integer(-4 * 256 / grid, (size + 4) * 256 / grid) * grid;
        points[i][k] = static_cast<double>(p[i][k]) / 256;
      }
      // The oracle samples at integers: half a pixel back.
      snapped.vertex[i].x = static_cast<std::int32_t>(p[i][0] - 128);
      snapped.vertex[i].y = static_cast<std::int32_t>(p[i][1] - 128);
      snapped.vertex[i].w = 256;
    }
    const auto samples = draw_map(make_quad(points), {size, size, true});
    drawn += samples.size();
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const auto s = samples.find({x, y});
        ASSERT_EQ(s != samples.end(), inside_by_parity(p, x, y)) << x << ", " << y;
        const ExactCoverage exact = exact_coverage(snapped, x, y);
        ASSERT_EQ(s != samples.end(), exact.covered) << x << ", " << y;
        if (exact.covered) {
          ASSERT_EQ(s->second.front, exact.front) << x << ", " << y;
        }
        for (std::size_t i = 0; i < 4; ++i) {
          const auto &a = p[i], &b = p[(i + 1) & 3];
          ties += (x * 256 + 128 - a[0]) * (b[1] - a[1]) == (y * 256 + 128 - a[1]) * (b[0] - a[0]) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(drawn, 300000u);
  EXPECT_GT(ties, 5000u);
}

TEST(Twofold, NeighboursDrawEveryPixelOnce) {
  // A mesh of 4 x 4 quads over a rectangle, inner vertices anywhere near their places, on half pixels or not, with
  // perspective and the edges walked either way.
  constexpr int cells = 4, cell = 12, size = cells * cell;
  Prng prng(2);
  for (int n = 0; n < 400; ++n) {
    std::array<std::array<WindowVertex, cells + 1>, cells + 1> grid;
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        double x = i * cell, y = j * cell;
        if (i > 0 && i < cells) x += prng.uniform(-5, 5);
        if (j > 0 && j < cells) y += prng.uniform(-5, 5);
        if (n % 2 == 0) x = std::round(2 * x) / 2, y = std::round(2 * y) / 2;
        const double w = n % 3 == 0 ? 1 : prng.log2_spread(-3, 3);
        grid[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = {x * w, y * w, 0, w};
      }
    }
    std::map<Pixel, int> count;
    for (std::size_t j = 0; j < cells; ++j) {
      for (std::size_t i = 0; i < cells; ++i) {
        Quad quad;
        quad.vertex = {grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]};
        if ((i + j) % 2 == 0) std::swap(quad.vertex[1], quad.vertex[3]);
        for (const auto& [pixel, s] : draw_map(quad, {size, size, true})) ++count[pixel];
      }
    }
    ASSERT_EQ(count.size(), static_cast<std::size_t>(size * size));
    for (const auto& [pixel, times] : count) ASSERT_EQ(times, 1) << pixel.first << ", " << pixel.second;
  }
}

TEST(Twofold, NeighboursAgreeWhereTheirEdgeRoundsAtACentre) {
  // A square cut in two by a line from (x0, 0) to (x1, size) that meets a pixel centre up to the rounding of x1. The
  // two quads walk it in opposite directions.
  constexpr int size = 24;
  Prng prng(4);
  for (int n = 0; n < 2000; ++n) {
    const double x = static_cast<double>(prng.integer(8, 15)) + 0.5,
                 t = (static_cast<double>(prng.integer(8, 15)) + 0.5) / size;
    const double x0 = x + prng.uniform(-4, 4), x1 = (x - x0 * (1 - t)) / t;
    std::map<Pixel, int> count;
    for (const Points& p : {Points{Vec2{0, 0}, {x0, 0}, {x1, size}, {0, size}},
                            Points{Vec2{x0, 0}, {size, 0}, {size, size}, {x1, size}}}) {
      for (const auto& [pixel, s] : draw_map(make_quad(p), {size, size, true})) ++count[pixel];
    }
    ASSERT_EQ(count.size(), static_cast<std::size_t>(size * size));
    for (const auto& [pixel, times] : count) ASSERT_EQ(times, 1) << pixel.first << ", " << pixel.second;
  }
}

}  // namespace
}  // namespace quadrille::golden::methods
