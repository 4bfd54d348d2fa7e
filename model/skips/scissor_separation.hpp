// Twin of rtl/quadrille_scissor_separation.sv: which of the two triangles of expression (12) cannot meet the scissor
// rectangle, of a quad that has no bounding box because some w is not 1.
#pragma once

#include "model/port/stages.hpp"

#include <array>

namespace quadrille {

/// Bit 0: the triangle 012, bit 1: 023. Of a set bit no pixel centre of the scissor lies in the triangle's part in
/// front of the eye, borders and ties included. `clauses` says which way either turns (SetupResult::clauses, the eye
/// outside the hull of the vertices); a triangle without area is never separated.
///
/// The part with w >= 0 of the cone {sum c_i V_i, c_i >= 0} is a convex polygon, perhaps with corners at infinity, and
/// two convex polygons that do not meet are separated by the line of a side of one of them. A side of the rectangle:
/// every corner of the polygon is outside it, the vertices with w >= 0 and the points at infinity of the edges that
/// cross w = 0, whose directions are the edge function's gradient turned by a right angle. A side of the triangle: the
/// edge function has the wrong sign at the rectangle's corner where it is greatest. So hardly a triangle that misses
/// the rectangle is kept: one that passes within a pixel of it (x1 and y1 count as its own here), or touches it at
/// infinity.
unsigned scissor_separation(const SetupResult& quad, const std::array<SnappedVertex, 4>& vertex,
                            const DrawState& state);

}  // namespace quadrille
