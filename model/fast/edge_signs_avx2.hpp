// Signs of an edge function at the pixels of a tile, for float_cover.hpp, by AVX2.

/// Bits row * tile + dx of words where value + dx gx + row gy is below 0, and 0; `rows` and columns from `first_four`,
/// a multiple of 4, on.
inline void edge_signs(std::int64_t value, std::int64_t gx, std::int64_t gy, Range rows, int first_four, int to,
                       int tile, std::uint64_t* below, std::uint64_t* zero) {
  const int words = std::max(1, tile * tile / 64), rows_of_word = 64 / tile;
  const std::int64_t start = wrap_add(value, first_four * gx + rows.from * gy);
  const __m256i first = _mm256_add_epi64(_mm256_set1_epi64x(start), _mm256_set_epi64x(3 * gx, 2 * gx, gx, 0));
  const __m256i right = _mm256_set1_epi64x(4 * gx), down = _mm256_set1_epi64x(gy);
  const auto mask = [](__m256i v)
                        LANE_LAMBDA { return static_cast<std::uint64_t>(_mm256_movemask_pd(_mm256_castsi256_pd(v))); };
  const __m256i none = _mm256_setzero_si256();
  __m256i e = first, any_zero = none;
  for (int w = 0, row = rows.from; w < words; ++w) {
    std::uint64_t bits_below = 0;
    for (; row < std::min(rows.to, (w + 1) * rows_of_word); ++row, e = _mm256_add_epi64(e, down)) {
      __m256i at = e;
      for (int dx = first_four; dx < to; dx += 4, at = _mm256_add_epi64(at, right)) {
        bits_below |= mask(at) << ((row * tile + dx) & 63);
        any_zero = _mm256_or_si256(any_zero, _mm256_cmpeq_epi64(at, none));
      }
    }
    below[w] = bits_below;
  }
  if (_mm256_testz_si256(any_zero, any_zero) == 0) [[unlikely]] {
    e = first;
    for (int row = rows.from; row < rows.to; ++row, e = _mm256_add_epi64(e, down)) {
      __m256i at = e;
      for (int dx = first_four; dx < to; dx += 4, at = _mm256_add_epi64(at, right))
        zero[(row * tile) >> 6] |= mask(_mm256_cmpeq_epi64(at, none)) << ((row * tile + dx) & 63);
    }
  }
}

/// PlaceSigns.
std::uint64_t place_signs(std::int64_t value, std::int64_t right, std::int64_t down, int rows) {
  const __m256i four = _mm256_set1_epi64x(4 * right), next = _mm256_set1_epi64x(down);
  __m256i at = _mm256_add_epi64(_mm256_set1_epi64x(value), _mm256_set_epi64x(3 * right, 2 * right, right, 0));
  const auto mask = [](__m256i v)
                        LANE_LAMBDA { return static_cast<std::uint64_t>(_mm256_movemask_pd(_mm256_castsi256_pd(v))); };
  std::uint64_t word = 0;
  for (int bit = 0; bit < 8 * rows; bit += 8, at = _mm256_add_epi64(at, next))
    word |= (mask(at) | mask(_mm256_add_epi64(at, four)) << 4) << bit;
  return word;
}
