// Arithmetic on significand numbers (rtl/SPEC.md, Numbers): fp_multiply, fp_sum and their helpers. Everything
// truncates toward zero; this is the only place where the machine rounds behind the exact front.
#pragma once

#include "model/port/stages.hpp"

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace quadrille {

/// Widths of one significand format, copied out of Config so that inner loops read registers.
struct SignificandFormat {
  int s;  ///< significand bits, 8..26
  int g;  ///< alignment guard bits, 0..6

  PipelineFloat one() const { return {false, 0, std::uint32_t{1} << (s - 1)}; }
};

/// |v| < 2^64 truncated to S bits; exponent of bit 0 is `bias`. Relative error in (-2^-(S-1), 0]. Zero gives zero.
inline PipelineFloat fp_from_magnitude(std::uint64_t v, int bias, const SignificandFormat& f) {
  if (v == 0) return {};
  const int p = 63 - std::countl_zero(v);
  const int drop = p - (f.s - 1);
  return {false, p + bias, static_cast<std::uint32_t>(drop >= 0 ? v >> drop : v << -drop)};
}

/// fp_from_magnitude of |v|, with v's sign.
inline PipelineFloat fp_from_signed(std::int64_t v, int bias, const SignificandFormat& f) {
  const std::uint64_t magnitude = v < 0 ? -static_cast<std::uint64_t>(v) : static_cast<std::uint64_t>(v);
  PipelineFloat r = fp_from_magnitude(magnitude, bias, f);
  r.neg = v < 0;
  return r;
}

/// Exact product of two magnitudes, not normalised: value = (-1)^neg p 2^(exp - (2S-2)), p in [2^(2S-2), 2^2S) or 0.
struct RawProduct {
  bool neg = false;
  std::int32_t exp = 0;
  std::uint64_t p = 0;
};

inline RawProduct raw_product(const PipelineFloat& a, const PipelineFloat& b) {
  return {a.neg != b.neg, a.exp + b.exp, static_cast<std::uint64_t>(a.sig) * b.sig};
}

/// A lone number as a term of a sum.
inline RawProduct raw_from_fp(const PipelineFloat& a, const SignificandFormat& f) {
  return {a.neg, a.exp, static_cast<std::uint64_t>(a.sig) << (f.s - 1)};
}

/// Product truncated to S bits: relative error in (-2^-(S-1), 0]. The sign is that of the product.
inline PipelineFloat fp_multiply(const PipelineFloat& a, const PipelineFloat& b, const SignificandFormat& f) {
  const RawProduct r = raw_product(a, b);
  if (r.p == 0) return {};
  const int carry = static_cast<int>(r.p >> (2 * f.s - 1));
  return {r.neg, r.exp + carry, static_cast<std::uint32_t>(r.p >> (f.s - 1 + carry))};
}

/// Sum of up to four raw products: each term truncated at S-1+G fraction bits of the largest exponent, the sum
/// truncated to S bits. Error below n·2^-(S-1+G) of 2^E plus one truncation, E the largest exponent.
inline PipelineFloat fp_sum(std::span<const RawProduct> terms, const SignificandFormat& f) {
  std::int32_t largest = INT32_MIN;
  for (const RawProduct& t : terms)
    if (t.p != 0 && t.exp > largest) largest = t.exp;
  if (largest == INT32_MIN) return {};
  const int prec = f.s - 1 + f.g;
  std::int64_t sum = 0;
  for (const RawProduct& t : terms) {
    if (t.p == 0) continue;
    // P has 2S-2 fraction bits, the window S-1+G: the difference is the shift at equal exponents.
    const std::int64_t shift = static_cast<std::int64_t>(largest) - t.exp + (2 * f.s - 2 - prec);
    const std::int64_t aligned = shift > 63 ? 0 : static_cast<std::int64_t>(t.p >> shift);
    sum += t.neg ? -aligned : aligned;
  }
  PipelineFloat result = fp_from_magnitude(static_cast<std::uint64_t>(sum < 0 ? -sum : sum), largest - prec, f);
  result.neg = sum < 0;
  return result;
}

inline PipelineFloat fp_sum(std::initializer_list<RawProduct> terms, const SignificandFormat& f) {
  return fp_sum(std::span<const RawProduct>(terms.begin(), terms.size()), f);
}

}  // namespace quadrille
