// The covered pixels of a quad in the machine's order, for everything that walks a quad without a clock.
#pragma once

#include "model/stamp_coverage.hpp"

#include <bit>

namespace quadrille {

/// A covered pixel of a tile, (dx, row) from the tile's corner.
struct CoveredPixel {
  int dx = 0, row = 0;
  bool front = false, tie = false;
};

/// Calls f(CoveredPixel) for the tile's covered pixels, row by row, from the left. Returns the rows (stamps) with any.
template <class F>
int for_each_covered_pixel(const TileEntry& tile, const QuadConstants& quad, const Config& config,
                           const DrawState& state, F&& f) {
  int stamps = 0;
  for (int row = 0; row < config.tile(); ++row) {
    const StampMasks masks = stamp_coverage(tile, quad, row, config, state);
    stamps += masks.mask != 0;
    for (std::uint32_t rest = masks.mask; rest != 0; rest &= rest - 1) {
      const int dx = std::countr_zero(rest);
      f(CoveredPixel{dx, row, (masks.front >> dx & 1) != 0, (masks.tie >> dx & 1) != 0});
    }
  }
  return stamps;
}

struct WalkCounts {
  std::uint64_t blocks_tested = 0, tiles_tested = 0, tiles_hidden = 0;
};

/// Takes an idle walk through a quad and back to idle; calls f(TileEntry) for every tile that may hold covered pixels.
/// `memory`, `depth`: of hidden tiles (TileWalk::take).
template <class F>
WalkCounts walk_tiles(TileWalk& walk, const SetupResult& setup, F&& f, HierarchicalZ* memory = nullptr,
                      const DepthInterval& depth = {}) {
  WalkCounts counts;
  for (walk.take(setup, memory, depth); walk.state() != TileWalk::State::end; walk.advance()) {
    const bool tile = walk.state() == TileWalk::State::tile;
    ++(tile ? counts.tiles_tested : counts.blocks_tested);
    counts.tiles_hidden += walk.hidden();
    if (tile && walk.hit()) f(walk.entry());
  }
  walk.advance();
  return counts;
}

}  // namespace quadrille
