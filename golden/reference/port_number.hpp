// The real value of a number at the port.
#pragma once

#include "model/records.hpp"

#include <cmath>

namespace quadrille::golden {

/// Value of `number`: ±sig * 2^(exp - (significand_bits - 1)). Exact: at most 32 significant bits, and the port's
/// exponents lie far inside the range of a double.
inline double port_value(const PortNumber& number, int significand_bits) {
  const double magnitude = std::ldexp(static_cast<double>(number.sig), number.exp - (significand_bits - 1));
  return number.neg ? -magnitude : magnitude;
}

}  // namespace quadrille::golden
