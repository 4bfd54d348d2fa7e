// Twin of rtl/quadrille_quad_setup.sv: four snapped vertices to initial values and increments of the linear functions,
// lengths of sides and diagonals, visibility.
#pragma once

#include "model/port/stages.hpp"

namespace quadrille {

/// Exact. Linear forms in units 2^-2FRAC (VAL_BITS, GRAD_BITS); squared lengths in units 2^-quadratic_frac (floor of
/// the exact values by QDROP bits). `slot` of the result is 0. Source: Hormann & Tarini section 4.2, in the homogeneous
/// form of Olano & Greer.
SetupResult quad_setup(const SnappedQuad& quad, const Config& config, const DrawState& state);

/// Tiles to walk: those of the bounding box within the scissor, or from the screen's origin to the scissor's far corner
/// when some w is not 1. No columns and no rows when there is no pixel centre in it.
struct TileRange {
  int x0 = 0, y0 = 0, columns = 0, rows = 0;
  int last_row = 0;  ///< last pixel row, in its tile
};
TileRange bounding_tiles(const SnappedQuad& quad, const Config& config, const DrawState& state);

// Clocks: rtl/SPEC.md, quad_setup. `pairs` of dot units.
/// Steps of a quad, one a clock.
int quad_setup_steps(bool homogeneous, int pairs, const DrawState& state);
/// From the last step until all results are there; with two pairs the reach of the last edge is a clock behind.
constexpr int quad_setup_result_clocks(int pairs) { return 5 + pairs; }

}  // namespace quadrille
