// Twin of rtl/quadrille_masked_depth.sv: pixels that nothing can be seen of, known when coverage comes to their tile.
//
// hierarchical_z learns from quads that cover a whole tile; of a mesh most tiles are covered by several quads, none of
// which does. Here a tile has two bounds, after Andersson, Hasselgren, Akenine-Möller (2015), "Masked Depth Culling for
// Graphics Hardware", section 3: `far` for all of it, and a nearer one, `masked_far`, for the pixels in a mask. Quads
// that may lower a depth join the mask or begin a new one, by the depths alone; a mask of the whole tile becomes the
// bound of all of it. Unlike there a tile keeps or loses single pixels, for coverage has them at hand.
//
// Codes, the draw state's promise, places and clears are those of hierarchical_z.
#pragma once

#include "model/skips/hierarchical_z.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille {

class MaskedDepth {
 public:
  MaskedDepth() = default;
  /// Cleared.
  explicit MaskedDepth(const Config& config);

  void clear();

  /// A tile of a quad comes to coverage; all tiles before it are done.
  void begin(int tile_x, int tile_y, const DepthInterval& depth);
  /// Nothing of the tile can be seen: its rows need not be looked at.
  bool hidden() const { return hidden_; }
  /// The next row in which the quad covers the pixels `mask`: those of them that may be seen.
  std::uint32_t row(int row, std::uint32_t mask);
  /// All rows that can have covered pixels are done.
  void end();

 private:
  static constexpr std::size_t most_rows = 16;
  using Mask = std::array<std::uint16_t, most_rows>;  ///< bit dx of row y
  struct Entry {
    std::uint32_t tile = none;
    std::uint32_t far = 0;         ///< of all pixels; all ones: no statement
    std::uint32_t masked_far = 0;  ///< of those in the mask, below `far`; all ones: none is
    Mask mask{};
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  TilePlaces places_;
  std::vector<Entry> entries_;
  std::uint32_t unknown_ = 0;
  std::uint32_t whole_row_ = 0;
  std::size_t rows_ = 0;

  // The tile in work
  std::size_t place_ = 0;
  Entry old_, next_;
  bool hidden_ = false, masked_hidden_ = false;  ///< nothing of the tile, or of the mask, can be seen
  bool joins_ = false;                           ///< a quad that may lower joins the mask, or
  bool begins_ = false;                          ///< begins a new one, with its first pixel
  bool changed_ = false;
};

}  // namespace quadrille
