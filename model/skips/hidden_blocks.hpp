// Twin of rtl/quadrille_hidden_blocks.sv: blocks of tiles that nothing can be seen of, known before their tiles are
// tested.
//
// A block here is 8 × 8 tiles of the viewport's own grid; a block of the walk begins at the quad's first tile and lies
// over up to four of them. Of each there are two bounds, as masked_depth has them of a tile: `far` for all of it, and
// `masked_far` for the tiles in a mask. Every test of a tile that says how far the tile's depths can be adds that tile
// to the mask; a mask of all tiles becomes the bound of the block.
//
// Codes, the draw state's promise and clears are those of hierarchical_z.
#pragma once

#include "model/port/config.hpp"
#include "model/skips/tile_places.hpp"

#include <cstdint>
#include <vector>

namespace quadrille {

class HiddenBlocks {
 public:
  HiddenBlocks() = default;
  /// Cleared.
  explicit HiddenBlocks(const Config& config);

  void clear();
  /// Nothing behind `near` can be seen in the columns × rows tiles from this one, at most a block of them.
  bool hidden(int tile_x, int tile_y, int columns, int rows, std::uint32_t near) const;
  /// No depth of the tile is beyond `far`.
  void learn(int tile_x, int tile_y, std::uint32_t far);

 private:
  struct Entry {
    std::uint32_t block = none;
    std::uint32_t far = 0;         ///< of all tiles; all ones: no statement
    std::uint32_t masked_far = 0;  ///< of those in the mask, below `far`
    std::uint64_t mask = 0;        ///< bit 8 y + x
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  TilePlaces places_;
  std::uint32_t unknown_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace quadrille
