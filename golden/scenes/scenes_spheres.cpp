// Spheres: Bloomenthal's figures 6, 12 and 13, about quads that become trapezoids towards a pole.
#include "golden/scenes/scene_builders.hpp"

#include <cmath>
#include <numbers>

namespace quadrille::golden {
namespace {

/// `v` and `u` as sphere_mesh() has them.
Vec3 sphere_point(double u, double v) {
  const double latitude = std::numbers::pi * (v - 0.5), longitude = 2 * std::numbers::pi * u;
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude), std::cos(latitude) * std::cos(longitude)};
}

/// 60 degrees of longitude from the equator to the pole in six bands; the texture is regular in longitude and latitude.
Scene gore() {
  constexpr int bands = 6;
  Scene scene;
  for (int j = 0; j < bands; ++j) {
    const double low = static_cast<double>(j) / bands, high = static_cast<double>(j + 1) / bands;
    const auto corner = [](double side, double height) { return sphere_point(side / 12, 0.5 + height / 2); };
    const Vec3 pole{0, 1, 0};
    const bool last = j + 1 == bands;
    add_quad(scene.mesh,
             {corner(-1, low), corner(1, low), last ? pole : corner(1, high), last ? pole : corner(-1, high)},
             {{{0, low}, {1, low}, {1, high}, {0, high}}});
  }
  scene.camera = look_from({0, 1.8, 2.5}, {0, 0.58, 0.6}, 37);
  return scene;
}

Scene whole(int segments, int bands) {
  Scene scene;
  scene.mesh = sphere_mesh(segments, bands);
  scene.camera = look_from({1.2, 2.2, 3.0}, {0, 0, 0}, 31);
  scene.texture = TextureKind::globe;
  return scene;
}

Scene sphere_600() { return whole(30, 20); }
Scene sphere_4000() { return whole(100, 40); }

/// Narrow bands at the poles: the distance from a pole grows as the square of the band's number.
double denser_at_poles(double part) {
  const double from_pole = 2 * (part < 0.5 ? part : 1 - part);
  const double v = from_pole * from_pole / 2;
  return part < 0.5 ? v : 1 - v;
}

Scene pole(double (*spacing)(double)) {
  Scene scene;
  scene.mesh = sphere_mesh(100, 40, spacing);
  // Checks of 11.25 degrees of longitude and 2.8 of latitude, small enough to bend where the triangles of a quad meet.
  for (Vec2& t : scene.mesh.texcoords) t = {2 * t[0], 4 * t[1]};
  scene.camera = look_from({0.3, 1.75, 1.1}, {0, 0.99, 0.02}, 13);
  scene.texture = TextureKind::fine;
  return scene;
}

Scene pole_uniform() {
  return pole([](double part) { return part; });
}
Scene pole_dense() { return pole(denser_at_poles); }

constexpr std::string_view fig12 = "Bloomenthal 2022, fig. 12", fig13 = "Bloomenthal 2022, fig. 13";

constexpr std::array<SceneEntry, 5> entries{{
    {"bloomenthal6_sphere_octant", "Quads between two meridians, more trapezoidal the nearer they are to the pole",
     "Bloomenthal 2022, fig. 6", gore},
    {"bloomenthal12_600", "A textured sphere of 30 × 20 = 600 quads", fig12, sphere_600},
    {"bloomenthal12_4000", "A textured sphere of 100 × 40 = 4000 quads", fig12, sphere_4000},
    {"bloomenthal13_uniform", "The pole of a sphere of 4000 quads, bands of equal height", fig13, pole_uniform},
    {"bloomenthal13_dense", "The pole of a sphere of 4000 quads, narrower bands at the poles", fig13, pole_dense},
}};

}  // namespace

Mesh sphere_mesh(int segments, int bands, double (*spacing)(double)) {
  Mesh mesh;
  const auto position_index = [&](int i, int j) {
    if (j == 0) return 0;
    if (j == bands) return 1;
    return 2 + (j - 1) * segments + i % segments;
  };
  mesh.positions.push_back({0, -1, 0});
  mesh.positions.push_back({0, 1, 0});
  for (int j = 1; j < bands; ++j) {
    const double latitude = std::numbers::pi * (spacing(static_cast<double>(j) / bands) - 0.5);
    for (int i = 0; i < segments; ++i) {
      const double longitude = 2 * std::numbers::pi * i / segments;
      mesh.positions.push_back(
          {std::cos(latitude) * std::sin(longitude), std::sin(latitude), std::cos(latitude) * std::cos(longitude)});
    }
  }
  mesh.normals = mesh.positions;
  for (int j = 0; j <= bands; ++j) {
    for (int i = 0; i <= segments; ++i)
      mesh.texcoords.push_back({static_cast<double>(i) / segments, spacing(static_cast<double>(j) / bands)});
  }
  for (int j = 0; j < bands; ++j) {
    for (int i = 0; i < segments; ++i) {
      Face face;
      for (const auto& [di, dj] : {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
        const int p = position_index(i + di, j + dj);
        face.push_back({p, (j + dj) * (segments + 1) + i + di, p});
      }
      mesh.faces.push_back(std::move(face));
    }
  }
  return mesh;
}

std::span<const SceneEntry> sphere_scenes() { return entries; }

}  // namespace quadrille::golden
