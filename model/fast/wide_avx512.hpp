// Eight lanes of AVX-512 for kernel.hpp, in double precision: wide_avx2.hpp has the same names.

constexpr int width = 8;
using F = __m512d;
using I = __m512i;

struct Mask {
  __mmask8 lanes;
};
inline Mask operator&(Mask a, Mask b) { return {_kand_mask8(a.lanes, b.lanes)}; }
inline Mask operator|(Mask a, Mask b) { return {_kor_mask8(a.lanes, b.lanes)}; }
inline Mask operator^(Mask a, Mask b) { return {_kxor_mask8(a.lanes, b.lanes)}; }
inline Mask without(Mask a, Mask b) { return {_kandn_mask8(b.lanes, a.lanes)}; }

inline F splat(double v) { return _mm512_set1_pd(v); }
inline I splat(std::int64_t v) { return _mm512_set1_epi64(v); }
inline F real(I v) { return _mm512_castsi512_pd(v); }
inline I bits(F v) { return _mm512_castpd_si512(v); }
inline I load(const std::uint32_t* from) {
  return _mm512_cvtepu32_epi64(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
}

inline F fma(F a, F b, F c) { return _mm512_fmadd_pd(a, b, c); }
inline F least(F a, F b) { return _mm512_min_pd(a, b); }
inline F greatest(F a, F b) { return _mm512_max_pd(a, b); }
inline F keep(F v, F mask) { return _mm512_and_pd(v, mask); }
inline F toward_zero(F v) { return _mm512_roundscale_pd(v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC); }
inline F add(F a, F b) { return a + b; }
inline I add(I a, I b) { return _mm512_add_epi64(a, b); }
inline I subtract(I a, I b) { return _mm512_sub_epi64(a, b); }
template <int places>
I shift_left(I v) {
  return _mm512_slli_epi64(v, places);
}
template <int places>
I shift_right(I v) {
  return _mm512_srli_epi64(v, places);
}
inline I shift_right(I v, int places) { return _mm512_srl_epi64(v, _mm_cvtsi32_si128(places)); }
/// Floor of half.
inline I halved(I v) { return _mm512_srai_epi64(v, 1); }
/// Of numbers below 2^32.
inline I multiply_words(I a, I b) { return _mm512_mul_epu32(a, b); }
/// Modulo 2^64, v below 2^32.
inline I times(I v, std::int64_t by) { return _mm512_mullo_epi64(v, splat(by)); }
/// Rounded toward zero.
inline F converted_any(I v) { return _mm512_cvtepi64_pd(v); }
inline F converted(I v) { return converted_any(v); }

inline Mask sign(I v) { return {_mm512_movepi64_mask(v)}; }
inline Mask equal(F a, F b) { return {_mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ)}; }
inline Mask equal(I a, I b) { return {_mm512_cmpeq_epi64_mask(a, b)}; }
inline Mask at_least(F a, F b) { return {_mm512_cmp_pd_mask(a, b, _CMP_GE_OQ)}; }
inline Mask greater(F a, F b) { return {_mm512_cmp_pd_mask(a, b, _CMP_GT_OQ)}; }
inline Mask no_lane() { return {0}; }
/// Bit l is lane l.
inline unsigned lanes(Mask m) { return m.lanes; }
inline bool none(Mask m) { return m.lanes == 0; }
inline F select(Mask m, F a, F b) { return _mm512_mask_blend_pd(m.lanes, b, a); }
inline I select(Mask m, I a, I b) { return _mm512_mask_blend_epi64(m.lanes, b, a); }
/// That bit in the lanes of the mask.
template <int bit>
I flag(Mask m) {
  return _mm512_maskz_set1_epi64(m.lanes, 1 << bit);
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
  alignas(64) std::array<std::uint64_t, 8> at;
  _mm512_store_si512(at.data(), offset);
  const auto places = [&](std::size_t a0, std::size_t a1) {
    const auto place = [&](std::size_t i) { return _mm256_load_pd(reinterpret_cast<const double*>(entries + at[i])); };
    return _mm512_insertf64x4(_mm512_castpd256_pd512(place(a0)), place(a1), 1);
  };
  const F p04 = places(0, 4), p15 = places(1, 5), p26 = places(2, 6), p37 = places(3, 7);
  const F even01 = _mm512_unpacklo_pd(p04, p15), even23 = _mm512_unpacklo_pd(p26, p37);
  const F odd01 = _mm512_unpackhi_pd(p04, p15), odd23 = _mm512_unpackhi_pd(p26, p37);
  const I first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  return {_mm512_permutex2var_pd(even01, first, even23), _mm512_permutex2var_pd(odd01, first, odd23),
          _mm512_permutex2var_pd(even01, second, even23)};
}

/// Lanes one after the other, of numbers below 2^32.
inline void store(std::uint32_t* to, I v) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi64_epi32(v));
}
/// Of numbers below 2^16.
inline void store_lower_halves(std::uint16_t* to, I v) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm512_cvtepi64_epi16(v));
}
/// Codes, integers below 2^51.
inline void store_widened(std::int64_t* to, F v) { _mm512_storeu_si512(to, _mm512_cvttpd_epi64(v)); }
inline void store(std::uint32_t* to, F v) { store(to, _mm512_cvttpd_epi64(v)); }
