// Quads with vertices behind the eye: Hormann & Tarini figures 8 and 9, and the eye inside the hull of the vertices.
#include "golden/scenes/scene_builders.hpp"

namespace quadrille::golden {
namespace {

/// Where a vertex lands in NDC (x right, y up, on a square viewport) and its w; w < 0 is behind the eye.
struct ScreenPoint {
  double x, y, w;
};

/// Eye at the origin looking along −z with a field of view of 90 degrees: the point (x w, y w, −w) lands at (x, y).
Camera eye_at_origin() {
  Camera camera;
  camera.target = {0, 0, -1};
  camera.fovy = 90;
  camera.near = 0.02;
  camera.far = 100;
  return camera;
}

Scene exterior(const std::array<ScreenPoint, 4>& points) {
  Scene scene;
  std::array<Vec3, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {points[i].x * points[i].w, points[i].y * points[i].w, -points[i].w};
  add_quad(scene.mesh, corners);
  scene.camera = eye_at_origin();
  return scene;
}

// The shapes of the four projected points. Concave: corner 2 is the reflex one. Crossed: edges 0-1 and 2-3 intersect.
constexpr std::array<Vec2, 4> convex{{{-0.55, -0.45}, {0.5, -0.5}, {0.45, 0.4}, {-0.4, 0.5}}};
constexpr std::array<Vec2, 4> concave{{{-0.6, -0.55}, {0.6, -0.35}, {-0.1, -0.1}, {-0.4, 0.65}}};
constexpr std::array<Vec2, 4> crossed{{{-0.6, -0.5}, {0.55, 0.45}, {0.5, -0.45}, {-0.5, 0.55}}};

/// The shape, moved by `shift` so that its visible part fills more of the screen.
Scene with_w(const std::array<Vec2, 4>& shape, const std::array<double, 4>& w, const Vec2& shift = {0, 0}) {
  std::array<ScreenPoint, 4> points{};
  for (std::size_t i = 0; i < 4; ++i) points[i] = {shape[i][0] + shift[0], shape[i][1] + shift[1], w[i]};
  return exterior(points);
}

Scene fig8() {
  Scene scene;
  add_quad(scene.mesh, {{{-1.6, -0.7, -2.2}, {0.25, -0.8, 0.8}, {1.7, -0.7, -2.0}, {0.1, -0.6, -6.0}}});
  scene.camera = eye_at_origin();
  return scene;
}

Scene fig9_a() { return with_w(convex, {1.0, -0.8, 1.2, 1.5}); }
Scene fig9_b() { return with_w(concave, {1.2, -0.9, 0.8, 1.0}); }
Scene fig9_c() { return with_w(concave, {-0.8, 1.0, 1.2, 1.0}); }
Scene fig9_d() { return with_w(crossed, {1.0, -0.8, 1.2, 0.9}); }
Scene fig9_e() { return with_w(convex, {-1.0, -0.8, 1.2, 1.5}); }
Scene fig9_f() { return with_w(concave, {-1.0, -1.2, 0.9, 1.1}); }
Scene fig9_g() { return with_w(crossed, {1.0, -0.8, -1.1, 1.3}); }
Scene fig9_h() { return with_w(convex, {1.0, -0.8, 1.3, -0.9}); }
Scene fig9_i() { return with_w(concave, {1.0, -0.9, 1.2, -1.0}); }
Scene fig9_j() { return with_w(crossed, {1.0, -0.8, 1.2, -1.1}, {0.35, 0.1}); }
Scene fig9_k() { return with_w(convex, {-1.0, 0.8, -1.2, -1.5}, {-0.8, 0.8}); }
Scene fig9_l() { return with_w(concave, {1.0, -1.2, -0.8, -0.9}, {0.9, 0.9}); }
Scene fig9_m() { return with_w(crossed, {-1.0, 0.8, -1.2, -0.9}, {-0.9, -1.0}); }

/// A tetrahedron of corners around the eye, turned so that no face is seen head on.
Scene eye_in_hull() {
  Scene scene;
  add_quad(scene.mesh, {{{-0.9, -1.1, -1.4}, {1.3, -0.2, 0.9}, {0.7, 1.2, -1.6}, {-1.1, 0.3, 1.3}}});
  scene.camera = eye_at_origin();
  return scene;
}

constexpr std::string_view fig9 = "Hormann & Tarini 2004, fig. 9";

constexpr std::array<SceneEntry, 15> entries{{
    {"fig8_behind", "A floor quad with one vertex behind the eye", "Hormann & Tarini 2004, fig. 8", fig8},
    {"fig9_a", "Exterior quad: convex shape, one vertex behind the eye", fig9, fig9_a},
    {"fig9_b", "Exterior quad: concave shape, a neighbour of the reflex corner behind", fig9, fig9_b},
    {"fig9_c", "Exterior quad: concave shape, the corner opposite the reflex one behind", fig9, fig9_c},
    {"fig9_d", "Exterior quad: crossed shape, one vertex behind", fig9, fig9_d},
    {"fig9_e", "Exterior quad: convex shape, two adjacent vertices behind", fig9, fig9_e},
    {"fig9_f", "Exterior quad: concave shape, two adjacent vertices behind", fig9, fig9_f},
    {"fig9_g", "Exterior quad: crossed shape, two adjacent vertices behind", fig9, fig9_g},
    {"fig9_h", "Exterior quad: convex shape, two opposite vertices behind (the eye is in the hull)", fig9, fig9_h},
    {"fig9_i", "Exterior quad: concave shape, two opposite vertices behind", fig9, fig9_i},
    {"fig9_j", "Exterior quad: crossed shape, two opposite vertices behind", fig9, fig9_j},
    {"fig9_k", "Exterior quad: convex shape, three vertices behind", fig9, fig9_k},
    {"fig9_l", "Exterior quad: concave shape, three vertices behind", fig9, fig9_l},
    {"fig9_m", "Exterior quad: crossed shape, three vertices behind", fig9, fig9_m},
    {"eye_in_hull", "The eye inside the tetrahedron of the four vertices", "Hormann & Tarini 2004, section 3.2",
     eye_in_hull},
}};

}  // namespace

std::span<const SceneEntry> exterior_scenes() { return entries; }

}  // namespace quadrille::golden
