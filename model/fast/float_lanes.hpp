// The pixel pipeline on eight or sixteen pixels of an ordinary quad at once, in single precision: the quickest twin of
// pixel_pipeline.hpp, bit for bit, where everything fits. What does not is for pixel_lanes.hpp or the plain pipeline.
//
// The unit rounds toward zero here. Cutting a magnitude at 24 bits and then at S < 24 is cutting it at S, so that the
// machine's truncations cost nothing or an AND; an alignment is an addition of the power of two whose last place is the
// wanted one. float_kernel.hpp has the reasons operation by operation.
//
// Lanes are filled with the pixels of a quad as they come, across rows and tiles.
#pragma once

#include "model/fast/pixel_lanes.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_reject.hpp"
#include "model/port/depth_limits.hpp"
#include "model/port/fragment_arrays.hpp"
#include "model/skips/masked_depth.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace quadrille {

/// A table as floats. A place is {C0 + 2^23, (C1 + 2^23) 2^-rest_bits, C2 4^-rest_bits, 0}; its index is what the
/// argument's bits [rest_bits +: index_bits] say: of the root also the lowest bit of the exponent's code, so its
/// octaves lie the other way round.
struct FloatTable {
  struct alignas(16) Entry {
    float c0, c1, c2, unused = 0;
  };
  static constexpr std::size_t column_size = 64;
  int rest_bits = 0;              ///< of a float's fraction, below the index
  float last_place = 0;           ///< 2^(23 - rest_bits): what has its last place at 2^-rest_bits
  std::uint32_t offset_mask = 0;  ///< of the index times 16, a place's bytes
  std::vector<Entry> entries;
  bool in_columns = false;  ///< at most column_size places: they are in the columns too, over and over until those end
  alignas(64) std::array<std::array<float, column_size>, 3> column{};

  FloatTable() = default;
  /// `octave_bits` of the exponent are in the index.
  FloatTable(const Table& table, int octave_bits);
};

/// A number per vertex for a sum: magnitudes by sign, and the powers of two that align it.
struct FloatColumn {
  std::array<float, 4> positive{}, negative{};  ///< |v_i|, 0 where the sign is the other one
  std::array<float, 4> align{};                 ///< 2^(floor(log2 |v_i|) + 23 - PREC_BITS), 0 of a zero
  bool any = false;                             ///< some v_i is not 0
  bool mixed = false;                           ///< of either sign
  std::int32_t flip = 0;                        ///< the sign bit where all are negative, and given as positive
};
enum class FloatColumnOf { weight, depth, attribute };  ///< k or W; differences; differences, with none of vertex 0

/// What a quotient is added to, as codes, and the limits that the sum is clamped to.
struct FloatCodes {
  std::int32_t base = 0, low = 0, high = 0;
  float bound = 0;  ///< of quotients below this single precision has the code, and 32 bits the sum
};

/// Functions of pixels: value + gx dx + gy dy.
struct FloatForms {
  std::array<double, linear_count> value{}, gx{}, gy{};
};

/// A quad as the kernel takes it. Lengths are in pixels times a power of two, `unit`; pixels (dx, dy) from the first
/// tile's origin pixel.
struct FloatQuad {
  using Factor = QuadLanes::Factor;

  int x0 = 0, y0 = 0;  ///< the first tile's origin pixel
  int left = 0, top = 0, right = 0,
      bottom = 0;                              ///< pixels of the scissor that the corners reach, inclusive, from there
  double unit2 = 0;                            ///< unit squared
  FloatForms a;                                ///< A
  FloatForms r2;                               ///< the four r² without dx² + dy²
  std::array<double, linear_count> length2{};  ///< SetupResult::length2
  bool areas = false;                          ///< for weights: it is a plane_quad
  // As in QuadLanes.
  bool sum_k = true, sum_w = true, sum_z = true;
  std::array<bool, max_attribute_slots> sum_b{};
  Factor w_of_k;
  FloatColumn k, w, z;
  std::array<FloatColumn, max_attribute_slots> b;  ///< nothing of vertex 0
  FloatCodes depth;
  std::array<FloatCodes, max_attribute_slots> attribute{};
};

/// Covered pixels in the machine's order, from the first tile's origin pixel of their quad.
struct PixelList {
  static constexpr int widest = Config::widest_tile * Config::widest_tile;
  static constexpr int capacity = 2 * widest;  ///< a tile more than what may wait
  static constexpr int margin = 16;            ///< written beyond the last pixel, a vector's worth

  int count = 0;
  alignas(64) std::array<std::uint32_t, capacity + margin> place{};  ///< x | y << 16
  /// As in a fragment's bytes: front in bit 0, flags from bit 8 on.
  alignas(64) std::array<std::uint32_t, capacity + margin> marks{};

  /// The first n of them are done.
  void drop(int n) {
    for (auto* column : {&place, &marks}) std::copy_n(column->begin() + n, count - n, column->begin());
    count -= n;
  }
  /// From the first tile's origin pixel. There is room.
  void add(int x, int y, bool front, bool tie) {
    const auto at = static_cast<std::size_t>(count++);
    place[at] = static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << 16;
    marks[at] = static_cast<std::uint32_t>(front) | (tie ? std::uint32_t{flag_tie} << 8 : 0);
  }
};

/// What came of a list of pixels, in its order.
struct FloatResults {
  FloatResults() = default;
  explicit FloatResults(int attributes) : fragments(PixelList::capacity + PixelList::margin, attributes) {}

  FragmentBuffer fragments;
  std::array<std::uint8_t, PixelList::capacity / 8> drawn{}, plain{};  ///< bit by bit, eight to a byte
  bool all_drawn = true;
  bool any_plain = false;  ///< pixels for the plain pipeline: on corners or two edges, or out of the floats' range
  std::uint64_t on_edge = 0, notch = 0, saturated = 0;  ///< counts
};

/// Masks of 64 pixels of a tile: bit row * TILE + dx.
struct TileWord {
  std::uint64_t mask = 0, front = 0, tie = 0;
};
using TileMasks = std::array<TileWord, PixelList::widest / 64>;

/// The front of an ordinary quad of at most 64 by 64 pixels, within a block of tiles of 8 by 8, in 32 bits. Its
/// functions are E01 E12 E23 E30 E20, value + dx gx + dy gy from the first tile's origin pixel, in units of the square
/// of 2^-subpixel_bits.
///
/// From a pixel of the block no corner is 136 pixels away, of two corners one is at most 64 from the other, in x and y:
/// a function is below 2 * 136 * 64 * 2^16 < 2^31 with the 8 subpixel_bits that there are at most.
struct SmallQuad {
  static constexpr int largest = 64;  ///< pixels
  static constexpr int tile_log2 = 3;

  alignas(32) std::array<std::int32_t, 8> value{}, gx{}, gy{};
  std::array<std::uint64_t, 5> tie_positive{}, tie_negative{};  ///< all ones where a zero counts as that
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

  /// Whether the configuration fits, and the instruction set in use has the code (v3 on).
  bool usable() const;
  /// False: the quad is not ordinary, or a number of it does not fit; what `out` holds then is nobody's.
  bool take(const SetupResult& setup, const QuadData& data, const QuadLanes& values, FloatQuad& out) const;

  struct TileCounts {
    int stamps = 0, pixels = 0, ties = 0;
    bool covered = false;  ///< of cover_small with `masked`: what tile_walk's `covers` says of the tile
  };
  /// Appends the covered pixels of a tile to the list: with `masked`, which has begun the tile, those that may be seen.
  TileCounts cover(const FloatQuad& bounds, const TileCorner& corner, const QuadConstants& quad, MaskedDepth* masked,
                   PixelList& list) const;

  /// Small quads, of configurations and draw states that small() says, without SetupResult and the like: what comes is
  /// the same. Nothing: it is none, or does not fit. Else none, or why it is left out.
  bool small() const { return small_; }
  std::optional<QuadReject> take_small(const SnappedQuad& quad, FloatQuad& out, SmallQuad& small) const;
  void walk_small(const SmallQuad& quad, SmallWalk& out) const;
  TileCounts cover_small(const FloatQuad& bounds, const SmallQuad& quad, SmallWalk::Tile tile, MaskedDepth* masked,
                         PixelList& list) const;

  /// The first `count` pixels of the list, which has at least one, to the same places of `out`, made for the draw
  /// state's attributes. Leaves the caller's rounding mode as it was.
  void draw(const FloatQuad& quad, const PixelList& list, int count, FloatResults& out) const;

  struct Format {
    int s = 0, prec = 0, attributes = 0, attribute_int_bits = 0, attribute_frac = 0, depth_bits = 0, tile_log2 = 0;
    bool depth = false, notch = false;
    std::int32_t znear = 0, zfar = 0;
    int scissor_x0 = 0, scissor_y0 = 0, scissor_x1 = 0, scissor_y1 = 0;
    Cull cull = Cull::none;
    bool perspective = true;
    int frac = 0, homogeneous_frac_bits = 0, subpixel_bits = 0;
    FloatTable sqrt, recip;
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
  int frac_ = 0, val_bits_ = 0, qdrop_ = 0, viewport_bits_ = 0;
};

}  // namespace quadrille
