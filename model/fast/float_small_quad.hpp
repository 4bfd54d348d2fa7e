// Setup and walk of small quads (SmallQuad), for float_lanes.cpp, which includes this once for each instruction set
// behind float_cover.hpp. The four vertices are the lanes. What quad_setup, quad_reject and tile_walk do, for quads so
// small that 32 bits hold their functions; everything in double is an exact integer, or one times a power of two.

/// Four numbers of the port, `place` bytes from the begin of each vertex, as a column; false when one does not fit.
inline bool port_column(const FloatLanes::Format& format, const SnappedQuad& quad, std::size_t place,
                        FloatColumnOf what, LaneColumnOf<float>& out) {
  // Vertex by vertex {what is before it, neg, exp, sig}: behind the last number of the last vertex there is nothing.
  static_assert(sizeof(PortNumber) == 12 && offsetof(PortNumber, neg) == 0 && offsetof(PortNumber, exp) == 4 &&
                offsetof(PortNumber, sig) == 8 && offsetof(SnappedVertex, k) >= 4);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(quad.vertex.data()) + (place - 4);
  const auto vertex = [bytes](std::size_t i) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + i * sizeof(SnappedVertex)));
  };
  const __m128i v0 = vertex(0), v1 = vertex(1), v2 = vertex(2), v3 = vertex(3);
  const __m128i high01 = _mm_unpackhi_epi32(v0, v1), high23 = _mm_unpackhi_epi32(v2, v3);
  const __m128i exponent = _mm_unpacklo_epi64(high01, high23), sig = _mm_unpackhi_epi64(high01, high23);
  const __m128i neg =
      _mm_and_si128(_mm_unpackhi_epi64(_mm_unpacklo_epi32(v0, v1), _mm_unpacklo_epi32(v2, v3)), _mm_set1_epi32(0xff));
  const __m128i tiny =
      _mm_cmpgt_epi32(_mm_set1_epi32(what == FloatColumnOf::weight ? -largest_exponent : least_difference), exponent);
  __m128i none = _mm_cmpeq_epi32(sig, _mm_setzero_si128());
  if (what == FloatColumnOf::attribute) none = _mm_or_si128(none, _mm_setr_epi32(-1, 0, 0, 0));
  __m128i beyond = _mm_cmpgt_epi32(exponent, _mm_set1_epi32(largest_exponent));
  if (what == FloatColumnOf::weight)
    beyond = _mm_or_si128(beyond, tiny);
  else
    none = _mm_or_si128(none, tiny);
  if (_mm_testc_si128(none, beyond) == 0) return false;
  const auto with_code = [none](__m128i fraction, __m128i code) {
    return _mm_castsi128_ps(_mm_andnot_si128(none, _mm_add_epi32(fraction, _mm_slli_epi32(code, 23))));
  };
  const __m128 size =
      with_code(_mm_castps_si128(_mm_cvtepi32_ps(sig)), _mm_sub_epi32(exponent, _mm_set1_epi32(format.s - 1)));
  __m128 negative = _mm_castsi128_ps(_mm_andnot_si128(none, _mm_cmpgt_epi32(neg, _mm_setzero_si128())));
  const int minus = _mm_movemask_ps(negative), some = ~_mm_movemask_ps(_mm_castsi128_ps(none)) & 15;
  out.any = some != 0;
  out.mixed = minus != 0 && minus != some;
  out.flip = minus != 0 && !out.mixed ? INT32_MIN : 0;
  if (!out.mixed) negative = _mm_setzero_ps();
  _mm_storeu_ps(out.positive.data(), _mm_andnot_ps(negative, size));
  _mm_storeu_ps(out.negative.data(), _mm_and_ps(negative, size));
  _mm_storeu_ps(out.align.data(),
                with_code(_mm_setzero_si128(), _mm_add_epi32(exponent, _mm_set1_epi32(23 - format.prec + 127))));
  return true;
}

/// The numbers of a small quad, all four w being 1.
inline bool small_columns(const FloatLanes::Format& format, const SnappedQuad& quad, FloatQuad& out) {
  using Of = FloatColumnOf;
  bool fit = float_codes(format, quad.base, out);
  out.sum_z = false;
  if (format.depth && quad.base.depth_low != quad.base.depth_high) {
    fit = fit && port_column(format, quad, offsetof(SnappedVertex, z), Of::depth, out.z);
    out.sum_z = out.z.any;
  }
  out.sum_k = false;
  for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j) {
    fit = fit && port_column(format, quad, offsetof(SnappedVertex, attribute) + j * sizeof(PortNumber), Of::attribute,
                             out.b[j]);
    out.sum_b[j] = out.b[j].any;
    out.sum_k |= out.sum_b[j];
  }
  out.sum_w = out.sum_z;
  LaneColumnOf<float> ones;
  ones.positive.fill(1);
  ones.align.fill(static_cast<float>(1 << (23 - format.prec)));
  out.w = ones;
  out.k = ones;
  if (format.perspective && out.sum_k)
    fit = fit && port_column(format, quad, offsetof(SnappedVertex, k), Of::weight, out.k);
  const float k0 = out.k.positive[0];
  const bool same_k = k0 == out.k.positive[1] && k0 == out.k.positive[2] && k0 == out.k.positive[3] &&
                      (std::bit_cast<std::uint32_t>(k0) & 0x7fffff) == 0;
  out.w_of_k = out.sum_k && out.sum_w && same_k ? QuadLanes::Factor(1 / k0) : std::nullopt;
  return fit;
}

/// FloatLanes::take_small.
std::optional<QuadReject> take_small(const FloatLanes::Format& format, const DepthLimits& depth_limits,
                                     const SnappedQuad& quad, FloatQuad& out, SmallQuad& small) {
  const auto vertex = [&](std::size_t i) {
    static_assert(offsetof(SnappedVertex, x) == 0 && offsetof(SnappedVertex, y) == 4 &&
                  offsetof(SnappedVertex, w) == 8);
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(&quad.vertex[i]));
  };
  const __m128i v0 = vertex(0), v1 = vertex(1), v2 = vertex(2), v3 = vertex(3);
  const __m128i xy01 = _mm_unpacklo_epi32(v0, v1), xy23 = _mm_unpacklo_epi32(v2, v3);
  const __m128i x = _mm_unpacklo_epi64(xy01, xy23), y = _mm_unpackhi_epi64(xy01, xy23);
  const __m128i w = _mm_unpacklo_epi64(_mm_unpackhi_epi32(v0, v1), _mm_unpackhi_epi32(v2, v3));
  const __m128i between = _mm_set1_epi32((1 << format.homogeneous_frac_bits) - 1);
  if (_mm_movemask_epi8(_mm_cmpeq_epi32(w, _mm_set1_epi32(1 << format.frac))) != 0xffff ||
      _mm_testz_si128(_mm_or_si128(x, y), between) == 0)
    return std::nullopt;

  // In units of 2^-subpixel_bits.
  const __m128i lift = _mm_cvtsi32_si128(format.homogeneous_frac_bits);
  const __m128i gx = _mm_sra_epi32(x, lift), gy = _mm_sra_epi32(y, lift);
  const auto across = [](__m128i v, auto&& of) {
    const __m128i two = of(v, _mm_shuffle_epi32(v, 0x4e));
    return _mm_cvtsi128_si32(of(two, _mm_shuffle_epi32(two, 0xb1)));
  };
  const auto low = [](__m128i a, __m128i b) { return _mm_min_epi32(a, b); };
  const auto high = [](__m128i a, __m128i b) { return _mm_max_epi32(a, b); };
  const int left = across(gx, low), right = across(gx, high), top = across(gy, low), bottom = across(gy, high);
  const int frac = format.subpixel_bits, pixel = 1 << frac;
  const auto first = [&](int v) { return (v + pixel - 1) >> frac; };
  const Range columns{std::max(first(left), format.scissor_x0), std::min(right >> frac, format.scissor_x1 - 1)};
  const Range rows{std::max(first(top), format.scissor_y0), std::min(bottom >> frac, format.scissor_y1 - 1)};
  if (columns.from > columns.to || rows.from > rows.to) return QuadReject::empty;
  const int extent = std::max(right - left, bottom - top);
  constexpr int tile_log2 = SmallQuad::tile_log2;
  const int tile_x0 = columns.from >> tile_log2, tile_y0 = rows.from >> tile_log2;
  small.tiles_x = (columns.to >> tile_log2) - tile_x0 + 1;
  small.tiles_y = (rows.to >> tile_log2) - tile_y0 + 1;
  if (extent > SmallQuad::largest * pixel || std::max(small.tiles_x, small.tiles_y) > Config::block_tiles)
    return std::nullopt;
  if (depth_limits.outside(quad.base)) return QuadReject::depth;

  // Around the first tile's origin pixel; E of 01 12 23 30, then of 20 and 13.
  out.x0 = tile_x0 << tile_log2;
  out.y0 = tile_y0 << tile_log2;
  const __m256d px = _mm256_cvtepi32_pd(_mm_sub_epi32(gx, _mm_set1_epi32(out.x0 * pixel)));
  const __m256d py = _mm256_cvtepi32_pd(_mm_sub_epi32(gy, _mm_set1_epi32(out.y0 * pixel)));
  const __m256d px_next = _mm256_permute4x64_pd(px, 0x39), py_next = _mm256_permute4x64_pd(py, 0x39);
  const auto across_from = [](__m256d v) { return _mm256_castpd256_pd128(_mm256_permute4x64_pd(v, 0x06)); };  // 2, 1
  const auto across_to = [](__m256d v) { return _mm256_castpd256_pd128(_mm256_permute4x64_pd(v, 0x0c)); };    // 0, 3
  const __m128d fx = across_from(px), fy = across_from(py), tx = across_to(px), ty = across_to(py);
  const __m256d side = _mm256_fmsub_pd(px, py_next, _mm256_mul_pd(py, px_next));
  const __m128d diagonal = _mm_fmsub_pd(fx, ty, _mm_mul_pd(fy, tx));
  const __m256d side_dx = _mm256_sub_pd(py, py_next), side_dy = _mm256_sub_pd(px_next, px);
  const __m128d diagonal_dx = _mm_sub_pd(fy, ty), diagonal_dy = _mm_sub_pd(tx, fx);

  alignas(32) std::array<double, 4> e;
  _mm256_store_pd(e.data(), side);
  const double e20 = _mm_cvtsd_f64(diagonal), d012 = e[0] + e[1] + e20, d023 = e[2] + e[3] - e20;
  const bool back = d012 > 0 || d023 > 0, front = d012 < 0 || d023 < 0;
  if (!back && !front) return QuadReject::line;
  if (!(back && format.cull != Cull::back) && !(front && format.cull != Cull::front)) return QuadReject::culled;

  const auto put = [&](std::array<std::int32_t, 8>& to, __m256d sides, __m128d diagonals, int scale) {
    const __m128i count = _mm_cvtsi32_si128(scale);
    const __m128i last = _mm_and_si128(_mm_cvttpd_epi32(diagonals), _mm_setr_epi32(-1, 0, 0, 0));  // without 13
    _mm256_store_si256(reinterpret_cast<__m256i*>(to.data()),
                       _mm256_setr_m128i(_mm_sll_epi32(_mm256_cvttpd_epi32(sides), count), _mm_sll_epi32(last, count)));
  };
  put(small.value, side, diagonal, 0);
  put(small.gx, side_dx, diagonal_dx, frac);
  put(small.gy, side_dy, diagonal_dy, frac);
  for (std::size_t k = 0; k < 5; ++k) {
    const int a = small.gx[k], b = small.gy[k];
    small.tie_positive[k] = a > 0 || (a == 0 && b > 0) ? ~std::uint64_t{0} : 0;
    small.tie_negative[k] = a < 0 || (a == 0 && b < 0) ? ~std::uint64_t{0} : 0;
  }

  // Less than 1 wide, as in take().
  const int scale = -(1023 - 127) / 2 - static_cast<int>(std::bit_width(static_cast<unsigned>(extent)));
  const double square = power_of_two(2 * scale), of_pixel = power_of_two(2 * scale + frac);
  out.unit2 = power_of_two(2 * (scale + frac));
  const auto store = [](std::array<double, linear_count>& to, __m256d sides, __m128d diagonals, double by) {
    _mm256_storeu_pd(to.data(), _mm256_mul_pd(sides, _mm256_set1_pd(by)));
    _mm_storeu_pd(to.data() + 4, _mm_mul_pd(diagonals, _mm_set1_pd(by)));
  };
  store(out.a.value, side, diagonal, square);
  store(out.a.gx, side_dx, diagonal_dx, of_pixel);
  store(out.a.gy, side_dy, diagonal_dy, of_pixel);
  store(out.length2, _mm256_fmadd_pd(side_dx, side_dx, _mm256_mul_pd(side_dy, side_dy)),
        _mm_fmadd_pd(diagonal_dx, diagonal_dx, _mm_mul_pd(diagonal_dy, diagonal_dy)), square);
  _mm256_storeu_pd(out.r2.value.data(),
                   _mm256_mul_pd(_mm256_fmadd_pd(px, px, _mm256_mul_pd(py, py)), _mm256_set1_pd(square)));
  // Without the zero's sign.
  const auto slope = [&](__m256d v) {
    return _mm256_mul_pd(_mm256_sub_pd(_mm256_setzero_pd(), v), _mm256_set1_pd(2 * of_pixel));
  };
  _mm256_storeu_pd(out.r2.gx.data(), slope(px));
  _mm256_storeu_pd(out.r2.gy.data(), slope(py));
  out.left = columns.from - out.x0;
  out.right = columns.to - out.x0;
  out.top = rows.from - out.y0;
  out.bottom = rows.to - out.y0;
  if (!small_columns(format, quad, out)) return std::nullopt;
  return QuadReject::none;
}

/// FloatLanes::walk_small.
void walk_small(const FloatLanes::Format& format, const SmallQuad& quad, SmallWalk& out) {
  const __m256i zero = _mm256_setzero_si256();
  const auto load = [](const std::array<std::int32_t, 8>& v) {
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(v.data()));
  };
  const __m256i gx = load(quad.gx), gy = load(quad.gy);
  const auto rising = [&](__m256i a, __m256i b) {
    return _mm256_or_si256(_mm256_cmpgt_epi32(a, zero),
                           _mm256_and_si256(_mm256_cmpeq_epi32(a, zero), _mm256_cmpgt_epi32(b, zero)));
  };
  const __m256i tie_positive = rising(gx, gy);
  const __m256i tie_negative = rising(_mm256_sub_epi32(zero, gx), _mm256_sub_epi32(zero, gy));
  // What is added to a value makes it negative where it can be so in the square, or 0 that counts as that; the value
  // taken from the other one where it can be positive.
  struct Reach {
    __m256i least, greatest;
  };
  const auto reach = [&](int extent) {
    const __m256i n = _mm256_set1_epi32(extent - 1);
    const __m256i sx = _mm256_mullo_epi32(gx, n), sy = _mm256_mullo_epi32(gy, n);
    return Reach{
        _mm256_add_epi32(_mm256_add_epi32(_mm256_min_epi32(sx, zero), _mm256_min_epi32(sy, zero)), tie_negative),
        _mm256_sub_epi32(_mm256_sub_epi32(tie_positive, _mm256_max_epi32(sx, zero)), _mm256_max_epi32(sy, zero))};
  };
  const auto may_cover = [&](__m256i at, const Reach& r) {
    const auto signs = [](__m256i v) { return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(v))) & 31; };
    const unsigned negative = signs(_mm256_add_epi32(at, r.least)), positive = signs(_mm256_sub_epi32(r.greatest, at));
    return (format.cull != Cull::back && (format.may_face >> (positive | (negative & 16) << 1) & 1) != 0) ||
           (format.cull != Cull::front && (format.may_face >> (negative | (positive & 16) << 1) & 1) != 0);
  };
  constexpr int tile = 1 << SmallQuad::tile_log2;
  const __m256i block = load(quad.value);
  out.blocks_tested = 1;
  out.tiles_tested = out.hits = 0;
  if (!may_cover(block, reach(tile * Config::block_tiles))) return;
  const Reach in_tile = reach(tile);
  const __m256i down = _mm256_slli_epi32(gy, SmallQuad::tile_log2);
  __m256i right = _mm256_slli_epi32(gx, SmallQuad::tile_log2), at = block;
  int x = 0, step = 1;
  for (int y = 0; y < quad.tiles_y; ++y) {
    for (int n = 0;; ++n) {
      if (may_cover(at, in_tile))
        out.hit[static_cast<std::size_t>(out.hits++)] = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y)};
      if (n == quad.tiles_x - 1) break;
      x += step;
      at = _mm256_add_epi32(at, right);
    }
    step = -step;
    right = _mm256_sub_epi32(zero, right);
    at = _mm256_add_epi32(at, down);
  }
  out.tiles_tested = quad.tiles_x * quad.tiles_y;
}

/// tile_walk's `covers`, by the signs at all pixels of a tile: a linear function is least and greatest at some of them.
inline bool covers_tile(const SignWords<std::uint64_t> (&e)[5], Cull cull) {
  constexpr std::uint64_t all = ~std::uint64_t{0};
  const auto face = [&e](std::uint64_t SignWords<std::uint64_t>::*inner,
                         std::uint64_t SignWords<std::uint64_t>::*outer) {
    const auto everywhere = [&](std::size_t k) { return e[k].*inner == all; };
    const bool first = everywhere(0) && everywhere(1) && (everywhere(2) || everywhere(3));
    const bool second = everywhere(2) && everywhere(3) && (everywhere(0) || everywhere(1));
    const bool on_first = e[4].*inner != 0, on_second = e[4].*outer != 0;
    return (on_first || on_second) && (first || !on_first) && (second || !on_second);
  };
  return (cull != Cull::back && face(&SignWords<std::uint64_t>::positive, &SignWords<std::uint64_t>::negative)) ||
         (cull != Cull::front && face(&SignWords<std::uint64_t>::negative, &SignWords<std::uint64_t>::positive));
}

/// FloatLanes::cover by narrow edges: `value` at the tile's first pixel, (x0, y0) from the first tile's origin pixel.
FloatLanes::TileCounts cover_narrow(const FloatLanes::Format& format, const PixelBounds& bounds,
                                    const std::array<std::int32_t, 5>& value, int x0, int y0, const NarrowEdges& edges,
                                    MaskedDepth* masked, PixelList& list) {
  constexpr int tile = 1 << NarrowEdges::tile_log2;
  FloatLanes::TileCounts counts;
  const Range rows = rows_in_tile(bounds, y0, tile), columns = columns_in_tile(bounds, x0, tile);
  if (rows.from >= rows.to || columns.from >= columns.to) return counts;
  SignWords<std::uint64_t> signs[5];
  std::uint64_t zeros = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const TileSigns at = tile_signs(value[k], edges.gx[k], edges.gy[k]);
    const std::uint64_t tie_positive = edges.tie_positive[k], tie_negative = edges.tie_negative[k];
    signs[k] = {~(at.negative | at.zero) | (at.zero & tie_positive), at.negative | (at.zero & tie_negative)};
    zeros |= at.zero & (tie_positive | tie_negative);  // an all-zero edge decides nothing
  }
  const PlaceWords<std::uint64_t> inside = inside_expression(signs, edges.visible, format.cull);
  const std::uint64_t seen = seen_pixels(rows, columns, tile, 0);
  const std::uint64_t mask = (inside.back | inside.front) & seen;
  TileWord word{mask, inside.front & seen, zeros & mask};
  if (masked != nullptr) {
    counts.covered = covers_tile(signs, format.cull);
    if (masked->hidden()) return counts;
    keep_seen(tile, *masked, &word);
  }
  append_word(word, x0, y0, NarrowEdges::tile_log2, counts, list);
  return counts;
}
