// Gentle hills around the origin, to be seen from within and from outside: most quads of the one view are behind the
// eye, beside it or far beyond the picture.
#pragma once

#include "golden/scenes/mesh.hpp"

namespace quadrille::golden {

/// side * side quads of size 1, seen from outside at their front; no texture.
Mesh terrain_mesh(int side);
/// Little above the middle, or beside the mesh; near enough to fill most of the picture.
Camera terrain_camera(int side, bool inside);

}  // namespace quadrille::golden
