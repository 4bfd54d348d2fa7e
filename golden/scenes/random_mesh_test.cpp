// Random meshes tile their rectangle: areas add up exactly, and every pixel centre is covered once by the top-left
// rule.
#include "golden/scenes/random_mesh.hpp"

#include "golden/scenes/test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>

namespace quadrille::golden {
namespace {

using Point = std::array<std::int64_t, 2>;

std::int64_t cross(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Sign of E(a, b) at p moved by (+ε, +ε²); 0 for coincident points.
int tie_sign(const Point& a, const Point& b, const Point& p) {
  const std::int64_t e = cross(a, b, p);
  if (e != 0) return e > 0 ? 1 : -1;
  const std::int64_t de_dx = a[1] - b[1], de_dy = b[0] - a[0];
  const std::int64_t d = de_dx != 0 ? de_dx : de_dy;
  return d > 0 ? 1 : (d < 0 ? -1 : 0);
}

/// Winding number of a closed quad around p: crossings of its edges with the ray from p to the right, p moved as above.
int winding(const std::array<Point, 4>& q, const Point& p) {
  int turns = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point &a = q[i], &b = q[(i + 1) & 3];
    const bool a_above = a[1] > p[1], b_above = b[1] > p[1];  // p is lower by ε²: equal counts as below
    if (a_above == b_above) continue;
    if (tie_sign(a, b, p) == (b_above ? 1 : -1)) turns += b_above ? 1 : -1;
  }
  return turns;
}

std::vector<RandomMeshOptions> variants() {
  std::vector<RandomMeshOptions> all;
  RandomMeshOptions o;
  o.width = o.height = 128;
  all.push_back(o);
  o.tie_share = 1, o.columns = o.rows = 30;
  all.push_back(o);
  o.tie_share = 0.5, o.triangle_share = 1, o.vary_w = true;
  all.push_back(o);
  o.width = 97, o.height = 61, o.columns = 5, o.rows = 20, o.triangle_share = 0, o.jitter = 3;
  all.push_back(o);
  o.columns = o.rows = 1;
  all.push_back(o);
  o.width = o.height = 3, o.tie_share = 1;
  all.push_back(o);
  return all;
}

TEST(RandomMesh, AreasAddUpToTheRectangleExactly) {
  for (const RandomMeshOptions& o : variants()) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const RandomMesh mesh = make_random_mesh(seed, o);
      std::int64_t twice = 0;
      for (const auto& cell : mesh.cells) {
        std::array<Point, 4> p;
        for (std::size_t i = 0; i < 4; ++i) p[i] = mesh.vertices.at(static_cast<std::size_t>(cell[i]));
        twice += std::abs(cross(p[0], p[1], p[2]) + cross(p[0], p[2], p[3]));
      }
      ASSERT_EQ(twice, 2 * (mesh.x1 - mesh.x0) * (mesh.y1 - mesh.y0)) << "seed " << seed;
      ASSERT_LT(mesh.x0, mesh.x1);
      ASSERT_LT(mesh.y0, mesh.y1);
      ASSERT_GE(mesh.x0, 0);
      ASSERT_LE(mesh.x1, 256 * o.width);
      ASSERT_GE(mesh.y0, 0);
      ASSERT_LE(mesh.y1, 256 * o.height);
    }
  }
}

TEST(RandomMesh, EveryPixelIsCoveredExactlyOnce) {
  std::int64_t pixels = 0, ties = 0, on_vertices = 0;
  for (const RandomMeshOptions& o : variants()) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const RandomMesh mesh = make_random_mesh(seed, o);
      std::vector<int> count(static_cast<std::size_t>(o.width * o.height)), tie(count.size());
      for (const auto& cell : mesh.cells) {
        std::array<Point, 4> p;
        for (std::size_t i = 0; i < 4; ++i) p[i] = mesh.vertices[static_cast<std::size_t>(cell[i])];
        for (int y = 0; y < o.height; ++y) {
          for (int x = 0; x < o.width; ++x) {
            const Point c{256 * x + 128, 256 * y + 128};
            const std::size_t pixel = static_cast<std::size_t>(y * o.width + x);
            const auto outside = [&](std::size_t axis) {
              return std::all_of(p.begin(), p.end(), [&](const Point& v) { return v[axis] < c[axis]; }) ||
                     std::all_of(p.begin(), p.end(), [&](const Point& v) { return v[axis] > c[axis]; });
            };
            if (outside(1)) break;
            if (outside(0)) continue;
            count[pixel] += std::abs(winding(p, c));
            for (std::size_t i = 0; i < 4; ++i) tie[pixel] |= cross(p[i], p[(i + 1) & 3], c) == 0 ? 1 : 0;
          }
        }
      }
      for (int y = 0; y < o.height; ++y) {
        for (int x = 0; x < o.width; ++x) {
          const std::size_t pixel = static_cast<std::size_t>(y * o.width + x);
          ASSERT_EQ(count[pixel], mesh.expected(x, y) ? 1 : 0) << "seed " << seed << " pixel " << x << "," << y;
          pixels += count[pixel];
          ties += tie[pixel];
        }
      }
      for (const Point& v : mesh.vertices) on_vertices += v[0] % 256 == 128 && v[1] % 256 == 128 ? 1 : 0;
    }
  }
  EXPECT_GT(pixels, 200000);
  EXPECT_GT(ties, 20000);
  EXPECT_GT(on_vertices, 8000);
}

TEST(RandomMesh, HasConcaveCellsTrianglesAndBothWindings) {
  RandomMeshOptions o;
  const RandomMesh mesh = make_random_mesh(3, o);
  EXPECT_GT(mesh.concave, mesh.cells.size() / 20);
  EXPECT_GT(mesh.triangles, mesh.cells.size() / 10);
  EXPECT_LT(mesh.triangles, mesh.cells.size() / 2);
  EXPECT_GT(mesh.clockwise, mesh.cells.size() / 3);
  EXPECT_LT(mesh.clockwise, 2 * mesh.cells.size() / 3);
}

TEST(RandomMesh, VerticesAreSharedAndOnTheGrid) {
  RandomMeshOptions o;
  o.vary_w = true;
  o.tie_share = 0.5;
  const RandomMesh mesh = make_random_mesh(11, o);
  std::map<int, WindowVertex> seen;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    EXPECT_EQ(mesh.quads[c].id, c);
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex& v = mesh.quads[c].vertex[i];
      const auto [it, fresh] = seen.emplace(mesh.cells[c][i], v);
      EXPECT_TRUE(fresh || (it->second.x == v.x && it->second.y == v.y && it->second.z == v.z && it->second.w == v.w));
      EXPECT_EQ(v.x / v.w * 256, mesh.vertices[static_cast<std::size_t>(mesh.cells[c][i])][0]);
      EXPECT_EQ(v.y / v.w * 256, mesh.vertices[static_cast<std::size_t>(mesh.cells[c][i])][1]);
    }
  }
  EXPECT_EQ(seen.size(), mesh.vertices.size());
}

TEST(RandomMesh, SameSeedSameBits) {
  EXPECT_EQ(hash_quads(make_random_mesh(5).quads), hash_quads(make_random_mesh(5).quads));
  EXPECT_NE(hash_quads(make_random_mesh(5).quads), hash_quads(make_random_mesh(6).quads));
}

TEST(RandomMesh, RefusesWhatDoesNotFit) {
  RandomMeshOptions o;
  o.width = o.columns + 1;
  EXPECT_THROW(make_random_mesh(1, o), std::invalid_argument);
  o = {};
  o.tie_share = 1.5;
  EXPECT_THROW(make_random_mesh(1, o), std::invalid_argument);
  o = {};
  o.jitter = -1;
  EXPECT_THROW(make_random_mesh(1, o), std::invalid_argument);
}

}  // namespace
}  // namespace quadrille::golden
