// Functions of Float113 under libquadmath's names, for the tests: the truth itself needs no more than a square root.
#pragma once

#include "model/support/float113.hpp"

#if __LDBL_MANT_DIG__ == 113
#include <cmath>

inline long double atan2q(long double y, long double x) { return std::atan2(y, x); }
inline long double fabsq(long double v) { return std::fabs(v); }
inline long double hypotq(long double x, long double y) { return std::hypot(x, y); }
inline long double scalbnq(long double v, int exponent) { return std::scalbn(v, exponent); }
inline long double sqrtq(long double v) { return std::sqrt(v); }
inline long double tanq(long double v) { return std::tan(v); }
#else
// Declared here: Clang does not find GCC's header.
extern "C" {
quadrille::Float113 atan2q(quadrille::Float113 y, quadrille::Float113 x);
quadrille::Float113 fabsq(quadrille::Float113 v);
quadrille::Float113 hypotq(quadrille::Float113 x, quadrille::Float113 y);
quadrille::Float113 scalbnq(quadrille::Float113 v, int exponent);
quadrille::Float113 sqrtq(quadrille::Float113 v);
quadrille::Float113 tanq(quadrille::Float113 v);
}
#endif
