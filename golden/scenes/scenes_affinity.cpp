// Single quads of Bloomenthal's paper: whether texture, colours or normals are an affine image of the geometry.
#include "golden/scenes/scene_builders.hpp"

#include <algorithm>

namespace quadrille::golden {
namespace {

/// In the plane z = 0.
std::array<Vec3, 4> flat(const std::array<Vec2, 4>& shape) {
  std::array<Vec3, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {shape[i][0], shape[i][1], 0};
  return corners;
}

Scene plain(const std::array<Vec3, 4>& corners, const Camera& camera,
            const std::array<Vec2, 4>& textures = unit_square) {
  Scene scene;
  add_quad(scene.mesh, corners, textures);
  scene.camera = camera;
  return scene;
}

constexpr double fovy = 58;

/// Square on, from distance 3.
Camera face_on() { return look_from({0, 0, 3}, {0, 0, 0}, fovy); }

constexpr std::array<Vec2, 4> square{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};

Scene oblique_trapezoid() {
  return plain(flat({{{-1.2, -0.9}, {1.2, -0.9}, {0.4, 0.9}, {-0.4, 0.9}}}),
               look_from({1.5, -0.9, 2.6}, {0.16, -0.12, 0}, 43.5));
}

Scene square_on() { return plain(flat(square), look_from({0, 0, 3}, {0, 0, 0}, 42)); }

/// A point (x, y) of the square is at depth 2.5 + 0.6 y and 0.8 y above the axis.
Scene square_oblique() { return plain(flat(square), look_from({0, -1.5, 2}, {0, 0, 0}, fovy)); }

/// The outline that square_oblique() has on the screen, as a shape of its own.
Scene trapezoid() {
  constexpr double near = 3 / 1.9, far = 3 / 3.1;
  return plain(flat({{{-near, -0.8 * near}, {near, -0.8 * near}, {far, 0.8 * far}, {-far, 0.8 * far}}}), face_on());
}

/// Corner 3 of the geometry is 0.8 of corner 0, −0.7 of corner 1 and 0.9 of corner 2. The affine image of that in the
/// texture is (0.23, 0.86).
Scene fourth_texture_point(const Vec2& fourth) {
  return plain(flat({{{-1, -0.8}, {0.9, -1}, {0.8, 0.75}, {-0.71, 0.735}}}), look_from({0, 0, 3}, {0, 0, 0}, 39),
               {{{0.05, 0.05}, {0.95, 0.05}, {0.95, 0.95}, fourth}});
}

Scene fourth_ideal() { return fourth_texture_point({0.23, 0.86}); }
Scene fourth_outwards() { return fourth_texture_point({0.05, 0.95}); }
Scene fourth_inwards() { return fourth_texture_point({0.41, 0.77}); }

Scene degenerate() {
  return plain(flat({{{-1, -0.95}, {1, -0.95}, {0.1, 0.95}, {0.1, 0.95}}}), look_from({0, 0, 3}, {0, 0, 0}, 38));
}

constexpr Vec3 black{0, 0, 0}, red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, yellow{1, 1, 0}, cyan{0, 1, 1};

/// The square with a colour at each corner; corner 0 of the quad is corner `first` of the square.
Scene coloured(const std::array<Vec3, 4>& colours, std::size_t first) {
  std::array<Vec3, 4> corners = flat(square);
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
  Scene scene = plain(corners, look_from({0, 0, 3}, {0, 0, 0}, 42));
  scene.mesh.colours.assign(colours.begin(), colours.end());
  scene.shade = "colour";
  return scene;
}

Scene colours_a() { return coloured({blue, red, green, black}, 0); }
Scene colours_b() { return coloured({red, green, black, blue}, 1); }
Scene colours_c() { return coloured({blue, red, yellow, cyan}, 0); }

/// Corners 0 and 2 lean one way, 1 and 3 the other.
Scene normals() {
  Scene scene = plain(flat(square), look_from({0, 0, 3}, {0, 0, 0}, 42));
  scene.mesh.normals = {{-0.6, -0.9, 0.7}, {0.8, 0.5, 0.6}, {-0.5, -0.2, 0.9}, {-0.3, 0.9, 0.5}};
  for (std::size_t i = 0; i < 4; ++i) scene.mesh.faces[0][i].normal = static_cast<int>(i);
  scene.shade = "normal";
  return scene;
}

/// A floor quad moved back by `shift`: corner 0 is behind the eye plane by more and more.
Scene moved_to_the_rear(double shift) {
  std::array<Vec3, 4> corners{{{-2.2, -0.8, -0.9}, {1.6, -0.8, -2.2}, {2.4, -0.8, -5.5}, {-1.4, -0.8, -4.2}}};
  for (Vec3& corner : corners) corner[2] += shift;
  Camera camera;
  camera.target = {0, -0.35, -1};
  camera.fovy = 90;
  camera.near = 0.02;
  camera.far = 100;
  return plain(corners, camera);
}

Scene rear_a() { return moved_to_the_rear(1.25); }
Scene rear_b() { return moved_to_the_rear(1.4); }
Scene rear_c() { return moved_to_the_rear(1.6); }

/// Corners of a cube, no two of them neighbours: from the side it projects to a bow-tie.
Scene bowtie(const Vec3& eye, const Vec3& up) {
  Camera camera = look_from(eye, {0, 0, 0}, 15.5);
  camera.up = up;
  return plain({{{-1, -1, 1}, {1, -1, -1}, {1, 1, 1}, {-1, 1, -1}}}, camera);
}

Scene bowtie_a() { return bowtie({9, 0.4, 0.7}, {0, 1, 0}); }
Scene bowtie_b() { return bowtie({0.9, 9, 0.5}, {0, 0, 1}); }

constexpr std::string_view fig2 = "Bloomenthal 2022, fig. 2", fig5 = "Bloomenthal 2022, fig. 5",
                           fig10 = "Bloomenthal 2022, fig. 10", fig14 = "Bloomenthal 2022, fig. 14",
                           fig15 = "Bloomenthal 2022, fig. 15";

constexpr std::array<SceneEntry, 17> entries{{
    {"bloomenthal1", "A textured trapezoid seen obliquely", "Bloomenthal 2022, fig. 1", oblique_trapezoid},
    {"bloomenthal2_square", "A textured square", fig2, square_on},
    {"bloomenthal2_oblique", "The square in an oblique perspective view, a trapezoid on the screen", fig2,
     square_oblique},
    {"bloomenthal3_trapezoid", "A trapezoid with a square texture", "Bloomenthal 2022, fig. 3", trapezoid},
    {"bloomenthal5_a", "The fourth texture point at its affine ideal", fig5, fourth_ideal},
    {"bloomenthal5_b", "The fourth texture point outwards of its affine ideal", fig5, fourth_outwards},
    {"bloomenthal5_c", "The fourth texture point inwards of its affine ideal", fig5, fourth_inwards},
    {"bloomenthal7_degenerate", "A quad with a collapsed upper edge", "Bloomenthal 2022, fig. 7", degenerate},
    {"bloomenthal10_a", "Blue, red, green and black corners: not an affine image of the square", fig10, colours_a},
    {"bloomenthal10_b", "The same colours, corners listed from the next one: split along the other diagonal", fig10,
     colours_b},
    {"bloomenthal10_c", "Blue, red, yellow and cyan corners: an affine image of the square", fig10, colours_c},
    {"bloomenthal11_normals", "A flat quad whose normals differ much from corner to corner",
     "Bloomenthal 2022, fig. 11", normals},
    {"bloomenthal14_a", "A planar quad with a vertex just behind the eye", fig14, rear_a},
    {"bloomenthal14_b", "The same quad moved to the rear", fig14, rear_b},
    {"bloomenthal14_c", "The same quad moved further to the rear", fig14, rear_c},
    {"bloomenthal15_a", "A bow-tie quad", fig15, bowtie_a},
    {"bloomenthal15_b", "The same bow-tie quad in another orientation", fig15, bowtie_b},
}};

}  // namespace

std::span<const SceneEntry> affinity_scenes() { return entries; }

}  // namespace quadrille::golden
