// What the titles of the loads claim, from the quads as they are drawn.
#include "golden/scenes/scenes.hpp"

#include "golden/scenes/test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace quadrille::golden {
namespace {

constexpr int size = 512;

std::vector<WindowQuad> quads_of(const char* name) { return scene_quads(make_scene(name), size, size); }

std::array<Vec2, 4> outline(const WindowQuad& quad) {
  std::array<Vec2, 4> points{};
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    points[i] = {v.x / v.w, v.y / v.w};
  }
  return points;
}

double edge_length(const std::array<Vec2, 4>& p, std::size_t i) {
  const Vec2 &a = p[i], &b = p[(i + 1) & 3];
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

/// The faces' corners in space, in drawing order.
std::vector<std::array<Vec3, 4>> faces_of(const char* name) {
  const Mesh mesh = make_scene(name).mesh;
  std::vector<std::array<Vec3, 4>> faces;
  for (const Face& face : mesh.faces) {
    std::array<Vec3, 4>& corners = faces.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) corners[i] = mesh.positions[static_cast<std::size_t>(face[i].position)];
  }
  return faces;
}

/// Of the sampled points that something covers: the part where the quad drawn first is the nearest.
double nearest_first(const char* name) {
  const std::vector<WindowQuad> quads = quads_of(name);
  int covered = 0, first = 0;
  for (int y = 8; y < size; y += 24) {
    for (int x = 8; x < size; x += 24) {
      double first_depth = 0, least = 2;
      bool some = false;
      for (const WindowQuad& q : quads) {
        if (!probe_visible(q, x + 0.37, y + 0.41)) continue;
        double depth = 0;  // the corners' mean: the quads of a load do not cut one another
        for (const WindowVertex& v : q.vertex) depth += v.z / v.w / 4;
        if (!some) first_depth = depth;
        some = true;
        least = std::min(least, depth);
      }
      covered += some ? 1 : 0;
      first += some && first_depth == least ? 1 : 0;
    }
  }
  return static_cast<double>(first) / covered;
}

TEST(Workloads, AreNamedApartFromTheFigures) {
  std::set<std::string> names;
  for (const SceneInfo& info : list_scenes()) names.insert(info.name);
  for (const SceneInfo& info : list_workloads()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.title.empty()) << info.name;
    EXPECT_EQ(info.paper, "workload");
    EXPECT_EQ(hash_quads(quads_of(info.name.c_str())), hash_quads(quads_of(info.name.c_str()))) << info.name;
    EXPECT_EQ(quads_of(info.name.c_str()).size(), info.quads) << info.name;
    const Scene scene = make_scene(info.name);
    for (const WindowQuad& quad : scene_quads(scene, size, size, attributes_for_shade(scene.shade)))
      for (const std::vector<double>& attributes : quad.attribute)
        for (const double a : attributes) EXPECT_LT(std::fabs(a), 8) << info.name;  // the default attribute_int_bits
  }
}

TEST(Workloads, OneCityInThreeOrders) {
  auto front = faces_of("city_front"), back = faces_of("city_back"), random = faces_of("city_random");
  EXPECT_EQ(front.size(), 501u);
  std::ranges::reverse(back);
  EXPECT_EQ(front, back);
  EXPECT_NE(front, random);
  std::ranges::sort(front);
  std::ranges::sort(random);
  EXPECT_EQ(front, random);
}

TEST(Workloads, LayersInThreeOrders) {
  EXPECT_EQ(nearest_first("layers_small"), 1);
  EXPECT_LT(nearest_first("layers_small_back"), 0.1);
  EXPECT_GT(nearest_first("layers_small_random"), 0.1);
  EXPECT_LT(nearest_first("layers_small_random"), 0.5);
  EXPECT_EQ(nearest_first("layers_large"), 1);
  EXPECT_EQ(quads_of("layers_large").size(), 8u);
  for (const WindowQuad& quad : quads_of("layers_large"))
    EXPECT_EQ(outline(quad), (std::array<Vec2, 4>{{{0, 512}, {512, 512}, {512, 0}, {0, 0}}}));
  for (const WindowQuad& quad : quads_of("layers_small")) {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(edge_length(outline(quad), i), 32);
    EXPECT_NE(std::fmod(outline(quad)[0][0], 8), 0);
  }
}

TEST(Workloads, SpritesAreAlignedToPixelsOrTurned) {
  const auto aligned = quads_of("sprites"), turned = quads_of("sprites_turned");
  ASSERT_GT(aligned.size(), 300u);
  for (const WindowQuad& quad : aligned) {
    const auto p = outline(quad);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(quad.vertex[i].w, 1);
      EXPECT_EQ(p[i], (Vec2{std::floor(p[i][0]), std::floor(p[i][1])}));
      EXPECT_TRUE(p[i][0] == p[(i + 1) & 3][0] || p[i][1] == p[(i + 1) & 3][1]);
    }
  }
  const auto on_axis = std::ranges::count_if(turned, [](const WindowQuad& quad) {
    const auto p = outline(quad);
    return p[0][1] == p[1][1];
  });
  EXPECT_EQ(on_axis, 64);  // the map
  for (const WindowQuad& quad : turned) {
    const auto p = outline(quad);
    EXPECT_NEAR(edge_length(p, 0), edge_length(p, 2), 1e-9);
    const double dot = (p[1][0] - p[0][0]) * (p[2][0] - p[1][0]) + (p[1][1] - p[0][1]) * (p[2][1] - p[1][1]);
    EXPECT_NEAR(dot, 0, 1e-9);
  }
  EXPECT_FALSE(make_scene("sprites").perspective);
}

TEST(Workloads, SubpixelQuadsAreSmallerThanAPixel) {
  int without_centre = 0;
  const auto quads = quads_of("subpixel_mesh");
  EXPECT_EQ(quads.size(), 9216u);
  for (const WindowQuad& quad : quads) {
    const auto p = outline(quad);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(edge_length(p, i), 1);
    const auto [low_x, high_x] = std::minmax({p[0][0], p[1][0], p[2][0], p[3][0]});
    const auto [low_y, high_y] = std::minmax({p[0][1], p[1][1], p[2][1], p[3][1]});
    const bool no_column = std::ceil(low_x - 0.5) > std::floor(high_x - 0.5);
    const bool no_row = std::ceil(low_y - 0.5) > std::floor(high_y - 0.5);
    without_centre += no_column || no_row ? 1 : 0;
  }
  EXPECT_GT(without_centre, 4608);  // most of them
}

TEST(Workloads, ClosedMeshIsClosedAndTurnsOutward) {
  const Scene scene = make_scene("closed_mesh");
  EXPECT_EQ(scene.cull, Cull::back);
  std::map<std::pair<int, int>, int> edges;
  double volume = 0;  // six times that of the tetrahedra from the origin
  const auto& at = scene.mesh.positions;
  const auto triple = [&](int i, int j, int k) {
    const Vec3 &a = at[static_cast<std::size_t>(i)], &b = at[static_cast<std::size_t>(j)],
               &c = at[static_cast<std::size_t>(k)];
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  for (const Face& face : scene.mesh.faces) {
    for (std::size_t i = 0; i < 4; ++i) ++edges[{face[i].position, face[(i + 1) & 3].position}];
    volume += triple(face[0].position, face[1].position, face[2].position) +
              triple(face[0].position, face[2].position, face[3].position);
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_EQ(at.size() + scene.mesh.faces.size(), edges.size() / 2);  // Euler: a torus
  EXPECT_GT(volume, 0);
}

TEST(Workloads, TheRoomIsAllAroundTheEye) {
  const auto quads = quads_of("room");
  int crossing = 0, behind = 0;
  for (const WindowQuad& quad : quads) {
    const auto back = std::ranges::count_if(quad.vertex, [](const WindowVertex& v) { return v.w <= 0; });
    behind += back == 4 ? 1 : 0;
    crossing += back > 0 && back < 4 ? 1 : 0;
  }
  EXPECT_GT(crossing, 10);
  EXPECT_GT(behind, 20);
  for (int y = 0; y < size; y += 17) {
    for (int x = 0; x < size; x += 17)
      EXPECT_TRUE(
          std::ranges::any_of(quads, [&](const WindowQuad& quad) { return probe_visible(quad, x + 0.37, y + 0.41); }))
          << x << ' ' << y;
  }
}

}  // namespace
}  // namespace quadrille::golden
