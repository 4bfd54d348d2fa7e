// The covered pixels of a quad in the machine's order, for everything that walks a quad without a clock.
#pragma once

#include "model/front/stamp_coverage.hpp"

#include <bit>

namespace quadrille {

/// A covered pixel of a tile, (dx, row) from the tile's corner.
struct CoveredPixel {
  int dx = 0, row = 0;
  bool front = false, tie = false;
};

/// For for_each_covered_pixel: all of them.
struct AllPixels {
  std::uint32_t operator()(int /*row*/, std::uint32_t mask) const { return mask; }
};

/// Calls f(CoveredPixel) for the tile's covered pixels, row by row, from the left, of those that seen(row, mask) leaves
/// of a row's mask. Returns the rows (stamps) with any.
template <class F, class Seen = AllPixels>
int for_each_covered_pixel(const TileEntry& tile, const QuadConstants& quad, const Config& config,
                           const DrawState& state, F&& f, Seen&& seen = {}) {
  int stamps = 0;
  for (int row = 0; row < config.tile(); ++row) {
    const StampMasks masks = stamp_coverage(tile, quad, row, config, state);
    const std::uint32_t left = seen(row, masks.mask);
    stamps += left != 0;
    for (std::uint32_t rest = left; rest != 0; rest &= rest - 1) {
      const int dx = std::countr_zero(rest);
      f(CoveredPixel{dx, row, (masks.front >> dx & 1) != 0, (masks.tie >> dx & 1) != 0});
    }
  }
  return stamps;
}

struct WalkCounts {
  std::uint64_t blocks_tested = 0, blocks_hidden = 0, tiles_tested = 0, tiles_hidden = 0;
};

/// Takes an idle walk through a quad and back to idle; calls f() at every tile that may hold covered pixels.
/// `memory`, `depth`: of hidden tiles (TileWalk::take).
template <class F>
WalkCounts walk_quad(TileWalk& walk, const SetupResult& setup, F&& f, HierarchicalZ* memory = nullptr,
                     const DepthInterval& depth = {}) {
  WalkCounts counts;
  for (walk.take(setup, memory, depth); walk.state() != TileWalk::State::end;) {
    const bool tile = walk.state() == TileWalk::State::tile;
    if (tile && memory == nullptr) {
      const TileBlock block = walk.block();
      counts.tiles_tested += static_cast<std::uint64_t>(block.columns * block.rows);
      walk.advance_block(f);
      continue;
    }
    if (walk.state() != TileWalk::State::approach) {
      ++(tile ? counts.tiles_tested : counts.blocks_tested);
      if (walk.hidden()) ++(tile ? counts.tiles_hidden : counts.blocks_hidden);
      if (tile && walk.hit()) f();
    }
    walk.advance();
  }
  walk.advance();
  return counts;
}

/// The same with f(TileEntry).
template <class F>
WalkCounts walk_tiles(TileWalk& walk, const SetupResult& setup, F&& f) {
  return walk_quad(walk, setup, [&] { f(walk.entry()); });
}

}  // namespace quadrille
