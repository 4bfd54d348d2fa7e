// Reciprocal square root in __float128 (113-bit significand).
#pragma once

#include <cmath>

namespace quadrille::golden {

/// 1 / sqrt(a) for finite a > 0 inside the exponent range of a normal long double (which is that of __float128);
/// relative error below 2^-110 (the test measures against sqrtq).
///
/// One Newton step from an estimate y in long double: with h = 1 - a y^2, 1/sqrt(a) = y (1 + h/2 + 3 h^2/8 + ...).
/// |h| < 2^-61, so the first dropped term is below 2^-123; h itself carries the rounding of a y^2 near 1, about 2^-113,
/// and its correction to y needs no more than long double.
inline __float128 rsqrt(__float128 a) {
  const long double estimate = 1.0L / std::sqrt(static_cast<long double>(a));
  const __float128 y = estimate;
  const auto h = static_cast<long double>(1 - a * (y * y));
  return y + static_cast<__float128>(estimate * (0.5L * h));
}

}  // namespace quadrille::golden
