// Twin of rtl/quadrille_tile_context.sv: the quadratic functions of a tile that is hit, from its quad's vertices.
#pragma once

#include "model/front/tile_walk.hpp"

namespace quadrille {

/// D and R² around the pixel (x, y) that is so far from the quad's origin pixel: value, gx, gy, q each the floor by
/// `drop` (QDROP) bits of the exact one; exact for an ordinary quad whose positions have no bits there. Of an ordinary
/// quad the squared distances alone, the rest 0.
std::array<QuadraticForm, quadratic_count> tile_context(const QuadConstants& quad, int x, int y, int drop);

// Clocks: rtl/SPEC.md. Step 0 moves an ordinary quad's vertices to the tile, the next are its squares.
// `pairs` of dot units.
/// From a step until its result is in the ring.
inline constexpr int tile_context_result_clocks = 6;
/// A homogeneous quad's first product, when the vertices before it are there.
inline constexpr int tile_context_first_product = 3 + tile_context_result_clocks;
/// A homogeneous quad's last step with a vertex to move.
constexpr int tile_context_last_move(int pairs) { return 4 / pairs; }
constexpr int tile_context_last_step(bool homogeneous, int pairs) {
  return homogeneous ? tile_context_first_product + 20 / pairs - 1 : 2 / pairs;
}

}  // namespace quadrille
