// The mean value weights of a pixel that is neither on a corner nor on two edges, for any kind of number: one place for
// the truth and for what draws, climbs or chooses in floating point.
#pragma once

#include <array>

namespace quadrille::golden {

template <class Number>
struct RegularWeights {
  std::array<Number, 4> m{};              ///< M_i = (t_{i-1} + t_i) / R_i, up to a common factor
  std::array<Number, 4> left{}, right{};  ///< the two terms of M_i, before the division by R_i

  /// both: R_i R_{i+1}; dot: D_i = S_i · S_{i+1}; area: A_i = S_i × S_{i+1}; rho: 1 / R_i. A common factor of `both`,
  /// `dot` and `area` of an edge does not matter.
  RegularWeights(const std::array<Number, 4>& both, const std::array<Number, 4>& dot, const std::array<Number, 4>& area,
                 const std::array<Number, 4>& rho) {
    // t_i = n_i / d_i by whichever of the two equal forms has no cancellation.
    std::array<Number, 4> n, d;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool behind = dot[i] < 0;
      n[i] = behind ? both[i] - dot[i] : area[i];
      d[i] = behind ? area[i] : both[i] + dot[i];
    }
    // T_i = t_i d_0 d_1 d_2 d_3, M_i = (T_{i-1} + T_i) rho_i: no division, and exact on an edge through the pixel,
    // where d_i = 0.
    const Number d01 = d[0] * d[1], d23 = d[2] * d[3];
    right = {n[0] * d[1] * d23, n[1] * d[0] * d23, n[2] * d[3] * d01, n[3] * d[2] * d01};
    for (std::size_t i = 0; i < 4; ++i) {
      left[i] = right[(i + 3) & 3];
      m[i] = (left[i] + right[i]) * rho[i];
    }
  }
};

}  // namespace quadrille::golden
