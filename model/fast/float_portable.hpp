// Four lanes of 128 bits for kernel.hpp, in single precision, in the compiler's own vectors: SSE, NEON. Same names as
// float_avx2.hpp.

constexpr int width = 4;
using F = float __attribute__((vector_size(16)));
using I = std::int32_t __attribute__((vector_size(16)));
using U = std::uint32_t __attribute__((vector_size(16)));
using D = double __attribute__((vector_size(16)));  ///< half of the lanes
using L = std::int64_t __attribute__((vector_size(16)));

#include "model/fast/portable.hpp"

inline F splat(float v) { return F{v, v, v, v}; }
inline D splat(double v) { return D{v, v}; }
inline I splat(std::int32_t v) { return I{v, v, v, v}; }
inline I load(const std::uint32_t* from) {
  I v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

inline F add(F a, F b) { return a + b; }
/// Not fused: the sum ends at a place no finer than the product's last one.
inline F fma(F a, F b, F c) { return a * b + c; }
inline D fma(D a, D b, D c) { return a * b + c; }
constexpr bool fused = false;
inline D select(L m, D a, D b) { return (D)(((L)a & m) | ((L)b & ~m)); }
inline D least(D a, D b) { return select(a < b, a, b); }
inline D greatest(D a, D b) { return select(a > b, a, b); }
inline I least(I a, I b) { return select(Mask{a < b}, a, b); }
inline I greatest(I a, I b) { return select(Mask{a > b}, a, b); }
/// Half of a magnitude; 0 of 0.
inline F half(F v) { return v * splat(0.5f); }
inline F converted(I v) { return __builtin_convertvector(v, F); }
/// Of magnitudes below 2^52; larger ones are integers anyway, but for their last places.
inline D toward_zero(D v) {
  const L sign = (L)v & INT64_MIN;
  const D integer = (D)((L)v & INT64_MAX) + splat(0x1p52) - splat(0x1p52);
  return (D)((L)integer | sign);
}
inline I truncated(F v) { return __builtin_convertvector(v, I); }

inline Mask not_at_least(F a, F b) { return {~(a >= b)}; }
inline Mask greater(I a, I b) { return {a > b}; }
/// Bit l is lane l.
inline unsigned lanes(Mask m) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps((__m128)m.lanes));
#else
  const I bit = m.lanes & I{1, 2, 4, 8};
  return static_cast<unsigned>(bit[0] | bit[1] | bit[2] | bit[3]);
#endif
}
inline bool none(Mask m) {
#ifdef __SSE2__
  return lanes(m) == 0;
#else
  const L two = (L)m.lanes;
  return (two[0] | two[1]) == 0;
#endif
}
struct Halves {
  D a, b;
};
inline Halves to_doubles(I v) { return {D{double(v[0]), double(v[1])}, D{double(v[2]), double(v[3])}}; }
/// The upper 32 bits of doubles: sign, exponent, 20 bits of the significand.
inline I upper_halves(D a, D b) {
  constexpr int upper = std::endian::native == std::endian::little ? 1 : 0;
  return __builtin_shufflevector((I)a, (I)b, upper, upper + 2, upper + 4, upper + 6);
}

/// The lanes one after the other.
struct Doubles {
  D low, high;
};
inline Doubles widened(F v) { return {D{double(v[0]), double(v[1])}, D{double(v[2]), double(v[3])}}; }
/// What has no place in 32 bits becomes no number near 0.
inline I truncated(Doubles v) {
  const auto one = [](double of) {
    return static_cast<std::int32_t>(std::min(std::max(of, -2147483648.0), 2147483647.0));
  };
  return I{one(v.low[0]), one(v.low[1]), one(v.high[0]), one(v.high[1])};
}

/// `a` says which.
inline Coefficients look_up(const LaneTableOf<float>& table, F a) {
  const I offset = shift_right(bits(a), table.rest_bits - 4) & splat(static_cast<std::int32_t>(table.offset_mask));
  const auto* entries = reinterpret_cast<const std::uint8_t*>(table.entries.data());
  const auto place = [&](std::int32_t at) {
    return (F)load(reinterpret_cast<const std::uint32_t*>(entries + static_cast<std::size_t>(at)));
  };
  const F p0 = place(offset[0]), p1 = place(offset[1]), p2 = place(offset[2]), p3 = place(offset[3]);
  const F low01 = __builtin_shufflevector(p0, p1, 0, 4, 1, 5), low23 = __builtin_shufflevector(p2, p3, 0, 4, 1, 5);
  return {__builtin_shufflevector(low01, low23, 0, 1, 4, 5), __builtin_shufflevector(low01, low23, 2, 3, 6, 7),
          F{p0[2], p1[2], p2[2], p3[2]}};
}

/// Lanes one after the other.
inline void store(std::uint32_t* to, I v) { std::memcpy(to, &v, sizeof v); }
/// Of numbers below 2^16.
inline void store_lower_halves(std::uint16_t* to, I v) {
  using Shorts = std::uint16_t __attribute__((vector_size(8)));
  const auto packed = __builtin_convertvector(U(v), Shorts);
  std::memcpy(to, &packed, sizeof packed);
}
/// With their signs.
inline void store_widened(std::int64_t* to, I v) {
  for (int l = 0; l < width; ++l) to[l] = v[l];
}

/// As in edge_signs_avx2.hpp.
inline void edge_signs(std::int64_t value, std::int64_t gx, std::int64_t gy, Range rows, int from, int to, int tile,
                       std::uint64_t* below, std::uint64_t* zero) {
  for (int row = rows.from; row < rows.to; ++row) {
    std::int64_t e = wrap_add(value, from * gx + row * gy);
    std::uint64_t row_below = 0, row_zero = 0;
    for (int dx = from; dx < to; ++dx, e = wrap_add(e, gx)) {
      row_below |= std::uint64_t{e < 0} << dx;
      row_zero |= std::uint64_t{e == 0} << dx;
    }
    below[row * tile >> 6] |= row_below << (row * tile & 63);
    zero[row * tile >> 6] |= row_zero << (row * tile & 63);
  }
}

/// Writes a word's pixels behind the list's end.
inline void append(const TileWord& word, int x0, int y0, int tile_log2, PixelList& list) {
  auto end = static_cast<std::size_t>(list.count);
  for (std::uint64_t mask = word.mask; mask != 0; mask &= mask - 1, ++end) {
    const int at = std::countr_zero(mask);
    list.place[end] = static_cast<std::uint32_t>((x0 + (at & ((1 << tile_log2) - 1))) | (y0 + (at >> tile_log2)) << 16);
    list.marks[end] = static_cast<std::uint32_t>(word.front >> at & 1) | static_cast<std::uint32_t>(word.tie >> at & 1)
                                                                             << (8 + 4);
  }
}
