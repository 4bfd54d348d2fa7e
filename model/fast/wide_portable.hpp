// Two lanes of 128 bits for kernel.hpp, in double precision, in the compiler's own vectors: SSE, NEON. Same names as
// wide_avx2.hpp.

constexpr int width = 2;
using F = double __attribute__((vector_size(16)));
using I = std::int64_t __attribute__((vector_size(16)));
using U = std::uint64_t __attribute__((vector_size(16)));

#include "model/fast/portable.hpp"

inline F splat(double v) { return F{v, v}; }
inline I splat(std::int64_t v) { return I{v, v}; }
inline I load(const std::uint32_t* from) { return I{from[0], from[1]}; }

inline F add(F a, F b) { return a + b; }
/// Of magnitudes below 2^52.
#ifdef __wasm__
inline F toward_zero(F v) { return __builtin_elementwise_trunc(v); }
#else
inline F toward_zero(F v) {
  const I sign = bits(v) & INT64_MIN;
  return real(bits(real(bits(v) & INT64_MAX) + splat(0x1p52) - splat(0x1p52)) | sign);
}
#endif
/// Not fused: products have 52 bits.
inline F fma(F a, F b, F c) { return add(c, a * b); }
/// Floor of half.
inline I halved(I v) { return shift_right<1>(v) | (v & INT64_MIN); }
/// Of numbers below 2^32.
inline I multiply_words(I a, I b) {
#ifdef __SSE2__
  return (I)_mm_mul_epu32((__m128i)a, (__m128i)b);
#else
  return I(U(a & 0xffffffff) * U(b & 0xffffffff));
#endif
}
/// Modulo 2^64, v below 2^32.
inline I times(I v, std::int64_t by) {
#ifdef __wasm__
  return I(U(v) * U(splat(by)));
#else
  return add(multiply_words(v, splat(by)), shift_left<32>(multiply_words(v, splat(by >> 32))));
#endif
}
/// Of integers below 2^52.
inline F converted(I v) { return real(v | 0x4330000000000000) - splat(0x1p52); }
/// Of any, rounded toward zero once: `low` is exact and 2^52 too large, the other one exact and as much too small.
#ifdef __wasm__
inline F converted_any(I v) {
  const I size = __builtin_elementwise_abs(v), beyond = (shift_right<53>(size) != 0) & 0x7ff;
  const F high = real(shift_right<32>(size) | 0x4530000000000000);
  const F low = real((size & 0xffffffff & ~beyond) | 0x4330000000000000);
  return real(bits((high - splat(0x1p84 + 0x1p52)) + low) | (v & INT64_MIN));
}
#else
inline F converted_any(I v) {
  const F high = real((shift_right<32>(v) ^ 0x80000000) | 0x4530000000000000);
  const F low = real((v & 0xffffffff) | 0x4330000000000000);
  return (high - splat(0x1p84 + 0x1p63 + 0x1p52)) + low;
}
#endif

inline Mask greater(F a, F b) { return {a > b}; }
/// Bit l is lane l.
#ifdef __wasm__
inline unsigned lanes(Mask m) { return static_cast<unsigned>(__builtin_wasm_bitmask_i64x2(m.lanes)); }
inline bool none(Mask m) { return !__builtin_wasm_any_true_v128(m.lanes); }
#else
inline unsigned lanes(Mask m) { return static_cast<unsigned>((m.lanes[0] & 1) | (m.lanes[1] & 2)); }
inline bool none(Mask m) { return (m.lanes[0] | m.lanes[1]) == 0; }
#endif
/// `a` says which.
inline Coefficients look_up(const LaneTableOf<double>& table, F a) {
#ifdef __wasm__
  // By no shift of so many places, for which the compiler takes lanes apart: the index is in the upper word, which a
  // product moves to a bit that is always the same.
  using W = std::uint32_t __attribute__((vector_size(16)));
  const W offset = ((W)bits(a) & table.offset_mask << (table.rest_bits - 37)) * (1u << (49 - table.rest_bits)) >> 12;
  constexpr std::size_t lane[]{1, 3};
#else
  const I offset = shift_right(bits(a), table.rest_bits - 5) & std::int64_t{table.offset_mask};
  constexpr std::size_t lane[]{0, 1};
#endif
  const auto* entries = reinterpret_cast<const std::uint8_t*>(table.entries.data());
  using Entry = LaneTableOf<double>::Entry;
  const auto& p0 = *reinterpret_cast<const Entry*>(entries + static_cast<std::size_t>(offset[lane[0]]));
  const auto& p1 = *reinterpret_cast<const Entry*>(entries + static_cast<std::size_t>(offset[lane[1]]));
  F first, second;
  std::memcpy(&first, &p0, sizeof first);
  std::memcpy(&second, &p1, sizeof second);
  return {__builtin_shufflevector(first, second, 0, 2), __builtin_shufflevector(first, second, 1, 3), F{p0.c2, p1.c2}};
}

/// Lanes one after the other, of numbers below 2^32.
inline void store(std::uint32_t* to, I v) {
  const std::uint32_t words[]{static_cast<std::uint32_t>(v[0]), static_cast<std::uint32_t>(v[1])};
  std::memcpy(to, words, sizeof words);
}
/// Of numbers below 2^16.
inline void store_lower_halves(std::uint16_t* to, I v) {
  const std::uint16_t halves[]{static_cast<std::uint16_t>(v[0]), static_cast<std::uint16_t>(v[1])};
  std::memcpy(to, halves, sizeof halves);
}
/// Codes, integers below 2^51.
inline void store_widened(std::int64_t* to, F v) {
  const I code = bits(v + splat(0x1.8p52)) - 0x4338000000000000;
  std::memcpy(to, &code, sizeof code);
}
inline void store(std::uint32_t* to, F v) { store(to, bits(v + splat(0x1p52))); }
