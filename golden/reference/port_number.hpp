// Numbers at the port as real values, and back.
#pragma once

#include "model/port/records.hpp"

#include <cmath>
#include <cstdint>

namespace quadrille::golden {

/// Value of `number`: ±sig * 2^(exp - (significand_bits - 1)). Exact: at most 32 significant bits, and the port's
/// exponents lie far inside the range of a double.
inline double port_value(const PortNumber& number, int significand_bits) {
  const double magnitude = std::ldexp(static_cast<double>(number.sig), number.exp - (significand_bits - 1));
  return number.neg ? -magnitude : magnitude;
}

/// The number at the port nearest to a finite value, halves away from zero.
inline PortNumber nearest_port_number(double value, int significand_bits) {
  if (value == 0) return {};
  int exponent = 0;
  const double fraction = std::frexp(std::fabs(value), &exponent);  // in [1/2, 1)
  auto sig = static_cast<std::uint32_t>(std::lround(std::ldexp(fraction, significand_bits)));
  if (sig >> significand_bits != 0) {
    sig >>= 1;
    ++exponent;
  }
  return {value < 0, exponent - 1, sig};
}

}  // namespace quadrille::golden
