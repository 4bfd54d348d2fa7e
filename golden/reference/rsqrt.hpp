// Reciprocal square root in Float113 (113-bit significand).
#pragma once

#include "model/support/float113.hpp"

#include <cmath>

namespace quadrille::golden {

/// 1 / sqrt(a) for finite a > 0 inside the exponent range of a normal long double (which is that of Float113);
/// relative error below 2^-110 (the test measures against sqrtq).
///
/// One Newton step from an estimate y in long double: with h = 1 - a y^2, 1/sqrt(a) = y (1 + h/2 + 3 h^2/8 + ...).
/// |h| < 2^-61, so the first dropped term is below 2^-123; h itself carries the rounding of a y^2 near 1, about 2^-113,
/// and its correction to y needs no more than long double.
inline Float113 rsqrt(Float113 a) {
  const long double estimate = 1.0L / std::sqrt(static_cast<long double>(a));
  const Float113 y = estimate;
  const auto h = static_cast<long double>(1 - a * (y * y));
  return y + static_cast<Float113>(estimate * (0.5L * h));
}

}  // namespace quadrille::golden
