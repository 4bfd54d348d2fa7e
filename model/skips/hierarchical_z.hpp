// Twin of rtl/quadrille_hierarchical_z.sv and rtl/quadrille_depth_interval.sv: tiles that nothing can be seen of, known
// before their stamps.
//
// A memory holds, for a tile of pixels, a bound that no depth of the tile in the depth buffer exceeds. It is lowered by
// a quad that covers every pixel of the tile, to the farthest depth that a fragment of that quad can have, and a tile
// of a later quad whose nearest possible depth is not below it is left out. That is right for a draw state that
// promises: depth test LESS, depth writes, nothing that discards a fragment behind the machine, no blending
// (SkipBit::skip_hidden).
//
// Codes have hierarchical_z_bits = H fraction bits: code c of an entry says that no depth is beyond c 2^-H; all ones
// says nothing. Nearest depths round down, farthest ones up. Entries are held by the low bits of the tile's
// coordinates, and the others beside them: a tile that takes another's place forgets what was known of that one, which
// is always right.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "model/skips/hidden_blocks.hpp"
#include "model/skips/tile_places.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille {

/// Where the depths of a quad's fragments lie, in codes; by its corners' codes alone.
struct DepthInterval {
  std::uint32_t near = 0;  ///< no fragment is nearer than near 2^-H
  std::uint32_t far = 0;   ///< and none is farther than far 2^-H; all ones: no statement
  bool lowers = false;  ///< a covered pixel surely is a fragment with a depth in this interval: entries may be lowered

  friend bool operator==(const DepthInterval&, const DepthInterval&) = default;
};

/// Of a quad with a vertex that is not before the eye: [0, infinity). `lowers` also asks for an ordinary quad with D
/// and r² that are exact, so that no sum of weights is 0, and for corners inside [znear, zfar].
DepthInterval depth_interval(const SnappedQuad& quad, const Config& config, const DrawState& state);

/// The machine has the memory, and the draw state asks for it.
bool skips_hidden(const Config& config, const DrawState& state);

class HierarchicalZ {
 public:
  HierarchicalZ() = default;
  /// Cleared.
  explicit HierarchicalZ(const Config& config);

  /// Forgets everything: what a clear of the depth buffer must bring with it.
  void clear();
  /// Nothing of the tile can be seen.
  bool hidden(int tile_x, int tile_y, const DepthInterval& depth) const;
  /// Nothing of the columns × rows tiles from this one can be seen, at most a block of them.
  bool block_hidden(int tile_x, int tile_y, int columns, int rows, const DepthInterval& depth) const;
  /// The tile has been tested. `covered`: the quad covers every pixel of it; lowers the entry where that is nearer.
  void tested(int tile_x, int tile_y, bool covered, const DepthInterval& depth);

 private:
  struct Entry {
    std::uint32_t tile = none, far = 0;
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  TilePlaces places_;
  std::vector<Entry> entries_;
  HiddenBlocks blocks_;
};

/// The tiles that lie wholly inside the scissor rectangle: a quad that covers another one does not draw all of it.
struct WholeTiles {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< half-open

  WholeTiles() = default;
  WholeTiles(const Config& config, const DrawState& state);
  bool hold(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

}  // namespace quadrille
