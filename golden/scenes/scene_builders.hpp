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

/// Adds four corners with texture coordinates (0,0) (1,0) (1,1) (0,1).
void add_quad(Mesh& mesh, const std::array<Vec3, 4>& corners);

}  // namespace quadrille::golden
