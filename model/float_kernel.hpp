// The code of float_lanes.cpp, included there once for each instruction set, inside a namespace of its own.
//
// Why the bits are the machine's (rtl/README.md section 2), with the unit rounding toward zero and what is too small
// for a normal number going to zero:
//  - A product of two S-bit numbers is cut to 24 bits by the unit, then to S by `cut`: the same as cutting it to S.
//  - fp_sum cuts each term at the quantum 2^(E - PREC_BITS), E the largest sum of two factors' exponents. C = 2^(E -
//    PREC_BITS + 23) has its last place there, and so has what is less than 2 C: C + term is the cut term above C, and
//    adding the next one cuts that one alone. A term is below 4 * 2^E, four of them are below 2^(PREC_BITS + 4) quanta,
//    and C is 2^23 of them: with S + align_guard_bits <= 20 (PREC_BITS <= 19) the sum stays below 2 C. Fused, the
//    product is not even rounded before. Taking C away is exact.
//  - Terms of either sign have a sum each, for truncation is of magnitudes; the difference of the two is exact.
//  - Tables: products of integers as floats, floor by adding 2^23; everything else there is an integer below 2^24.
//  - Numbers scale: D, A and r² of a quad times one power of 4 give M times a power of two, and quotients that are the
//    same. So the quad is drawn about one unit large, and root_ratio's `balanced` is left out.
//  - Range: u, v, r <= 4, M <= 2^12; S_i and their products are far from the smallest double. Products of three can
//    go below 2^-126 and become 0. Where the sums of M k and of M W are at least 2^-26, their E is at least -30, a term
//    with such an M is below 2^-126 * 2^6 * 2^30 = 2^-90 (numbers of the port are taken up to 2^30), and a quotient of
//    2^-30 or more, the last bit that an output can have, is of a sum with E >= -64: the term is below its quantum
//    2^-83 and is nothing there either. A smaller quotient is 0 in both. Lanes with a smaller sum are for the plain
//    pipeline.

using F = __m256;
using I = __m256i;

inline F splat(float v) { return _mm256_set1_ps(v); }
inline I splat(std::int32_t v) { return _mm256_set1_epi32(v); }
inline F real(I v) { return _mm256_castsi256_ps(v); }
inline I bits(F v) { return _mm256_castps_si256(v); }
inline F select(F by_sign, F a, F b) { return _mm256_blendv_ps(b, a, by_sign); }
inline unsigned sign_mask(F v) { return static_cast<unsigned>(_mm256_movemask_ps(v)); }
inline unsigned sign_mask(I v) { return sign_mask(real(v)); }

/// The functions of two vertices at four pixels.
struct DoubleLanes {
  __m256d x[4], y[4];  ///< S_i

  DoubleLanes(const FloatQuad& quad, __m128i px, __m128i py) {
    const __m256d unit = _mm256_set1_pd(quad.unit);
    const __m256d dx = _mm256_cvtepi32_pd(px), dy = _mm256_cvtepi32_pd(py);
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = _mm256_fnmadd_pd(dx, unit, _mm256_set1_pd(quad.x[i]));
      y[i] = _mm256_fnmadd_pd(dy, unit, _mm256_set1_pd(quad.y[i]));
    }
  }
  // The first sum with +0 keeps a zero from being -0.
  __m256d cross(std::size_t i, std::size_t j) const {
    return _mm256_fnmadd_pd(y[i], x[j], _mm256_fmadd_pd(x[i], y[j], _mm256_setzero_pd()));
  }
  __m256d dot(std::size_t i, std::size_t j) const {
    return _mm256_fmadd_pd(y[i], y[j], _mm256_fmadd_pd(x[i], x[j], _mm256_setzero_pd()));
  }
};

/// The upper halves of doubles: sign, exponent, 20 bits of the significand. As drawn the exponent's code is a float's.
inline I upper_halves(__m256d a, __m256d b) {
  return bits(_mm256_shuffle_ps(_mm256_castpd_ps(a), _mm256_castpd_ps(b), 0xdd));
}

/// Places of a table for eight arguments, by columns. `offset` is in bytes.
struct Coefficients {
  F c0, c1, c2;

  Coefficients(const FloatTable& table, I offset) {
    const __m128i low = _mm256_castsi256_si128(offset), high = _mm256_extracti128_si256(offset, 1);
    const auto* entries = reinterpret_cast<const std::uint8_t*>(table.entries.data());
    const auto place = [&](std::uint64_t at) {
      return _mm_load_ps(reinterpret_cast<const float*>(entries + static_cast<std::uint32_t>(at)));
    };
    const auto pair = [](__m128 a, __m128 b) { return _mm256_insertf128_ps(_mm256_castps128_ps256(a), b, 1); };
    // Two offsets at a time out of the vector.
    const auto at01 = static_cast<std::uint64_t>(_mm_cvtsi128_si64(low));
    const auto at23 = static_cast<std::uint64_t>(_mm_extract_epi64(low, 1));
    const auto at45 = static_cast<std::uint64_t>(_mm_cvtsi128_si64(high));
    const auto at67 = static_cast<std::uint64_t>(_mm_extract_epi64(high, 1));
    const F p0 = pair(place(at01), place(at45)), p1 = pair(place(at01 >> 32), place(at45 >> 32));
    const F p2 = pair(place(at23), place(at67)), p3 = pair(place(at23 >> 32), place(at67 >> 32));
    const F low01 = _mm256_unpacklo_ps(p0, p1), low23 = _mm256_unpacklo_ps(p2, p3);
    c0 = _mm256_shuffle_ps(low01, low23, 0x44);
    c1 = _mm256_shuffle_ps(low01, low23, 0xee);
    c2 = _mm256_shuffle_ps(_mm256_unpackhi_ps(p0, p1), _mm256_unpackhi_ps(p2, p3), 0x44);
  }
};

struct Arithmetic {
  F cut_mask, integer = splat(0x1p23f);
  F lowest, highest;  ///< a table's result with its guard bits

  explicit Arithmetic(int s)
      : cut_mask(real(splat(static_cast<std::int32_t>(-(1 << (24 - s)))))),
        lowest(splat(static_cast<float>(1 << (s - 1 + Config::table_guard)))),
        highest(splat(static_cast<float>((1 << (s + Config::table_guard)) - 1))) {}

  F cut(F v) const { return _mm256_and_ps(v, cut_mask); }
  F multiply(F a, F b) const { return cut(a * b); }
  /// 2^floor(log2 v), 0 of 0.
  static F power(F v) { return _mm256_and_ps(v, real(splat(0x7f800000))); }

  /// table_polynomial of the argument's fraction, in units of the table's guard bits, cut.
  F polynomial(F a, const FloatTable& table, bool rising) const {
    const Coefficients c(table, _mm256_and_si256(_mm256_srl_epi32(bits(a), _mm_cvtsi32_si128(19 - table.segments_log2)),
                                                 splat(static_cast<std::int32_t>(table.offset_mask))));
    // dx / 2^rest_bits: the fraction's bits below the segment, as a fraction.
    const I rest = _mm256_and_si256(_mm256_sll_epi32(bits(a), _mm_cvtsi32_si128(table.segments_log2)), splat(0x7fffff));
    const F dx = real(_mm256_or_si256(rest, splat(0x3f800000))) - splat(1.0f);
    const F t1 = c.c1 - _mm256_fmadd_ps(c.c2, dx, integer);
    const F y = rising ? _mm256_fmadd_ps(t1, dx, c.c0) - integer : c.c0 - _mm256_fmadd_ps(t1, dx, integer);
    return cut(_mm256_min_ps(_mm256_max_ps(y, lowest), highest));
  }
};

struct Root {
  F root, power;  ///< of the root
};

inline Root sqrt_lanes(F a, const FloatTable& table, const Arithmetic& arithmetic, int s) {
  // The code E + 127 of an exponent, halved: floor(E / 2) + 64.
  const I half = _mm256_and_si256(_mm256_srli_epi32(_mm256_add_epi32(bits(a), splat(1 << 23)), 1), splat(0x7f800000));
  const F y = arithmetic.polynomial(a, table, true);
  const int of_y = s - 1 + Config::table_guard;  // exponent of the polynomial's result
  return {real(_mm256_add_epi32(bits(y), _mm256_add_epi32(half, splat(-(64 + of_y) * (1 << 23))))),
          real(_mm256_add_epi32(half, splat((127 - 64) << 23)))};
}

/// Of a > 0 below 2^126: -E - 1 is the exponent of the table's result, -E of a power of two.
inline F recip_lanes(F a, const FloatTable& table, const Arithmetic& arithmetic, int s) {
  const I exponent = bits(Arithmetic::power(a));
  const F y = arithmetic.polynomial(a, table, false);
  const int of_y = s - 1 + Config::table_guard;
  const I regular = _mm256_add_epi32(bits(y), _mm256_sub_epi32(splat((127 - 1 - of_y) * (1 << 23)), exponent));
  const I exact = _mm256_sub_epi32(splat(254 << 23), exponent);  // of a power of two
  return real(_mm256_blendv_epi8(regular, exact, _mm256_cmpeq_epi32(bits(a), exponent)));
}

/// |num * rec| in units of 2^-frac, toward zero: below 2^31. The product's first 24 bits, and what they left, which
/// counts when they do not reach down to the unit.
inline I to_fixed(F num, F rec, F p, F scale, bool long_one) {
  I q = _mm256_cvttps_epi32(p * scale);
  if (long_one) q = _mm256_add_epi32(q, _mm256_cvttps_epi32(_mm256_fmsub_ps(num, rec, p) * scale));
  return q;
}

/// The whole list; MXCSR is as it must be.
__attribute__((noinline)) void draw(const FloatLanes::Format& format, const FloatQuad& quad, const PixelList& list,
                                    int count, FloatResults& out) {
  const int s = format.s;
  const Arithmetic arithmetic(s);
  const F zero = _mm256_setzero_ps();
  const F align = splat(static_cast<float>(1 << (23 - format.prec)));
  const F magnitude_mask = real(splat(0x7fffffff));
  const F attribute_scale = splat(static_cast<float>(1 << format.attribute_frac));
  const F attribute_limit = splat(static_cast<float>(1 << format.attribute_int_bits));
  const bool long_attribute = format.attribute_int_bits + format.attribute_frac > 24;
  const I attribute_most =
      splat(static_cast<std::int32_t>((std::int64_t{1} << (format.attribute_int_bits + format.attribute_frac)) - 1));
  const F depth_scale = splat(static_cast<float>(1 << format.depth_bits));
  const I depth_most = splat(static_cast<std::int32_t>((std::int64_t{2} << format.depth_bits) - 1));
  const I corner_at = splat(quad.x0 | quad.y0 << 16), id = splat(static_cast<std::int32_t>(quad.id));

  for (int begin = 0; begin < count; begin += lane_count) {
    const auto at = static_cast<std::size_t>(begin);
    const auto load = [at](const std::uint16_t* column) {
      return _mm256_cvtepu16_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(column + at)));
    };
    const I px = load(list.x.data()), py = load(list.y.data());

    // Pixels 0 1 4 5 and 2 3 6 7: taking upper halves puts them in order.
    const I qx = _mm256_permute4x64_epi64(px, 0xd8), qy = _mm256_permute4x64_epi64(py, 0xd8);
    const DoubleLanes d0(quad, _mm256_castsi256_si128(qx), _mm256_castsi256_si128(qy));
    const DoubleLanes d1(quad, _mm256_extracti128_si256(qx, 1), _mm256_extracti128_si256(qy, 1));
    F sign_a[6], sign_d[6], v[6], d[6], r2[4];
    const auto magnitude = [&](I h) { return arithmetic.cut(real(_mm256_slli_epi32(h, 3))); };
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = vertex_pair[k];
      const I a = upper_halves(d0.cross(i, j), d1.cross(i, j)), dot = upper_halves(d0.dot(i, j), d1.dot(i, j));
      sign_a[k] = real(a);
      sign_d[k] = real(dot);
      v[k] = magnitude(a);
      d[k] = magnitude(dot);
    }
    for (std::size_t i = 0; i < 4; ++i) r2[i] = magnitude(upper_halves(d0.dot(i, i), d1.dot(i, i)));

    // Singular pixels and edges are rare: something is 0.
    F least = _mm256_min_ps(_mm256_min_ps(v[0], v[1]), _mm256_min_ps(v[2], v[3]));
    least = _mm256_min_ps(least, _mm256_min_ps(_mm256_min_ps(r2[0], r2[1]), _mm256_min_ps(r2[2], r2[3])));
    unsigned singular = 0;
    I flags = _mm256_setzero_si256();
    F notch;
    if (sign_mask(_mm256_cmp_ps(least, zero, _CMP_EQ_OQ)) == 0) [[likely]] {
      const F any = _mm256_or_ps(_mm256_or_ps(sign_a[0], sign_a[1]), _mm256_or_ps(sign_a[2], sign_a[3]));
      const F all = _mm256_and_ps(_mm256_and_ps(sign_a[0], sign_a[1]), _mm256_and_ps(sign_a[2], sign_a[3]));
      notch = _mm256_andnot_ps(all, any);
    } else {
      F corner = zero, one = zero, two = zero;
      notch = zero;
      const auto is_zero = [zero](F value) { return _mm256_cmp_ps(value, zero, _CMP_EQ_OQ); };
      for (std::size_t k = 0; k < 4; ++k) {
        corner = _mm256_or_ps(corner, is_zero(r2[k]));
        const F on = _mm256_and_ps(is_zero(v[k]), sign_d[k]);
        two = _mm256_or_ps(two, _mm256_and_ps(one, on));
        one = _mm256_or_ps(one, on);
        const std::size_t before = (k + 3) % 4;
        notch = _mm256_or_ps(notch, _mm256_andnot_ps(_mm256_or_ps(is_zero(v[before]), is_zero(v[k])),
                                                     _mm256_xor_ps(sign_a[before], sign_a[k])));
      }
      singular = sign_mask(corner) | sign_mask(two);
      const F on_edge = _mm256_andnot_ps(_mm256_or_ps(corner, two), one);
      notch = _mm256_andnot_ps(_mm256_or_ps(corner, two), notch);
      flags = _mm256_slli_epi32(_mm256_srli_epi32(bits(on_edge), 31), 8);
    }
    if (format.notch) flags = _mm256_or_si256(flags, _mm256_slli_epi32(_mm256_srli_epi32(bits(notch), 31), 8 + 6));

    // u = r r' + |D|.
    Root r[4];
    for (std::size_t i = 0; i < 4; ++i) r[i] = sqrt_lanes(r2[i], format.sqrt, arithmetic, s);
    F u[6];
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = vertex_pair[k];
      const F c = _mm256_max_ps(r[i].power * r[j].power, Arithmetic::power(d[k])) * align;
      u[k] = arithmetic.cut(_mm256_fmadd_ps(r[i].root, r[j].root, c) + d[k] - c);
    }

    // root_ratio.hpp; a term of an edge cancels where D < 0, of a diagonal where D >= 0.
    struct Ratio {
      F num, den;
    };
    const auto ratio = [&](std::size_t near, std::size_t far, bool diagonal) {
      const F near_sign = sign_d[near], far_sign = sign_d[far];
      const auto choose = [diagonal](F sign, F cancels, F regular) {
        return diagonal ? select(sign, regular, cancels) : select(sign, cancels, regular);
      };
      const F root = sqrt_lanes(arithmetic.multiply(u[near], u[far]), format.sqrt, arithmetic, s).root;
      const F crossed = arithmetic.multiply(v[far], u[near]), scaled = arithmetic.multiply(v[near], root);
      return Ratio{choose(near_sign, choose(far_sign, crossed, root), choose(far_sign, v[far], u[far])),
                   choose(near_sign, choose(far_sign, scaled, v[near]), root)};
    };
    const Ratio a = ratio(0, 2, false), b = ratio(3, 1, false), e = ratio(4, 5, true);
    const F m[4] = {arithmetic.multiply(arithmetic.multiply(a.num, b.num), e.num),
                    arithmetic.multiply(arithmetic.multiply(a.num, b.den), e.den),
                    arithmetic.multiply(arithmetic.multiply(a.den, b.den), e.num),
                    arithmetic.multiply(arithmetic.multiply(a.den, b.num), e.den)};
    F power[4];
    for (std::size_t i = 0; i < 4; ++i) power[i] = Arithmetic::power(m[i]);

    const auto sum = [&](const FloatColumn& column) {
      const F c = _mm256_max_ps(_mm256_max_ps(power[0] * splat(column.align[0]), power[1] * splat(column.align[1])),
                                _mm256_max_ps(power[2] * splat(column.align[2]), power[3] * splat(column.align[3])));
      F positive = c;
      for (std::size_t i = 0; i < 4; ++i) positive = _mm256_fmadd_ps(m[i], splat(column.positive[i]), positive);
      F negative = c;
      if (column.mixed)
        for (std::size_t i = 0; i < 4; ++i) negative = _mm256_fmadd_ps(m[i], splat(column.negative[i]), negative);
      return arithmetic.cut(positive - negative);
    };
    F den_k = splat(1.0f), den_w = splat(1.0f), rec_k = splat(1.0f), rec_w;
    if (quad.sum_k) {
      den_k = sum(quad.k);
      rec_k = recip_lanes(den_k, format.recip, arithmetic, s);
    }
    if (quad.w_of_k)
      den_w = den_k * splat(static_cast<float>(*quad.w_of_k));
    else if (quad.sum_w)
      den_w = sum(quad.w);
    const unsigned small = sign_mask(_mm256_cmp_ps(_mm256_min_ps(den_k, den_w), splat(0x1p-26f), _CMP_NGE_UQ));

    I attribute[max_attribute_slots];
    for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j) {
      const F num = quad.b_of_k[j] ? den_k * splat(static_cast<float>(*quad.b_of_k[j])) : sum(quad.b[j]);
      const F p = num * rec_k;
      I q = to_fixed(num, rec_k, p, attribute_scale, long_attribute);
      const F over = _mm256_cmp_ps(_mm256_and_ps(p, magnitude_mask), attribute_limit, _CMP_GE_OQ);
      if (sign_mask(over) != 0) [[unlikely]] {
        const I most = _mm256_blendv_epi8(attribute_most, _mm256_sub_epi32(_mm256_setzero_si256(), attribute_most),
                                          _mm256_srai_epi32(bits(p), 31));
        q = _mm256_blendv_epi8(q, most, bits(over));
        flags = _mm256_or_si256(flags, _mm256_slli_epi32(_mm256_srli_epi32(bits(over), 31), 8 + 7));
      }
      attribute[j] = q;
    }

    unsigned discard = 0;
    I depth = _mm256_setzero_si256();
    if (format.depth) {
      rec_w = quad.w_of_k ? rec_k * splat(static_cast<float>(1 / *quad.w_of_k))
                          : recip_lanes(den_w, format.recip, arithmetic, s);
      const F num = quad.z_of_w ? den_w * splat(static_cast<float>(*quad.z_of_w)) : sum(quad.z);
      const F size = _mm256_and_ps(num, magnitude_mask);
      const F p = size * rec_w;
      depth = to_fixed(size, rec_w, p, depth_scale, true);
      depth = _mm256_blendv_epi8(depth, depth_most, bits(_mm256_cmp_ps(p, splat(2.0f), _CMP_GE_OQ)));
      const I negative = _mm256_andnot_si256(_mm256_cmpeq_epi32(depth, _mm256_setzero_si256()), bits(num));
      discard = sign_mask(_mm256_or_si256(negative, _mm256_or_si256(_mm256_cmpgt_epi32(splat(format.znear), depth),
                                                                    _mm256_cmpgt_epi32(depth, splat(format.zfar)))));
    }

    const unsigned used = count - begin >= lane_count ? 0xffu : (1u << (count - begin)) - 1;
    const unsigned plain = (singular | small) & used, counted = used & ~plain;
    const std::size_t block = at / lane_count;
    out.plain[block] = static_cast<std::uint8_t>(plain);
    out.drawn[block] = static_cast<std::uint8_t>(used & ~discard);
    out.any_plain |= plain != 0;
    out.all_drawn &= (discard & used) == 0;
    const auto tally = [&](int flag) {
      return static_cast<std::uint64_t>(
          __builtin_popcount(sign_mask(_mm256_sll_epi32(flags, _mm_cvtsi32_si128(31 - 8 - flag))) & counted));
    };
    out.on_edge += tally(0);
    out.notch += tally(6);
    out.saturated += tally(7);

    // Fragments: four words before the attributes, two attributes at a time behind them.
    static_assert(offsetof(Fragment, quad) == 0 && offsetof(Fragment, x) == 4 && offsetof(Fragment, y) == 6 &&
                  offsetof(Fragment, front) == 8 && offsetof(Fragment, flags) == 9 && offsetof(Fragment, depth) == 12 &&
                  offsetof(Fragment, attribute) == 16 && sizeof(Fragment) == 16 + 8 * max_attribute_slots);
    auto* bytes = reinterpret_cast<std::uint8_t*>(&out.fragment[at]);
    const auto store = [bytes](I two, int lane, std::size_t offset) {
      std::uint8_t* to = bytes + static_cast<std::size_t>(lane) * sizeof(Fragment) + offset;
      _mm_store_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(two));
      _mm_store_si128(reinterpret_cast<__m128i*>(to + 4 * sizeof(Fragment)), _mm256_extracti128_si256(two, 1));
    };
    const I place = _mm256_add_epi32(_mm256_or_si256(px, _mm256_slli_epi32(py, 16)), corner_at);
    const I marks = _mm256_or_si256(load(list.marks.data()), flags);
    const I head01 = _mm256_unpacklo_epi32(id, place), head23 = _mm256_unpackhi_epi32(id, place);
    const I tail01 = _mm256_unpacklo_epi32(marks, depth), tail23 = _mm256_unpackhi_epi32(marks, depth);
    store(_mm256_unpacklo_epi64(head01, tail01), 0, 0);
    store(_mm256_unpackhi_epi64(head01, tail01), 1, 0);
    store(_mm256_unpacklo_epi64(head23, tail23), 2, 0);
    store(_mm256_unpackhi_epi64(head23, tail23), 3, 0);
    for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); j += 2) {
      const I a0 = attribute[j];
      const I a1 = j + 1 < static_cast<std::size_t>(format.attributes) ? attribute[j + 1] : _mm256_setzero_si256();
      const I s0 = _mm256_srai_epi32(a0, 31), s1 = _mm256_srai_epi32(a1, 31);
      const I low0 = _mm256_unpacklo_epi32(a0, s0), low1 = _mm256_unpacklo_epi32(a1, s1);
      const I high0 = _mm256_unpackhi_epi32(a0, s0), high1 = _mm256_unpackhi_epi32(a1, s1);
      const std::size_t offset = offsetof(Fragment, attribute) + 8 * j;
      store(_mm256_unpacklo_epi64(low0, low1), 0, offset);
      store(_mm256_unpackhi_epi64(low0, low1), 1, offset);
      store(_mm256_unpacklo_epi64(high0, high1), 2, offset);
      store(_mm256_unpackhi_epi64(high0, high1), 3, offset);
    }
  }
}

/// Rows and columns of a tile, from .. to - 1.
struct Range {
  int from, to;
};

/// stamp_coverage of a tile, of the rows and columns that the quad's corners reach.
inline void tile_masks(const FloatLanes::Format& format, const TileCorner& corner, const QuadConstants& quad,
                       Range rows, Range columns, TileMasks& out) {
  const int tile = 1 << format.tile_log2, words = std::max(1, tile * tile / 64);
  const std::uint64_t whole = tile == 4 ? 0xffffu : ~std::uint64_t{0};
  const int rows_of_word = 64 / tile, first_four = columns.from & ~3;
  std::uint64_t positive[5][TileMasks::words], negative[5][TileMasks::words], zeros[TileMasks::words] = {};
  for (std::size_t k = 0; k < 5; ++k) {
    const std::int64_t gx = quad.gx[k], gy = quad.gy[k], value = corner.linear[k];
    const std::int64_t sx = gx * (tile - 1), sy = gy * (tile - 1);
    const std::int64_t lo = wrap_add(value, std::min<std::int64_t>(sx, 0) + std::min<std::int64_t>(sy, 0));
    const std::int64_t hi = wrap_add(value, std::max<std::int64_t>(sx, 0) + std::max<std::int64_t>(sy, 0));
    if (lo > 0 || hi < 0) {  // one sign everywhere
      for (int w = 0; w < words; ++w) {
        positive[k][w] = lo > 0 ? whole : 0;
        negative[k][w] = lo > 0 ? 0 : whole;
      }
      continue;
    }
    std::uint64_t below[TileMasks::words], zero[TileMasks::words] = {};
    const std::int64_t start = wrap_add(value, first_four * gx + rows.from * gy);
    const __m256i first = _mm256_add_epi64(_mm256_set1_epi64x(start), _mm256_set_epi64x(3 * gx, 2 * gx, gx, 0));
    const __m256i right = _mm256_set1_epi64x(4 * gx), down = _mm256_set1_epi64x(gy);
    const auto mask = [](__m256i v) { return static_cast<std::uint64_t>(_mm256_movemask_pd(_mm256_castsi256_pd(v))); };
    const __m256i none = _mm256_setzero_si256();
    __m256i e = first, any_zero = none;
    for (int w = 0, row = rows.from; w < words; ++w) {
      std::uint64_t bits_below = 0;
      for (; row < std::min(rows.to, (w + 1) * rows_of_word); ++row, e = _mm256_add_epi64(e, down)) {
        __m256i at = e;
        for (int dx = first_four; dx < columns.to; dx += 4, at = _mm256_add_epi64(at, right)) {
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
        for (int dx = first_four; dx < columns.to; dx += 4, at = _mm256_add_epi64(at, right))
          zero[(row * tile) >> 6] |= mask(_mm256_cmpeq_epi64(at, none)) << ((row * tile + dx) & 63);
      }
    }
    const std::uint64_t tie_pos = quad.tie_pos[k] ? whole : 0, tie_neg = quad.tie_neg[k] ? whole : 0;
    for (int w = 0; w < words; ++w) {
      positive[k][w] = (whole & ~(below[w] | zero[w])) | (zero[w] & tie_pos);
      negative[k][w] = below[w] | (zero[w] & tie_neg);
      zeros[w] |= zero[w] & (tie_pos | tie_neg);  // an all-zero edge decides nothing
    }
  }

  // A one in the first place of every row of a word.
  const std::uint64_t every_row = tile == 4 ? 0x1111u : tile == 8 ? 0x0101010101010101u : 0x0001000100010001u;
  const std::uint64_t seen_columns =
      ((std::uint64_t{1} << columns.to) - (std::uint64_t{1} << columns.from)) * every_row;
  const auto below_bit = [](int bit) {
    return bit >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << std::max(bit, 0)) - 1;
  };
  for (int w = 0; w < words; ++w) {
    SignWords<std::uint64_t> signs[5];
    for (std::size_t k = 0; k < 5; ++k) signs[k] = {positive[k][w], negative[k][w]};
    const PlaceWords<std::uint64_t> inside = inside_expression(signs, quad.visible, format.cull);
    const std::uint64_t seen =
        seen_columns & below_bit(rows.to * tile - 64 * w) & ~below_bit(rows.from * tile - 64 * w);
    const auto word = static_cast<std::size_t>(w);
    out.mask[word] = (inside.back | inside.front) & seen;
    out.front[word] = inside.front & seen;
    out.tie[word] = zeros[w] & out.mask[word];
  }
}

FloatLanes::TileCounts cover(const FloatLanes::Format& format, const FloatQuad& bounds, const TileCorner& corner,
                             const QuadConstants& quad, PixelList& list) {
  FloatLanes::TileCounts counts;
  const int tile = 1 << format.tile_log2, chunk = std::min(tile, 8);
  const int x0 = (corner.tile_x << format.tile_log2) - bounds.x0, y0 = (corner.tile_y << format.tile_log2) - bounds.y0;
  const Range rows{std::max(bounds.top - y0, 0), std::min(bounds.bottom - y0, tile - 1) + 1};
  const Range columns{std::max(bounds.left - x0, 0), std::min(bounds.right - x0, tile - 1) + 1};
  if (rows.from >= rows.to || columns.from >= columns.to) return counts;
  TileMasks masks;
  tile_masks(format, corner, quad, rows, columns, masks);
  const unsigned all = (1u << chunk) - 1;
  for (int row = rows.from; row < rows.to; ++row) {
    bool any = false;
    for (int dx = 0; dx < tile; dx += chunk) {
      const int bit = row * tile + dx;
      const auto part = [&](const std::array<std::uint64_t, TileMasks::words>& words) {
        return static_cast<unsigned>(words[static_cast<std::size_t>(bit >> 6)] >> (bit & 63)) & all;
      };
      const unsigned mask = part(masks.mask);
      if (mask == 0) continue;
      any = true;
      const auto end = static_cast<std::size_t>(list.count);
      const auto put = [end](std::uint16_t* column, __m128i eight) {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(column + end), eight);
      };
      const auto bytes = [](std::uint64_t eight) {
        return _mm_cvtepu8_epi16(_mm_cvtsi64_si128(static_cast<std::int64_t>(eight)));
      };
      // The numbers of the mask's bits, one a byte; and a bit for each of those, one a byte.
      const std::uint64_t spread = _pdep_u64(mask, 0x0101010101010101) * 0xff;
      const auto bits_of = [&](unsigned word) { return _pdep_u64(_pext_u32(word, mask), 0x0101010101010101); };
      put(list.x.data(), _mm_add_epi16(bytes(_pext_u64(0x0706050403020100, spread)),
                                       _mm_set1_epi16(static_cast<std::int16_t>(x0 + dx))));
      put(list.y.data(), _mm_set1_epi16(static_cast<std::int16_t>(y0 + row)));
      const unsigned tie = part(masks.tie);
      __m128i marks = bytes(bits_of(part(masks.front)));
      if (tie != 0) marks = _mm_or_si128(marks, _mm_slli_epi16(bytes(bits_of(tie)), 8 + 4));
      put(list.marks.data(), marks);
      const int pixels = __builtin_popcount(mask);
      list.count += pixels;
      counts.pixels += pixels;
      counts.ties += __builtin_popcount(tie);
    }
    counts.stamps += any;
  }
  return counts;
}
