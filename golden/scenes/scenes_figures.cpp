// Single quads in front of the eye: Hormann & Tarini figures 1, 6, 7 and 10, and Bloomenthal's turning bow-tie.
#include "golden/scenes/scene_builders.hpp"

namespace quadrille::golden {
namespace {

Scene flat() {
  Scene scene;
  add_quad(scene.mesh, {{{-0.95, -0.8, 0}, {0.95, -0.7, 0}, {0.35, 0.75, 0}, {-0.5, 0.6, 0}}});
  scene.camera = look_from({0, 0, 3}, {0, 0, 0}, 40);
  return scene;
}

/// The camera rolled by 37 degrees: what depends on scan lines does not turn with the quad.
Scene flat_turned() {
  Scene scene = flat();
  scene.camera.up = {3, 4, 0};
  scene.camera.fovy = 50;
  return scene;
}

Scene floor_quad() {
  Scene scene;
  add_quad(scene.mesh, {{{-2, 0, 2}, {2, 0, 2}, {2, 0, -8}, {-2, 0, -8}}});
  scene.camera = look_from({0.6, 1.1, 4}, {0, 0, -0.5}, 45);
  return scene;
}

/// The same quad in all three: opposite corners raised and lowered, so that its corners span a tetrahedron.
constexpr std::array<Vec3, 4> saddle{{{-1, -1, 0.55}, {1, -1, -0.55}, {1, 1, 0.55}, {-1, 1, -0.55}}};

Scene saddle_from(const Vec3& eye) {
  Scene scene;
  add_quad(scene.mesh, saddle);
  scene.camera = look_from(eye, {0, 0, 0}, 40);
  return scene;
}

Scene convex() { return saddle_from({0.8, 1.0, 4.2}); }
Scene concave() { return saddle_from({2.4, 2.9, 2.0}); }
Scene crossed() { return saddle_from({4.2, 0.7, 0.9}); }

/// Cut by planes z = k / 10, in which the surface has curved lines.
Scene cuts() {
  Scene scene = saddle_from({0.8, 1.0, 4.2});
  scene.camera.fovy = 34;
  scene.shade = "planes";
  scene.planes = CuttingPlanes{{0, 0, 1}, 0.1};
  return scene;
}

/// The saddle turned about a vertical axis in six steps of about 30 degrees (Pythagorean rotations, so no sine is
/// needed).
Scene bowtie() {
  static constexpr std::array<std::array<double, 2>, 6> turn{
      {{1, 0}, {15.0 / 17, 8.0 / 17}, {8.0 / 17, 15.0 / 17}, {0, 1}, {-8.0 / 17, 15.0 / 17}, {-15.0 / 17, 8.0 / 17}}};
  Scene scene;
  for (std::size_t i = 0; i < turn.size(); ++i) {
    const double c = turn[i][0], s = turn[i][1];
    const double column = static_cast<double>(i % 3) - 1, row = i < 3 ? 0.5 : -0.5;
    std::array<Vec3, 4> corners{};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3& p = saddle[k];
      corners[k] = {2.3 * column + c * p[0] + s * p[2], 3.2 * row + p[1] * 0.9 + 0.25 * p[0], c * p[2] - s * p[0]};
    }
    add_quad(scene.mesh, corners);
  }
  scene.camera = look_from({0, 0.5, 8.6}, {0, 0, 0}, 45);
  return scene;
}

constexpr std::array<SceneEntry, 8> entries{{
    {"fig1_flat", "One flat quad with a regular pattern, seen from above", "Hormann & Tarini 2004, fig. 1", flat},
    {"fig6_cuts", "A flat-shaded non-planar quad and its intersection with parallel planes",
     "Hormann & Tarini 2004, fig. 6", cuts},
    {"fig1_turned", "The same with the camera rolled by 37 degrees", "Hormann & Tarini 2004, fig. 1", flat_turned},
    {"fig7_floor", "A floor in perspective", "Hormann & Tarini 2004, fig. 7", floor_quad},
    {"fig10_convex", "A non-planar quad that projects to a convex shape", "Hormann & Tarini 2004, fig. 10", convex},
    {"fig10_concave", "The same quad, projecting to a concave shape", "Hormann & Tarini 2004, fig. 10", concave},
    {"fig10_crossed", "The same quad, projecting to a self-intersecting shape", "Hormann & Tarini 2004, fig. 10",
     crossed},
    {"bowtie", "A non-planar quad turning through bow-tie shapes, six steps", "Bloomenthal 2022, fig. 15", bowtie},
}};

}  // namespace

std::span<const SceneEntry> figure_scenes() { return entries; }

}  // namespace quadrille::golden
