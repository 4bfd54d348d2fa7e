// What the lanes (float_lanes.hpp, wide_lanes.hpp) take and give: pixels of a quad as a list, its numbers as columns of
// one kind of floating-point number, and results in the list's order.
#pragma once

#include "model/pixel/pixel_pipeline.hpp"
#include "model/port/fragment_arrays.hpp"
#include "model/support/power_of_two.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

namespace quadrille {

double to_double(const PipelineFloat& v, int s);

/// A table for vectors of `Real`, P = 24 or 53 bits. A place is {C0 + integer, (C1 + integer) 2^-rest_bits,
/// C2 4^-rest_bits, 0}; its index is what the argument's bits [rest_bits +: index_bits] say: of the root also the
/// lowest bit of the exponent's code, so its octaves lie the other way round.
template <class Real>
struct LaneTableOf {
  struct alignas(4 * sizeof(Real)) Entry {
    Real c0, c1, c2, unused = 0;
  };
  static constexpr std::size_t column_size = 64;
  static constexpr int fraction_bits = sizeof(Real) == 4 ? 23 : 52;
  /// Sums with it end at integers.
#ifdef __wasm__
  static constexpr Real integer = Real(std::int64_t{3} << (fraction_bits - 1));  ///< those a little below it too
#else
  static constexpr Real integer = Real(std::int64_t{1} << fraction_bits);
#endif
  int rest_bits = 0;              ///< of a number's fraction, below the index
  Real last_place = 0;            ///< integer 2^-rest_bits: what has its last place at 2^-rest_bits
  std::uint32_t offset_mask = 0;  ///< of the index times a place's bytes
  std::vector<Entry> entries;
  bool in_columns = false;  ///< at most column_size places: they are in the columns too, over and over until those end
  alignas(64) std::array<std::array<Real, column_size>, 3> column{};

  LaneTableOf() = default;
  /// `octave_bits` of the exponent are in the index.
  LaneTableOf(const Table& table, int octave_bits);
};
extern template struct LaneTableOf<float>;
extern template struct LaneTableOf<double>;

/// A number per vertex for a sum: magnitudes by sign, and the powers of two that align it.
template <class Real>
struct LaneColumnOf {
  std::array<Real, 4> positive{}, negative{};  ///< |v_i|, 0 where the sign is the other one
  std::array<Real, 4> align{};                 ///< 2^(floor(log2 |v_i|) + P - 1 - PREC_BITS), 0 of a zero
  bool any = false;                            ///< some v_i is not 0
  bool mixed = false;                          ///< of either sign
  /// The sign bit where all are negative, and given as positive.
  std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t> flip = 0;

  LaneColumnOf() = default;
  /// Numbers whose exponents `Real` has; `prec` = PREC_BITS.
  LaneColumnOf(const std::array<double, 4>& values, int prec);
};
extern template struct LaneColumnOf<float>;
extern template struct LaneColumnOf<double>;

/// What a quotient is added to, as codes, and the limits that the sum is clamped to.
template <class Real>
struct LaneCodes;
template <>
struct LaneCodes<float> {
  std::int32_t base = 0, low = 0, high = 0;
  float bound = 0;  ///< of quotients below this single precision has the code, and 32 bits the sum
};
template <>
struct LaneCodes<double> {
  double base = 0, low = 0, high = 0;
};

/// Pixels from a quad's first tile's origin pixel (x0, y0) that it may cover, inclusive.
struct PixelBounds {
  int x0 = 0, y0 = 0;
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// A quad's numbers behind the port as doubles; see QuadData.
///
/// A constant has no differences: its sum is 0 and need not be formed. Depth between equal limits needs no sum at all.
/// W that is k times one factor ±2^n has the sum of k times it, bit for bit: alignment is relative to the largest
/// exponent and truncation toward zero, so that neither sees the factor. With skip_operands W's reciprocal is then k's.
struct QuadLanes {
  using Factor = std::optional<double>;  ///< nothing: the sum is formed

  std::array<double, 4> k{}, w{}, z{};
  std::array<std::array<double, 4>, max_attribute_slots> b{};  ///< [attribute][vertex]
  bool sum_k = true, sum_w = true, sum_z = true;               ///< wanted, and not known to be 0
  std::array<bool, max_attribute_slots> sum_b{};
  bool constant_depth = false;  ///< depth_low, whatever the sums
  Factor w_of_k;

  QuadLanes() = default;
  QuadLanes(const QuadData& quad, const PipelineContext& c);
};

/// What the kernel takes of a quad, but for the functions of pixels.
template <class Real>
struct LaneQuadOf : PixelBounds {
  bool areas = false;  ///< for weights: it is a plane_quad
  // As in QuadLanes.
  bool sum_k = true, sum_w = true, sum_z = true;
  std::array<bool, max_attribute_slots> sum_b{};
  QuadLanes::Factor w_of_k;
  LaneColumnOf<Real> k, w, z;
  std::array<LaneColumnOf<Real>, max_attribute_slots> b;  ///< nothing of vertex 0
  LaneCodes<Real> depth;
  std::array<LaneCodes<Real>, max_attribute_slots> attribute{};
};

/// Everything constant over a draw.
template <class Real>
struct LaneFormatOf {
  int s = 0, prec = 0, attributes = 0, attribute_frac = 0, depth_bits = 0;
  bool depth = false, notch = false;
  std::int32_t znear = 0, zfar = 0;
  LaneTableOf<Real> sqrt, recip;

  LaneFormatOf() = default;
  explicit LaneFormatOf(const PipelineContext& c);
};
extern template struct LaneFormatOf<float>;
extern template struct LaneFormatOf<double>;

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
struct LaneResults {
  using Bits = std::array<std::uint8_t, PixelList::capacity / 8>;  ///< eight to a byte

  LaneResults() = default;
  explicit LaneResults(int attributes) : fragments(PixelList::capacity + PixelList::margin, attributes) {}

  FragmentBuffer fragments;
  Bits drawn{}, plain{}, small{};
  bool all_drawn = true;
  bool any_plain = false;                               ///< pixels for the plain pipeline: on corners or two edges
  bool any_small = false;                               ///< pixels for wide lanes: out of single precision's range
  std::uint64_t on_edge = 0, notch = 0, saturated = 0;  ///< counts, without those

  static bool has(const Bits& bits, std::size_t i) { return (bits[i / 8] >> i % 8 & 1) != 0; }
  static void put(Bits& bits, std::size_t i, bool value) {
    bits[i / 8] = static_cast<std::uint8_t>((bits[i / 8] & ~(1u << i % 8)) | unsigned{value} << i % 8);
  }
  /// Before a list is drawn.
  void begin() {
    all_drawn = true;
    any_plain = any_small = false;
    on_edge = notch = saturated = 0;
  }
};

}  // namespace quadrille
