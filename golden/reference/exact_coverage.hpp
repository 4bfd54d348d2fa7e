// A second opinion on coverage and visibility of snapped quads, derived without expression (12).
#pragma once

#include "model/port/records.hpp"

namespace quadrille::golden {

struct ExactCoverage {
  bool covered = false;  ///< the signed sum of the two triangles is not 0
  bool front = false;    ///< counter-clockwise as seen on the screen
  bool visible = false;  ///< in front of the eye; false where not covered
};

/// Coverage of pixel (px, py) as the signed sum of the homogeneous triangles (V0, V1, V2) and (V0, V2, V3), in exact
/// integers, with the pixel centre moved symbolically by (+eps, +eps^2). Uses only x, y, w of the vertices (any common
/// unit) and is exact for all int32 vertices and pixels.
///
/// A triangle contributes the common sign of the numerators of c in p = sum(c_i V_i) (Cramer's rule), 0 if they differ
/// in sign or one is identically 0. The point is in front of the eye when the c_i themselves are positive, and never
/// when the determinant is 0.
///
/// Legitimate differences from expression (12) with the integer visibility rule:
///  - an all-zero edge between antipodal neighbours (V_{i+1} = -c V_i, the eye on the edge): (12) counts it as false in
///    either sense, and E20 then contradicts the neighbouring edge in both clauses, so (12) covers nothing at all; this
///    sum keeps the quad's other triangle. All-zero edges of coincident neighbours
///    (V_{i+1} = +c V_i) and an all-zero diagonal make no difference;
///  - the eye in the convex hull of the four vertices: coverage agrees, but visibility is decided there by the sign of
///    sum(M w) of the mean value surface, not by that of either triangle.
ExactCoverage exact_coverage(const SnappedQuad& quad, int px, int py);

}  // namespace quadrille::golden
