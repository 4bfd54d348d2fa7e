// Sixteen lanes of AVX-512 for kernel.hpp, in single precision: float_avx2.hpp has the same names.

constexpr int width = 16;
using F = __m512;
using I = __m512i;
using D = __m512d;  ///< half of the lanes

struct Mask {
  __mmask16 lanes;
};
inline Mask operator&(Mask a, Mask b) { return {_kand_mask16(a.lanes, b.lanes)}; }
inline Mask operator|(Mask a, Mask b) { return {_kor_mask16(a.lanes, b.lanes)}; }
inline Mask operator^(Mask a, Mask b) { return {_kxor_mask16(a.lanes, b.lanes)}; }
inline Mask without(Mask a, Mask b) { return {_kandn_mask16(b.lanes, a.lanes)}; }

inline F splat(float v) { return _mm512_set1_ps(v); }
inline D splat(double v) { return _mm512_set1_pd(v); }
inline I splat(std::int32_t v) { return _mm512_set1_epi32(v); }
inline F real(I v) { return _mm512_castsi512_ps(v); }
inline I bits(F v) { return _mm512_castps_si512(v); }
inline I load(const std::uint32_t* aligned) { return _mm512_load_si512(aligned); }

inline F fma(F a, F b, F c) { return _mm512_fmadd_ps(a, b, c); }
inline D fma(D a, D b, D c) { return _mm512_fmadd_pd(a, b, c); }
constexpr bool fused = true;
inline F least(F a, F b) { return _mm512_min_ps(a, b); }
inline F greatest(F a, F b) { return _mm512_max_ps(a, b); }
inline D least(D a, D b) { return _mm512_min_pd(a, b); }
inline D greatest(D a, D b) { return _mm512_max_pd(a, b); }
inline I least(I a, I b) { return _mm512_min_epi32(a, b); }
inline I greatest(I a, I b) { return _mm512_max_epi32(a, b); }
inline F keep(F v, F mask) { return _mm512_and_ps(v, mask); }
inline F add(F a, F b) { return a + b; }
inline I add(I a, I b) { return _mm512_add_epi32(a, b); }
inline I subtract(I a, I b) { return _mm512_sub_epi32(a, b); }
template <int places>
I shift_left(I v) {
  return _mm512_slli_epi32(v, places);
}
template <int places>
I shift_right(I v) {
  return _mm512_srli_epi32(v, places);
}
inline I shift_right(I v, int places) { return _mm512_srl_epi32(v, _mm_cvtsi32_si128(places)); }
/// Half of a magnitude; 0 of 0.
inline F half(F v) { return real(_mm512_subs_epu16(bits(v), splat(1 << 23))); }
inline F converted(I v) { return _mm512_cvtepi32_ps(v); }
inline D toward_zero(D v) { return _mm512_roundscale_pd(v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC); }
inline I truncated(F v) { return _mm512_cvttps_epi32(v); }

inline Mask sign(I v) { return {_mm512_movepi32_mask(v)}; }
inline Mask equal(F a, F b) { return {_mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ)}; }
inline Mask at_least(F a, F b) { return {_mm512_cmp_ps_mask(a, b, _CMP_GE_OQ)}; }
inline Mask not_at_least(F a, F b) { return {_mm512_cmp_ps_mask(a, b, _CMP_NGE_UQ)}; }
inline Mask equal(I a, I b) { return {_mm512_cmpeq_epi32_mask(a, b)}; }
inline Mask greater(I a, I b) { return {_mm512_cmpgt_epi32_mask(a, b)}; }
inline Mask no_lane() { return {0}; }
/// Bit l is lane l.
inline unsigned lanes(Mask m) { return m.lanes; }
inline bool none(Mask m) { return m.lanes == 0; }
inline F select(Mask m, F a, F b) { return _mm512_mask_blend_ps(m.lanes, b, a); }
inline I select(Mask m, I a, I b) { return _mm512_mask_blend_epi32(m.lanes, b, a); }
/// That bit in the lanes of the mask.
template <int bit>
I flag(Mask m) {
  return _mm512_maskz_set1_epi32(m.lanes, 1 << bit);
}

/// Lanes 0 1 4 5 … and 2 3 6 7 …: upper_halves puts them in order.
struct Halves {
  D a, b;
};
inline Halves to_doubles(I v) {
  const I order = _mm512_permutexvar_epi64(_mm512_set_epi64(7, 5, 3, 1, 6, 4, 2, 0), v);
  return {_mm512_cvtepi32_pd(_mm512_castsi512_si256(order)), _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(order, 1))};
}
/// The upper 32 bits of doubles: sign, exponent, 20 bits of the significand.
inline I upper_halves(D a, D b) { return bits(_mm512_shuffle_ps(_mm512_castpd_ps(a), _mm512_castpd_ps(b), 0xdd)); }

/// The lanes one after the other.
struct Doubles {
  D low, high;
};
inline Doubles widened(F v) {
  return {_mm512_cvtps_pd(_mm512_castps512_ps256(v)), _mm512_cvtps_pd(_mm512_extractf32x8_ps(v, 1))};
}
/// What has no place in 32 bits becomes the least integer.
inline I truncated(Doubles v) {
  return _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvttpd_epi32(v.low)), _mm512_cvttpd_epi32(v.high), 1);
}

/// Places of a table for each lane.
struct Coefficients {
  F c0, c1, c2;
};
constexpr bool looks_up_columns = true;

/// `a` says which.
inline Coefficients look_up(const LaneTableOf<float>& table, F a) {
  const I offset =
      shift_right(bits(a), table.rest_bits - 4) & splat(static_cast<std::int32_t>(table.offset_mask));  // in bytes
  const auto gather = [&](const float& first) { return _mm512_i32gather_ps(offset, &first, 1); };
  return {gather(table.entries[0].c0), gather(table.entries[0].c1), gather(table.entries[0].c2)};
}

/// The same of a table in columns, by permutes, of several at once: a column is loaded once.
template <std::size_t n>
void look_up_columns(const LaneTableOf<float>& table, const F (&a)[n], Coefficients (&out)[n]) {
  I index[n];
  __mmask16 second[n];
  for (std::size_t i = 0; i < n; ++i) {
    index[i] = shift_right(bits(a[i]), table.rest_bits);  // what is above 6 bits does not count
    second[i] = _mm512_test_epi32_mask(index[i], splat(32));
  }
  const auto column = [&](std::size_t c, F Coefficients::*to) {
    const auto part = [&](std::size_t p) { return _mm512_load_ps(table.column[c].data() + 16 * p); };
    const F p0 = part(0), p1 = part(1), p2 = part(2), p3 = part(3);
    for (std::size_t i = 0; i < n; ++i)
      out[i].*to = _mm512_mask_blend_ps(second[i], _mm512_permutex2var_ps(p0, index[i], p1),
                                        _mm512_permutex2var_ps(p2, index[i], p3));
  };
  column(0, &Coefficients::c0);
  column(1, &Coefficients::c1);
  column(2, &Coefficients::c2);
}

/// Lanes one after the other.
inline void store(std::uint32_t* to, I v) { _mm512_storeu_si512(to, v); }
/// Of numbers below 2^16.
inline void store_lower_halves(std::uint16_t* to, I v) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi32_epi16(v));
}
/// With their signs.
inline void store_widened(std::int64_t* to, I v) {
  _mm512_storeu_si512(to, _mm512_cvtepi32_epi64(_mm512_castsi512_si256(v)));
  _mm512_storeu_si512(to + 8, _mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64(v, 1)));
}

/// Signs of value + dx gx + dy gy at the pixels of a tile of 8 by 8, bit 8 row + dx.
struct TileSigns {
  std::uint64_t negative, zero;
};
inline TileSigns tile_signs(int value, int gx, int gy) {
  // Packing takes four vectors to one of bytes, signs and zeros unchanged; byte 16 l + 4 q + i is of vector q, there of
  // place 4 l + i.
  const I columns = _mm512_mullo_epi32(splat(gx), _mm512_broadcast_i32x4(_mm_setr_epi32(0, 1, 2, 3)));
  const I rows = _mm512_mullo_epi32(splat(gy), _mm512_setr_epi32(0, 0, 0, 0, 2, 2, 2, 2, 4, 4, 4, 4, 6, 6, 6, 6));
  const I right = splat(4 * gx), e0 = add(add(columns, rows), splat(value)), e2 = add(e0, splat(gy));
  const I bytes = _mm512_packs_epi16(_mm512_packs_epi32(e0, add(e0, right)), _mm512_packs_epi32(e2, add(e2, right)));
  return {_mm512_movepi8_mask(bytes), _mm512_testn_epi8_mask(bytes, bytes)};
}

/// Writes a word's pixels behind the list's end.
inline void append(const TileWord& word, int x0, int y0, int tile_log2, PixelList& list) {
  const I lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const I in_row = splat((1 << tile_log2) - 1), corner = splat(x0 | y0 << 16);
  auto end = static_cast<std::size_t>(list.count);
  for (int bit = 0; bit < 64; bit += 16) {
    const auto part = [&](std::uint64_t of) { return static_cast<__mmask16>(of >> bit); };
    const __mmask16 mask = part(word.mask);
    const I at = add(lane, splat(bit));
    const I place = add(corner, (at & in_row) | shift_left<16>(shift_right(at, tile_log2)));
    const I marks = flag<0>({part(word.front)}) | flag<8 + 4>({part(word.tie)});
    _mm512_storeu_si512(list.place.data() + end, _mm512_maskz_compress_epi32(mask, place));
    _mm512_storeu_si512(list.marks.data() + end, _mm512_maskz_compress_epi32(mask, marks));
    end += static_cast<std::size_t>(__builtin_popcount(mask));
  }
}
