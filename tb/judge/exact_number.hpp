// Exact numbers m * 2^e in 127 bits and the truncations of rtl/SPEC.md, Numbers, written for the oracle from that
// page alone; nothing of the model's arithmetic is used.
#pragma once

#include "model/port/stages.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace quadrille::tb::exact {

using Wide = __int128;

inline Wide magnitude(Wide v) { return v < 0 ? -v : v; }
inline int sign_of(Wide v) { return (v > 0) - (v < 0); }

/// floor(log2 |v|), v not 0.
inline int top_bit(Wide v) {
  int top = -1;
  for (Wide m = magnitude(v); m != 0; m >>= 1) ++top;
  return top;
}

/// m * 2^e
struct Number {
  Wide m = 0;
  int e = 0;

  bool zero() const { return m == 0; }
  /// floor(log2 |value|), not of zero.
  int exponent() const { return top_bit(m) + e; }
};

/// PipelineFloat or PortNumber.
template <class Float>
Number value_of(const Float& v, int s) {
  return {v.neg ? -Wide{v.sig} : Wide{v.sig}, v.exp - (s - 1)};
}

inline Number product(const Number& a, const Number& b) { return {a.m * b.m, a.e + b.e}; }

/// Toward zero, to a multiple of 2^grain.
inline Number truncated(const Number& v, int grain) {
  if (v.e >= grain) return v;
  const int drop = std::min(grain - v.e, 126);
  return {sign_of(v.m) * (magnitude(v.m) >> drop), grain};
}

/// Toward zero, to S significant bits.
inline Number cut(const Number& v, int s) { return v.zero() ? v : truncated(v, v.exponent() - (s - 1)); }

/// A product that enters a sum: of two numbers of S bits, or a lone one (times 1).
struct Term {
  Number a, b{1, 0};
};

/// fp_sum: E is the largest sum of exponents among terms that are not 0; every term is truncated G bits below the S
/// bits that 2^E heads, then the sum to S bits.
inline Number sum(std::span<const Term> terms, int s, int g) {
  int largest = std::numeric_limits<int>::min();
  for (const Term& t : terms)
    if (!t.a.zero() && !t.b.zero()) largest = std::max(largest, t.a.exponent() + t.b.exponent());
  if (largest == std::numeric_limits<int>::min()) return {};
  const int grain = largest - (s - 1) - g;
  Number total{0, grain};
  for (const Term& t : terms) {
    const Number part = truncated(product(t.a, t.b), grain);
    if (!part.zero()) total.m += part.m << (part.e - grain);  // at most two bits above 2^E
  }
  return cut(total, s);
}

/// Whether a float of the pipeline is this number, in its normal form: the top bit of sig set, or all fields 0.
template <class Float>
bool is(const Float& v, const Number& wanted, int s) {
  if (wanted.zero()) return v.sig == 0 && v.exp == 0 && !v.neg;
  if (v.sig >> (s - 1) != 1 || v.neg != (wanted.m < 0) || v.exp != wanted.exponent()) return false;
  const int shift = wanted.exponent() - (s - 1) - wanted.e;  // |wanted| = sig * 2^shift in units of 2^wanted.e
  const Wide m = magnitude(wanted.m);
  return shift >= 0 ? (Wide{v.sig} << shift) == m : Wide{v.sig} == m << -shift;
}

/// This number cut to S bits.
inline PipelineFloat float_of(const Number& v, int s) {
  const Number r = cut(v, s);
  if (r.zero()) return {};
  const int exponent = r.exponent(), shift = exponent - (s - 1) - r.e;
  const Wide m = magnitude(r.m);
  return {r.m < 0, exponent, static_cast<std::uint32_t>(shift >= 0 ? m >> shift : m << -shift)};
}

}  // namespace quadrille::tb::exact
