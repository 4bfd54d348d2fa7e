// The generators behind make_scene; not for use outside this folder.
#pragma once

#include "golden/scenes/scenes.hpp"

#include <span>

namespace quadrille::golden {

/// A row of the scene table. `build` fills everything but name, title and paper.
struct SceneEntry {
  std::string_view name, title, paper;
  Scene (*build)();
};

std::span<const SceneEntry> figure_scenes();    ///< single quads in front of the eye
std::span<const SceneEntry> exterior_scenes();  ///< vertices behind the eye
std::span<const SceneEntry> surface_scenes();   ///< meshes
std::span<const SceneEntry> affinity_scenes();  ///< geometry against texture, colours and normals: Bloomenthal
std::span<const SceneEntry> sphere_scenes();    ///< Bloomenthal's spheres and parts of them
std::span<const SceneEntry> adaptive_scenes();  ///< Oliveira
std::span<const SceneEntry> workload_scenes();  ///< of no paper

inline constexpr std::array<Vec2, 4> unit_square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// Adds four corners with texture coordinates.
void add_quad(Mesh& mesh, const std::array<Vec3, 4>& corners, const std::array<Vec2, 4>& textures = unit_square);

/// Looks from `eye` to `target`, up = +y, field of view in degrees, z between 0.5 and 50.
Camera look_from(const Vec3& eye, const Vec3& target, double fovy);

/// A sphere of radius 1 around the origin with normals: `segments` quads around, `bands` from pole to pole (y = ±1).
/// Each pole is one position that two corners of its quads share, with different texture coordinates there.
/// u = longitude / 360 from +z towards +x, v = latitude / 180 + 1/2. `spacing` maps the parts j / bands to v; it rises
/// from 0 to 1.
Mesh sphere_mesh(
    int segments, int bands, double (*spacing)(double) = [](double part) { return part; });

}  // namespace quadrille::golden
