// Single quads of Oliveira's adaptive subdivision, figures 12 to 16. Sizes are of order 1: his thresholds are absolute.
#include "golden/scenes/scene_builders.hpp"

#include <cmath>

namespace quadrille::golden {
namespace {

/// Parallel to the image plane, so that perspective bends nothing.
Scene face_on(const std::array<Vec2, 4>& shape, const std::array<Vec2, 4>& textures, double distance, double fovy) {
  Scene scene;
  std::array<Vec3, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {shape[i][0], shape[i][1], 0};
  add_quad(scene.mesh, corners, textures);
  scene.camera = look_from({0, 0, distance}, {0, 0, 0}, fovy);
  return scene;
}

/// Neither is a parallelogram, and no affine map takes one to the other.
constexpr std::array<Vec2, 4> polygon{{{-0.95, -0.8}, {0.85, -0.95}, {0.6, 0.75}, {-0.6, 0.9}}};
constexpr std::array<Vec2, 4> patch{{{0.1, 0.2}, {0.8, 0.05}, {0.95, 0.85}, {0.3, 0.7}}};

/// Figure 4.
constexpr std::array<Vec2, 4> trapezoid{{{-1, -0.75}, {1, -0.75}, {0.4, 0.75}, {-0.4, 0.75}}};
constexpr double trapezoid_area = 2.1;

Scene arbitrary() { return face_on(polygon, patch, 3, 38); }

/// The trapezoid so far away that its projected area is `pixels` in a viewport 512 pixels high: with a field of view of
/// 90 degrees an area a at distance d becomes a (256 / d)² pixels.
Scene of_area(double pixels) { return face_on(trapezoid, patch, 256 * std::sqrt(trapezoid_area / pixels), 90); }

Scene area_33600() { return of_area(33'600); }
Scene area_11879() { return of_area(11'879); }
Scene area_3051() { return of_area(3'051); }
Scene area_795() { return of_area(795); }
Scene area_197() { return of_area(197); }

/// A square on the floor whose bottom right corner V lies at (x, z) instead.
Scene dragged(double x, double z) {
  Scene scene;
  add_quad(scene.mesh, {{{-1, 0, 1}, {x, 0, z}, {1, 0, -1}, {-1, 0, -1}}});
  scene.camera = look_from({0.5, 2.4, 2.3}, {-0.1, 0, 0.1}, 44);
  return scene;
}

Scene square() { return dragged(1, 1); }
Scene pulled() { return dragged(0.35, 1.3); }
Scene pushed() { return dragged(0.6, 0.45); }

/// From where the surface folds over. The heights differ: of a saddle with equal ones opposite angles are equal, and
/// the paper's criterion takes it for a parallelogram.
Scene nonplanar() {
  Scene scene;
  add_quad(scene.mesh, {{{-1, -1, 0.7}, {1, -1, -0.9}, {1, 1, 1.1}, {-1, 1, -0.5}}});
  scene.camera = look_from({2.2, 2.7, 2.4}, {-0.05, 0.14, 0}, 37);
  return scene;
}

/// (u, v) = ((x + 1) / 2, (y + 0.75) / 1.5).
Scene affine() { return face_on(trapezoid, {{{0, 0}, {1, 0}, {0.7, 1}, {0.3, 1}}}, 3, 38); }

constexpr std::string_view fig13 = "Oliveira, fig. 13", fig14 = "Oliveira, fig. 14";

constexpr std::array<SceneEntry, 11> entries{{
    {"oliveira12", "A polygon and a texture patch that are both arbitrary convex quadrilaterals", "Oliveira, fig. 12",
     arbitrary},
    {"oliveira13_33600", "A trapezoid of projected area 33,600 px in 512 × 512", fig13, area_33600},
    {"oliveira13_11879", "A trapezoid of projected area 11,879 px in 512 × 512", fig13, area_11879},
    {"oliveira13_3051", "A trapezoid of projected area 3,051 px in 512 × 512", fig13, area_3051},
    {"oliveira13_795", "A trapezoid of projected area 795 px in 512 × 512", fig13, area_795},
    {"oliveira13_197", "A trapezoid of projected area 197 px in 512 × 512", fig13, area_197},
    {"oliveira14_a", "A checkerboard square in perspective", fig14, square},
    {"oliveira14_b", "The square with its bottom right vertex pulled back and to the left in its plane", fig14, pulled},
    {"oliveira14_c", "The square with its bottom right vertex pushed closer to the others in its plane", fig14, pushed},
    {"oliveira15_nonplanar", "A non-planar quadrilateral", "Oliveira, fig. 15", nonplanar},
    {"oliveira16_affine", "A trapezoid with texture coordinates that make the mapping affine", "Oliveira, fig. 16",
     affine},
}};

}  // namespace

std::span<const SceneEntry> adaptive_scenes() { return entries; }

}  // namespace quadrille::golden
