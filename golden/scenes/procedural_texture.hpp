// Textures as functions of (u, v): regular enough that every crease, jump or bend of the interpolation shows.
#pragma once

#include "golden/scenes/mesh.hpp"

#include <string_view>
#include <vector>

namespace quadrille::golden {

enum class TextureKind {
  checker,  ///< 8 × 8 checks a unit square, colours graded along u and v, thin dark lines between the checks
  fine,     ///< the same with 16 × 16 checks
  globe,    ///< seas and land with a graticule every 15 degrees; u = longitude / 360, v = 0 at the south pole, 1 at the
            ///< north
};

std::string_view texture_name(TextureKind kind);

/// Red, green, blue in [0, 1]. v up, repeating with period 1 in both directions; unfiltered. Uses only + − × ÷ and
/// floor.
Vec3 procedural_texture(TextureKind kind, double u, double v);

/// The texture sampled at texel centres: width × height colours, rows from the top (v = 1) down. Throws
/// std::invalid_argument for a size below 1.
std::vector<Vec3> procedural_image(TextureKind kind, int width, int height);

}  // namespace quadrille::golden
