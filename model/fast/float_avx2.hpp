// Eight lanes of AVX2 for kernel.hpp, in single precision: float_avx512.hpp has the same names. Of a mask the sign bit
// of each lane counts.

constexpr int width = 8;
using F = __m256;
using I = __m256i;
using D = __m256d;  ///< half of the lanes

struct Mask {
  F sign;
};
inline Mask operator&(Mask a, Mask b) { return {_mm256_and_ps(a.sign, b.sign)}; }
inline Mask operator|(Mask a, Mask b) { return {_mm256_or_ps(a.sign, b.sign)}; }
inline Mask operator^(Mask a, Mask b) { return {_mm256_xor_ps(a.sign, b.sign)}; }
inline Mask without(Mask a, Mask b) { return {_mm256_andnot_ps(b.sign, a.sign)}; }

inline F splat(float v) { return _mm256_set1_ps(v); }
inline D splat(double v) { return _mm256_set1_pd(v); }
inline I splat(std::int32_t v) { return _mm256_set1_epi32(v); }
inline F real(I v) { return _mm256_castsi256_ps(v); }
inline I bits(F v) { return _mm256_castps_si256(v); }
inline I load(const std::uint32_t* aligned) { return _mm256_load_si256(reinterpret_cast<const I*>(aligned)); }

inline F fma(F a, F b, F c) { return _mm256_fmadd_ps(a, b, c); }
inline D fma(D a, D b, D c) { return _mm256_fmadd_pd(a, b, c); }
constexpr bool fused = true;
inline F least(F a, F b) { return _mm256_min_ps(a, b); }
inline F greatest(F a, F b) { return _mm256_max_ps(a, b); }
inline D least(D a, D b) { return _mm256_min_pd(a, b); }
inline D greatest(D a, D b) { return _mm256_max_pd(a, b); }
inline I least(I a, I b) { return _mm256_min_epi32(a, b); }
inline I greatest(I a, I b) { return _mm256_max_epi32(a, b); }
inline F keep(F v, F mask) { return _mm256_and_ps(v, mask); }
inline F add(F a, F b) { return a + b; }
inline I add(I a, I b) { return _mm256_add_epi32(a, b); }
inline I subtract(I a, I b) { return _mm256_sub_epi32(a, b); }
template <int places>
I shift_left(I v) {
  return _mm256_slli_epi32(v, places);
}
template <int places>
I shift_right(I v) {
  return _mm256_srli_epi32(v, places);
}
inline I shift_right(I v, int places) { return _mm256_srl_epi32(v, _mm_cvtsi32_si128(places)); }
/// Half of a magnitude; 0 of 0.
inline F half(F v) { return real(_mm256_subs_epu16(bits(v), splat(1 << 23))); }
inline F converted(I v) { return _mm256_cvtepi32_ps(v); }
inline D toward_zero(D v) { return _mm256_round_pd(v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC); }
inline I truncated(F v) { return _mm256_cvttps_epi32(v); }

inline Mask sign(I v) { return {real(v)}; }
inline Mask equal(F a, F b) { return {_mm256_cmp_ps(a, b, _CMP_EQ_OQ)}; }
inline Mask at_least(F a, F b) { return {_mm256_cmp_ps(a, b, _CMP_GE_OQ)}; }
inline Mask not_at_least(F a, F b) { return {_mm256_cmp_ps(a, b, _CMP_NGE_UQ)}; }
inline Mask equal(I a, I b) { return {real(_mm256_cmpeq_epi32(a, b))}; }
inline Mask greater(I a, I b) { return {real(_mm256_cmpgt_epi32(a, b))}; }
inline Mask no_lane() { return {_mm256_setzero_ps()}; }
/// Bit l is lane l.
inline unsigned lanes(Mask m) { return static_cast<unsigned>(_mm256_movemask_ps(m.sign)); }
inline bool none(Mask m) { return lanes(m) == 0; }
inline F select(Mask m, F a, F b) { return _mm256_blendv_ps(b, a, m.sign); }
inline I select(Mask m, I a, I b) { return bits(select(m, real(a), real(b))); }
/// That bit in the lanes of the mask.
template <int bit>
I flag(Mask m) {
  return shift_left<bit>(shift_right<31>(bits(m.sign)));
}

/// Lanes 0 1 4 5 and 2 3 6 7: upper_halves puts them in order.
struct Halves {
  D a, b;
};
inline Halves to_doubles(I v) {
  const I order = _mm256_permute4x64_epi64(v, 0xd8);
  return {_mm256_cvtepi32_pd(_mm256_castsi256_si128(order)), _mm256_cvtepi32_pd(_mm256_extracti128_si256(order, 1))};
}
/// The upper 32 bits of doubles: sign, exponent, 20 bits of the significand.
inline I upper_halves(D a, D b) { return bits(_mm256_shuffle_ps(_mm256_castpd_ps(a), _mm256_castpd_ps(b), 0xdd)); }

/// The lanes one after the other.
struct Doubles {
  D low, high;
};
inline Doubles widened(F v) {
  return {_mm256_cvtps_pd(_mm256_castps256_ps128(v)), _mm256_cvtps_pd(_mm256_extractf128_ps(v, 1))};
}
/// What has no place in 32 bits becomes the least integer.
inline I truncated(Doubles v) { return _mm256_setr_m128i(_mm256_cvttpd_epi32(v.low), _mm256_cvttpd_epi32(v.high)); }

/// Places of a table for each lane.
struct Coefficients {
  F c0, c1, c2;
};
/// No permutation reaches so far.
constexpr bool looks_up_columns = false;

/// `a` says which.
inline Coefficients look_up(const LaneTableOf<float>& table, F a) {
  const I offset =
      shift_right(bits(a), table.rest_bits - 4) & splat(static_cast<std::int32_t>(table.offset_mask));  // in bytes
  const __m128i low = _mm256_castsi256_si128(offset), high = _mm256_extracti128_si256(offset, 1);
  const auto* entries = reinterpret_cast<const std::uint8_t*>(table.entries.data());
  const auto place = [&](std::uint64_t at) {
    return _mm_load_ps(reinterpret_cast<const float*>(entries + static_cast<std::uint32_t>(at)));
  };
  const auto pair = [](__m128 p, __m128 q) { return _mm256_insertf128_ps(_mm256_castps128_ps256(p), q, 1); };
  // Two offsets at a time out of the vector.
  const auto at01 = static_cast<std::uint64_t>(_mm_cvtsi128_si64(low));
  const auto at23 = static_cast<std::uint64_t>(_mm_extract_epi64(low, 1));
  const auto at45 = static_cast<std::uint64_t>(_mm_cvtsi128_si64(high));
  const auto at67 = static_cast<std::uint64_t>(_mm_extract_epi64(high, 1));
  const F p0 = pair(place(at01), place(at45)), p1 = pair(place(at01 >> 32), place(at45 >> 32));
  const F p2 = pair(place(at23), place(at67)), p3 = pair(place(at23 >> 32), place(at67 >> 32));
  const F low01 = _mm256_unpacklo_ps(p0, p1), low23 = _mm256_unpacklo_ps(p2, p3);
  return {_mm256_shuffle_ps(low01, low23, 0x44), _mm256_shuffle_ps(low01, low23, 0xee),
          _mm256_shuffle_ps(_mm256_unpackhi_ps(p0, p1), _mm256_unpackhi_ps(p2, p3), 0x44)};
}

/// Lanes one after the other.
inline void store(std::uint32_t* to, I v) { _mm256_storeu_si256(reinterpret_cast<I*>(to), v); }
/// Of numbers below 2^16.
inline void store_lower_halves(std::uint16_t* to, I v) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to),
                   _mm_packus_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1)));
}
/// With their signs.
inline void store_widened(std::int64_t* to, I v) {
  _mm256_storeu_si256(reinterpret_cast<I*>(to), _mm256_cvtepi32_epi64(_mm256_castsi256_si128(v)));
  _mm256_storeu_si256(reinterpret_cast<I*>(to + 4), _mm256_cvtepi32_epi64(_mm256_extracti128_si256(v, 1)));
}

/// Signs of value + dx gx + dy gy at the pixels of a tile of 8 by 8, bit 8 row + dx.
struct TileSigns {
  std::uint64_t negative, zero;
};
inline TileSigns tile_signs(int value, int gx, int gy) {
  // Packing takes four vectors to one of bytes, signs and zeros unchanged; byte 16 l + 4 q + i is of vector q, there of
  // place 4 l + i.
  const I dx = splat(gx), right = splat(4 * gx);
  const I columns = _mm256_mullo_epi32(dx, _mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3));
  TileSigns signs{0, 0};
  for (int rows = 0; rows < 8; rows += 4) {
    const I start = _mm256_setr_m128i(_mm_set1_epi32(value + rows * gy), _mm_set1_epi32(value + (rows + 2) * gy));
    const I e0 = add(columns, start), e2 = add(e0, splat(gy));
    const I bytes = _mm256_packs_epi16(_mm256_packs_epi32(e0, add(e0, right)), _mm256_packs_epi32(e2, add(e2, right)));
    const auto mask = [rows](I v) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(_mm256_movemask_epi8(v))) << 8 * rows;
    };
    signs.negative |= mask(bytes);
    signs.zero |= mask(_mm256_cmpeq_epi8(bytes, _mm256_setzero_si256()));
  }
  return signs;
}

/// Writes a word's pixels behind the list's end.
inline void append(const TileWord& word, int x0, int y0, int tile_log2, PixelList& list) {
  const int tile = 1 << tile_log2, chunk = std::min(tile, 8);
  auto end = static_cast<std::size_t>(list.count);
  for (int bit = 0; bit < 64; bit += chunk) {
    const auto part = [&](std::uint64_t of) { return static_cast<unsigned>(of >> bit) & ((1u << chunk) - 1); };
    const unsigned mask = part(word.mask);
    if (mask == 0) continue;
    const auto put = [end](std::uint32_t* column, I eight) {
      _mm256_storeu_si256(reinterpret_cast<I*>(column + end), eight);
    };
    const auto words = [](std::uint64_t eight_bytes) {
      return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<std::int64_t>(eight_bytes)));
    };
    // The numbers of the mask's bits, one a byte; and a bit for each of those, one a byte.
    const std::uint64_t spread = _pdep_u64(mask, 0x0101010101010101) * 0xff;
    const auto bits_of = [&](unsigned some) { return _pdep_u64(_pext_u32(some, mask), 0x0101010101010101); };
    const int place = (x0 + (bit & (tile - 1))) | (y0 + (bit >> tile_log2)) << 16;
    put(list.place.data(), add(words(_pext_u64(0x0706050403020100, spread)), splat(place)));
    const unsigned tie = part(word.tie);
    I marks = words(bits_of(part(word.front)));
    if (tie != 0) marks = marks | shift_left<8 + 4>(words(bits_of(tie)));
    put(list.marks.data(), marks);
    end += static_cast<std::size_t>(__builtin_popcount(mask));
  }
}
