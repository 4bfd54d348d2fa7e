// The truth's filter for many pixels of one quad: double-double numbers, several pixels side by side in vectors.
#pragma once

#include "model/port/records.hpp"
#include "model/support/lane_target.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille::golden {

namespace detail {

/// hi + lo; hi is the double nearest to it.
struct TwoDoubles {
  double hi = 0, lo = 0;
};

/// A quad whose vertices' values are doubles and whose eye is not in the hull. S_i = (x_i - w_i px, y_i - w_i py) in
/// any unit; k, z, w_value and b as in VertexValues.
struct LaneQuad {
  std::array<TwoDoubles, 4> x, y;
  std::array<double, 4> w, k, z, w_value;
  std::array<std::array<double, 4>, max_attribute_slots> b;
  bool perspective;
  int attributes;
};

inline constexpr std::size_t truth_lanes = 8;
/// By pixel. What is said of one that is not covered means nothing beyond `decided`.
struct LaneSamples {
  using Reals = std::array<double, truth_lanes>;
  using Integers = std::array<std::int64_t, truth_lanes>;

  Reals px, py;  ///< in
  /// 0: undecided, nothing else is of use; 1: not covered; else covered, by the clause of (12) that accepts the pixel:
  /// 2 and 3 for orientation 1, 4 and 5 for -1.
  Integers decided;
  Integers notch;  ///< 0 or -1
  Reals visible_margin, condition, z_above, z_condition;
  std::array<Reals, 4> lambda;
  std::array<Reals, max_attribute_slots> attribute_above;
};

/// Decides pixels at no corner and on no edge's line of which no sum cancels much, as TruthQuad::sample() would.
///
/// How far results are off, in units of u^2 = 2^-106. S is within 3 of itself, and exact where the vertices are (then
/// so are signs and zeros of A). The terms of A are within 13 of themselves and A within 16 of their sum, so that with
/// |A| >= 2^-24 of it, which is asked for, its sign is certain and it is within 2^28 of itself; in what follows the
/// rest is small against that. t_i has A_i once, its products T_i each of the four at most once: within 2^30 of itself,
/// and M_i within 2^31 of spread_i. A sum over M_i is within 2^32 of the sum of |terms| by spread, and with a result of
/// at least 2^-13 of it, which is asked for, within 2^45 = 2^-61 of itself. Quotients of these are within 2^-59 before
/// they are rounded to double. So is what has no such condition, beside the sum of its terms' magnitudes.
///
/// Squares of S from 2^-80 to 2^120 and |A| from 2^-120 are asked for, vertices' values are 0 or from 2^-100 to 2^100
/// in magnitude: no product of those below overflows or loses bits at the small end.
inline constexpr double lane_least_area = 0x1p-24, lane_least_sum = 0x1p-13;
inline constexpr double lane_least_value = 0x1p-100, lane_largest_value = 0x1p100;

/// All targets give the same bits.
void sample_lanes(const LaneQuad& quad, LaneTarget lanes, LaneSamples& samples);

}  // namespace detail
}  // namespace quadrille::golden
