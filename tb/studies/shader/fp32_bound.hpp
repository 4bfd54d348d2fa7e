// For tests: what shaders may lose in fp32, by running error analysis.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille::tb {

/// Half an ulp of fp32, relative; and what GLSL 4.50 (section 4.7.1) allows beyond correct rounding, in the same unit:
/// 2.5 ulp of a division, 2 ulp of an inverse square root, sqrt(x) = 1 / inversesqrt(x).
inline constexpr double unit = 0x1p-24;
inline constexpr double division_units = 5, root_units = 4 + division_units;
/// Beyond the first order in unit, for at most some 50 operations in a row: (1 + 50 unit) is less than this.
inline constexpr double higher_orders = 1.00001;

/// A value and a bound of its absolute error: running error analysis (Wilkinson) in double.
struct Bounded {
  double value = 0, error = 0;
};

inline Bounded rounded(double exact) { return {exact, unit * std::fabs(exact)}; }
inline Bounded with_rounding(double value, double error, double units = 1) {
  return {value, error + units * unit * (std::fabs(value) + error)};
}
inline Bounded operator+(Bounded a, Bounded b) { return with_rounding(a.value + b.value, a.error + b.error); }
inline Bounded operator-(Bounded a, Bounded b) { return with_rounding(a.value - b.value, a.error + b.error); }
inline Bounded operator*(Bounded a, Bounded b) {
  return with_rounding(a.value * b.value,
                       std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error);
}
/// Infinite where the divisor may be 0.
inline Bounded operator/(Bounded a, Bounded b) {
  const double least = std::fabs(b.value) - b.error, quotient = a.value / b.value;
  if (!(least > 0)) return {quotient, INFINITY};
  return with_rounding(quotient, (a.error + std::fabs(quotient) * b.error) / least, division_units);
}
inline Bounded root(Bounded a) {
  const double value = std::sqrt(std::max(0.0, a.value)), least = std::sqrt(std::max(0.0, a.value - a.error));
  return with_rounding(value, value > 0 ? a.error / (value + least) : std::sqrt(a.error), root_units);
}
/// In any order of the additions.
inline Bounded sum(const std::array<Bounded, 4>& terms) {
  double value = 0, error = 0, magnitude = 0;
  for (const Bounded& term : terms) {
    value += term.value;
    error += term.error;
    magnitude += std::fabs(term.value) + term.error;
  }
  return {value, error + 3 * unit * magnitude};
}

}  // namespace quadrille::tb
