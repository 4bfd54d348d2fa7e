// Four lanes of AVX2 for kernel.hpp, in double precision: wide_avx512.hpp has the same names. Of a mask the sign bit of
// each lane counts.

constexpr int width = 4;
using F = __m256d;
using I = __m256i;

struct Mask {
  F sign;
};
inline Mask operator&(Mask a, Mask b) { return {_mm256_and_pd(a.sign, b.sign)}; }
inline Mask operator|(Mask a, Mask b) { return {_mm256_or_pd(a.sign, b.sign)}; }
inline Mask operator^(Mask a, Mask b) { return {_mm256_xor_pd(a.sign, b.sign)}; }
inline Mask without(Mask a, Mask b) { return {_mm256_andnot_pd(b.sign, a.sign)}; }

inline F splat(double v) { return _mm256_set1_pd(v); }
inline I splat(std::int64_t v) { return _mm256_set1_epi64x(v); }
inline F real(I v) { return _mm256_castsi256_pd(v); }
inline I bits(F v) { return _mm256_castpd_si256(v); }
inline I load(const std::uint32_t* from) {
  return _mm256_cvtepu32_epi64(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
}

inline F fma(F a, F b, F c) { return _mm256_fmadd_pd(a, b, c); }
inline F least(F a, F b) { return _mm256_min_pd(a, b); }
inline F greatest(F a, F b) { return _mm256_max_pd(a, b); }
inline F keep(F v, F mask) { return _mm256_and_pd(v, mask); }
inline F toward_zero(F v) { return _mm256_round_pd(v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC); }
inline F add(F a, F b) { return a + b; }
inline I add(I a, I b) { return _mm256_add_epi64(a, b); }
inline I subtract(I a, I b) { return _mm256_sub_epi64(a, b); }
template <int places>
I shift_left(I v) {
  return _mm256_slli_epi64(v, places);
}
template <int places>
I shift_right(I v) {
  return _mm256_srli_epi64(v, places);
}
inline I shift_right(I v, int places) { return _mm256_srl_epi64(v, _mm_cvtsi32_si128(places)); }
/// Floor of half.
inline I halved(I v) { return shift_right<1>(v) | (v & splat(INT64_MIN)); }
/// Of numbers below 2^32.
inline I multiply_words(I a, I b) { return _mm256_mul_epu32(a, b); }
/// Modulo 2^64, v below 2^32.
inline I times(I v, std::int64_t by) {
  return add(multiply_words(v, splat(by)), shift_left<32>(multiply_words(v, splat(by >> 32))));
}
/// Of integers below 2^52.
inline F converted(I v) { return real(v | splat(0x4330000000000000)) - splat(0x1p52); }
/// Of any, rounded toward zero once: `low` is exact and 2^52 too large, the other one exact and as much too small.
inline F converted_any(I v) {
  const F high = real((shift_right<32>(v) ^ splat(std::int64_t{0x80000000})) | splat(0x4530000000000000));
  const F low = real((v & splat(std::int64_t{0xffffffff})) | splat(0x4330000000000000));
  return (high - splat(0x1p84 + 0x1p63 + 0x1p52)) + low;
}

inline Mask sign(I v) { return {real(v)}; }
inline Mask equal(F a, F b) { return {_mm256_cmp_pd(a, b, _CMP_EQ_OQ)}; }
inline Mask equal(I a, I b) { return {real(_mm256_cmpeq_epi64(a, b))}; }
inline Mask at_least(F a, F b) { return {_mm256_cmp_pd(a, b, _CMP_GE_OQ)}; }
inline Mask greater(F a, F b) { return {_mm256_cmp_pd(a, b, _CMP_GT_OQ)}; }
inline Mask no_lane() { return {_mm256_setzero_pd()}; }
/// Bit l is lane l.
inline unsigned lanes(Mask m) { return static_cast<unsigned>(_mm256_movemask_pd(m.sign)); }
inline bool none(Mask m) { return lanes(m) == 0; }
inline F select(Mask m, F a, F b) { return _mm256_blendv_pd(b, a, m.sign); }
inline I select(Mask m, I a, I b) { return bits(select(m, real(a), real(b))); }
/// That bit in the lanes of the mask.
template <int bit>
I flag(Mask m) {
  return shift_left<bit>(shift_right<63>(bits(m.sign)));
}

/// Places of a table for each lane.
struct Coefficients {
  F c0, c1, c2;
};
constexpr bool looks_up_columns = false;

/// `a` says which.
inline Coefficients look_up(const LaneTableOf<double>& table, F a) {
  const I offset = shift_right(bits(a), table.rest_bits - 5) & splat(static_cast<std::int64_t>(table.offset_mask));
  const auto* entries = reinterpret_cast<const std::uint8_t*>(table.entries.data());
  const auto place = [&](std::int64_t at) {
    return _mm256_load_pd(reinterpret_cast<const double*>(entries + static_cast<std::size_t>(at)));
  };
  const __m128i low = _mm256_castsi256_si128(offset), high = _mm256_extracti128_si256(offset, 1);
  const F p0 = place(_mm_cvtsi128_si64(low)), p1 = place(_mm_extract_epi64(low, 1));
  const F p2 = place(_mm_cvtsi128_si64(high)), p3 = place(_mm_extract_epi64(high, 1));
  const F even01 = _mm256_unpacklo_pd(p0, p1), even23 = _mm256_unpacklo_pd(p2, p3);
  return {_mm256_permute2f128_pd(even01, even23, 0x20),
          _mm256_permute2f128_pd(_mm256_unpackhi_pd(p0, p1), _mm256_unpackhi_pd(p2, p3), 0x20),
          _mm256_permute2f128_pd(even01, even23, 0x31)};
}

/// Lanes one after the other, of numbers below 2^32.
inline void store(std::uint32_t* to, I v) {
  const I packed = _mm256_permutevar8x32_epi32(v, _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(packed));
}
/// Of numbers below 2^16.
inline void store_lower_halves(std::uint16_t* to, I v) {
  const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_packus_epi32(words, words));
}
/// Codes, integers below 2^51.
inline void store_widened(std::int64_t* to, F v) {
  const I code = subtract(bits(v + splat(0x1.8p52)), splat(0x4338000000000000));
  _mm256_storeu_si256(reinterpret_cast<I*>(to), code);
}
inline void store(std::uint32_t* to, F v) { store(to, bits(v + splat(0x1p52))); }
