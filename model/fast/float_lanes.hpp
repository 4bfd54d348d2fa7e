// The pixel pipeline on four to sixteen pixels of an ordinary quad at once, in single precision: the quickest twin of
// pixel_pipeline.hpp, bit for bit, where everything fits. What does not is for wide_lanes.hpp.
//
// The unit rounds toward zero here. Cutting a magnitude at 24 bits and then at S < 24 is cutting it at S, so that the
// machine's truncations cost nothing or an AND; an alignment is an addition of the power of two whose last place is the
// wanted one. kernel.hpp and float_front.hpp have the reasons operation by operation.
//
// Lanes are filled with the pixels of a quad as they come, across rows and tiles.
#pragma once

#include "model/fast/lane_quad.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_reject.hpp"
#include "model/port/depth_limits.hpp"
#include "model/port/fragment_arrays.hpp"
#include "model/skips/masked_depth.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace quadrille {

/// Functions of pixels: value + gx dx + gy dy.
struct FloatForms {
  std::array<double, linear_count> value{}, gx{}, gy{};
};

enum class FloatColumnOf { weight, depth, attribute };  ///< k or W; differences; differences, with none of vertex 0

/// An ordinary quad. Lengths are in pixels times a power of two, `unit`; pixels (dx, dy) from the first tile's origin
/// pixel.
struct FloatQuad : LaneQuadOf<float> {
  // What homogeneous quads have.
  static constexpr bool hull = false, w_may_vanish = false;
  static constexpr std::int32_t marks = 0;

  double unit2 = 0;                            ///< unit squared
  float least_sum = 0;                         ///< of M k or M W: below it single precision has lost terms
  FloatForms a;                                ///< A
  FloatForms r2;                               ///< the four r² without dx² + dy²
  std::array<double, linear_count> length2{};  ///< SetupResult::length2
};

/// Masks of 64 pixels of a tile: bit row * TILE + dx.
struct TileWord {
  std::uint64_t mask = 0, front = 0, tie = 0;
};
using TileMasks = std::array<TileWord, PixelList::widest / 64>;

/// The edge functions E01 E12 E23 E30 E20 of a quad in 32 bits, in units of 2^low of the quad's own.
struct NarrowEdges {
  static constexpr int tile_log2 = 3;
  static constexpr int limit = 1 << 30;  ///< less than it is what a function spans in a tile

  alignas(32) std::array<std::int32_t, 8> gx{}, gy{};
  std::array<std::uint64_t, 5> tie_positive{}, tie_negative{};  ///< all ones where a zero counts as that
  std::array<std::uint8_t, 5> low{};
  unsigned visible = 0xf;  ///< SetupResult::visible
  bool fit = false;

  NarrowEdges() = default;
  explicit NarrowEdges(const SetupResult& setup);
};

/// The front of an ordinary quad of at most 64 by 64 pixels, within a block of tiles of 8 by 8. Its functions are
/// value + dx gx + dy gy from the first tile's origin pixel, in units of the square of 2^-subpixel_bits.
///
/// From a pixel of the block no corner is 136 pixels away, of two corners one is at most 64 from the other, in x and y:
/// a function is below 2 * 136 * 64 * 2^16 < 2^31 with the 8 subpixel_bits that there are at most.
struct SmallQuad : NarrowEdges {
  static constexpr int largest = 64;  ///< pixels

  alignas(32) std::array<std::int32_t, 8> value{};
  int tiles_x = 0, tiles_y = 0;
};

/// Tiles of a block in the order of tile_walk.
struct SmallWalk {
  struct Tile {
    std::uint8_t x, y;
    friend bool operator==(Tile, Tile) = default;
  };
  int blocks_tested = 0, tiles_tested = 0, hits = 0;
  std::array<Tile, Config::block_tiles * Config::block_tiles> hit;
};

/// Everything constant over a draw, and the work.
class FloatLanes {
 public:
  static constexpr int block = 16;  ///< pixels: the lanes of the widest target

  explicit FloatLanes(const PipelineContext& c);

  /// False: the configuration or a number of the quad does not fit, or it is not ordinary; what `out` holds then is
  /// nobody's.
  bool take(const SetupResult& setup, const QuadData& data, const QuadLanes& values, FloatQuad& out) const;

  /// For TileWalk.
  static std::uint64_t place_signs(std::int64_t value, std::int64_t right, std::int64_t down, int rows);

  struct TileCounts {
    int stamps = 0, pixels = 0, ties = 0;
    bool covered = false;  ///< of cover_small with `masked`: what tile_walk's `covers` says of the tile
  };
  /// For cover(), of a quad's tiles.
  NarrowEdges edges(const SetupResult& setup) const;
  /// Appends the covered pixels of a tile to the list: with `masked`, which has begun the tile, those that may be seen.
  TileCounts cover(const PixelBounds& bounds, const TileCorner& corner, const QuadConstants& quad,
                   const NarrowEdges& edges, MaskedDepth* masked, PixelList& list) const;

  /// Small quads, of configurations, draw states and targets (v3 on) that small() says, without SetupResult and the
  /// like: what comes is the same. Nothing: it is none, or does not fit. Else none, or why it is left out.
  bool small() const;
  std::optional<QuadReject> take_small(const SnappedQuad& quad, FloatQuad& out, SmallQuad& small) const;
  void walk_small(const SmallQuad& quad, SmallWalk& out) const;
  TileCounts cover_small(const PixelBounds& bounds, const SmallQuad& quad, SmallWalk::Tile tile, MaskedDepth* masked,
                         PixelList& list) const;

  /// The first `count` pixels of the list, which has at least one, to the same places of `out`, made for the draw
  /// state's attributes. Leaves the caller's rounding mode as it was.
  void draw(const FloatQuad& quad, const PixelList& list, int count, LaneResults& out) const;

  struct Format : LaneFormatOf<float> {
    int attribute_int_bits = 0, tile_log2 = 0;
    int scissor_x0 = 0, scissor_y0 = 0, scissor_x1 = 0, scissor_y1 = 0;
    Cull cull = Cull::none;
    bool perspective = true;
    int frac = 0, homogeneous_frac_bits = 0, subpixel_bits = 0;
    /// Bit n: a square of pixels may be covered by a face whose functions can have there the signs n. Bits 0 to 4 of n:
    /// the face's own sign of E01 E12 E23 E30 E20, bit 5: the other one of E20.
    std::uint64_t may_face = 0;
  };

 private:
  Config config_;
  DrawState state_;
  Format format_;
  DepthLimits depth_limits_;
  bool fits_ = false, small_ = false;
  int frac_ = 0, val_bits_ = 0, qdrop_ = 0;
};

}  // namespace quadrille
