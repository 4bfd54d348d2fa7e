// Twin of rtl/quadrille_stamp_coverage.sv: one row of a tile, TILE×1 pixels, against the five edge functions.
#pragma once

#include "model/front/tile_walk.hpp"

namespace quadrille {

/// Bits of one row, bit dx for the pixel at the tile's x + dx; front and tie are 0 where mask is.
struct StampMasks {
  std::uint32_t mask = 0, front = 0, tie = 0;
};

/// Exact. `entry` is the ring entry, `row` 0..TILE-1. Source: Hormann & Tarini expression (12); ties as
/// rtl/SPEC.md.
StampMasks stamp_coverage(const TileEntry& entry, const QuadConstants& quad, int row, const Config& config,
                          const DrawState& state);

}  // namespace quadrille
