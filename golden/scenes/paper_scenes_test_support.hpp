// What the tests of paper scenes share.
#pragma once

#include "golden/scenes/scenes.hpp"
#include "golden/scenes/test_support.hpp"

#include <cmath>

namespace quadrille::golden {
namespace {

constexpr int size = 512;

/// The projection of a scene, every attribute but the given one left out.
inline Projection projected(const std::string& name, AttributeSet set = AttributeSet::none) {
  const Scene scene = make_scene(name);
  return project_mesh(scene.mesh, scene.camera, size, size, {set, false});
}

inline std::array<Vec2, 4> outline(const WindowQuad& quad) {
  std::array<Vec2, 4> points{};
  for (std::size_t i = 0; i < 4; ++i)
    points[i] = {quad.vertex[i].x / quad.vertex[i].w, quad.vertex[i].y / quad.vertex[i].w};
  return points;
}

/// Shoelace formula.
inline double area(const std::array<Vec2, 4>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < 4; ++i) twice += p[i][0] * p[(i + 1) % 4][1] - p[i][1] * p[(i + 1) % 4][0];
  return std::fabs(twice) / 2;
}

inline double det3(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Six times the volume of the corners' tetrahedron.
inline double volume(const std::array<Vec3, 4>& corners) {
  std::array<Vec3, 3> edge{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 3; ++a) edge[i][a] = corners[i + 1][a] - corners[0][a];
  return det3(edge[0], edge[1], edge[2]);
}

}  // namespace
}  // namespace quadrille::golden
