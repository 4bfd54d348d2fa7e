// Polygons with more than four corners, cut into quads and triangles.
#pragma once

#include "golden/scenes/mesh.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrille::golden {

/// Corners of one primitive as indices into the polygon's; a triangle repeats its last one.
using Piece = std::array<std::size_t, 4>;

/// Cuts a polygon of five or more corners so that the pieces cover what it encloses, once. Judged along the axis that
/// its vector area (Newell) is longest on.
///
/// - Where a fan from the first corner does that, as it does for every convex polygon: the fan, as quads and, for an
///   odd number of corners, a triangle at its end.
/// - Else a fan from the first corner in order that sees all of the polygon.
/// - Else triangles, by cutting off ears.
///
/// Corners on a straight line and edges that touch (a hole joined by a bridge) are allowed. Throws
/// std::invalid_argument for a polygon whose edges cross, which encloses nothing, or which is too warped to be cut.
std::vector<Piece> cut_polygon(std::span<const Vec3> corners);

/// From corner `start`: quads and, for an odd number of corners, a triangle at the end.
std::vector<Piece> polygon_fan(std::size_t corners, std::size_t start = 0);

}  // namespace quadrille::golden
