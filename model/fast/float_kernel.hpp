// The code of float_lanes.cpp, included there once for each instruction set, inside a namespace of its own.
//
// Why the bits are the machine's (rtl/SPEC.md, Numbers), with the unit rounding toward zero and what is too small
// for a normal number going to zero:
//  - A product of two S-bit numbers is cut to 24 bits by the unit, then to S by `cut`: the same as cutting it to S.
//  - fp_sum cuts each term at the quantum 2^(E - PREC_BITS), E the largest sum of two factors' exponents. C = 2^(E -
//    PREC_BITS + 23) has its last place there, and so has what is less than 2 C: C + term is the cut term above C, and
//    adding the next one cuts that one alone. A term is below 4 * 2^E, four of them are below 2^(PREC_BITS + 4) quanta,
//    and C is 2^23 of them: with S + align_guard_bits <= 20 (PREC_BITS <= 19) the sum stays below 2 C. Fused, the
//    product is not even rounded before. Taking C away is exact.
//  - Terms of either sign have a sum each, for truncation is of magnitudes; the difference of the two is exact.
//  - Tables: products of integers as floats, floor by adding 2^23; everything else there is an integer below 2^24, or
//    such times a power of two: dx is taken as the integer that the fraction's last bits are.
//  - Numbers scale: D, A and r² of a quad times one power of 4 give M times a power of two, and quotients that are the
//    same. So the quad is drawn about one unit large, and root_ratio's `balanced` is left out.
//  - A and r² are functions value + gx dx + gy dy (+ dx² + dy²) in doubles, 2 D follows from three of r² and lengths:
//    every part is a multiple of the same last place, 53 bits wide at most (FloatLanes::take), so that nothing is
//    rounded. No sum is -0: of a number and its opposite the unit makes +0, and the first one is of value, which is no
//    -0.
//  - Areas for weights are |A|, cut, as they are: M <= 4, and no product of three.
//  - Range: u, v, r <= 4, M <= 2^12; those functions are far from the smallest double. Products of three can
//    go below 2^-126 and become 0. Where the sums of M k and of M W are at least 2^-26, their E is at least -30, a term
//    with such an M is below 2^-126 * 2^6 * 2^30 = 2^-90 (numbers of the port are taken up to 2^30), and a quotient of
//    2^-31 or more is of a sum with E >= -64: the term is below its quantum 2^-83 and is nothing there either. A
//    smaller quotient, less than half of the last bit that an output can have, is 0 in both: so nothing hangs on
//    differences below 2^-90, nor on a C that went to 0. Lanes with a smaller sum are for the plain pipeline.

struct Arithmetic {
  F cut_mask;
  F lowest, highest;  ///< a table's result with its guard bits
  I fraction_mask;    ///< of what `cut` leaves of a fraction

  explicit Arithmetic(int s)
      : cut_mask(real(splat(static_cast<std::int32_t>(-(1 << (24 - s)))))),
        lowest(splat(static_cast<float>(1 << (s - 1 + Config::table_guard)))),
        highest(splat(static_cast<float>((1 << (s + Config::table_guard)) - 1))),
        fraction_mask(splat((1 << 23) - (1 << (24 - s)))) {}

  F cut(F v) const { return keep(v, cut_mask); }
  F multiply(F a, F b) const { return cut(a * b); }
  /// 2^floor(log2 v), 0 of 0.
  static F power(F v) { return keep(v, real(splat(0x7f800000))); }

  /// table_polynomial of the arguments' fractions, cut, with codes of exponents in the place of their own.
  template <bool in_columns, std::size_t n>
  [[gnu::always_inline]] inline void polynomials(const F (&a)[n], const FloatTable& table, bool rising,
                                                 const I (&exponent)[n], F (&out)[n]) const {
    Coefficients c[n];
    if constexpr (in_columns) look_up_columns(table, a, c);
    const I rest = splat((1 << table.rest_bits) - 1);
    const F last_place = splat(table.last_place), integer = splat(0x1p23f);
    for (std::size_t i = 0; i < n; ++i) {
      if constexpr (!in_columns) c[i] = look_up(table, a[i]);
      const F dx = converted(bits(a[i]) & rest);
      const F t1 = c[i].c1 - fma(c[i].c2, dx, last_place);
      const F y = rising ? fma(t1, dx, c[i].c0) - integer : c[i].c0 - fma(t1, dx, integer);
      out[i] = real((bits(least(greatest(y, lowest), highest)) & fraction_mask) | exponent[i]);
    }
  }
};

/// Roots, and their powers of two.
template <bool in_columns, std::size_t n>
[[gnu::always_inline]] inline void sqrt_lanes(const F (&a)[n], const FloatTable& table, const Arithmetic& arithmetic,
                                              F (&root)[n], F (&power)[n]) {
  I exponent[n];
  // The code E + 127 of an exponent: floor(E / 2) + 127.
  for (std::size_t i = 0; i < n; ++i) {
    exponent[i] = shift_right<1>(add(bits(a[i]), splat(127 << 23))) & splat(0x7f800000);
    power[i] = real(exponent[i]);
  }
  arithmetic.polynomials<in_columns>(a, table, true, exponent, root);
}

/// Of a > 0 below 2^126: -E - 1 is the exponent of the table's result, -E of a power of two.
template <bool in_columns, std::size_t n>
[[gnu::always_inline]] inline void recip_lanes(const F (&a)[n], const FloatTable& table, const Arithmetic& arithmetic,
                                               F (&out)[n]) {
  I power[n], exponent[n];
  for (std::size_t i = 0; i < n; ++i) {
    power[i] = bits(Arithmetic::power(a[i]));
    exponent[i] = subtract(splat(253 << 23), power[i]);
  }
  arithmetic.polynomials<in_columns>(a, table, false, exponent, out);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = real(select(equal(bits(a[i]), power[i]), subtract(splat(254 << 23), power[i]), bits(out[i])));
}

/// base + num * rec * per_unit, the quotient rounded to nearest, halves away from zero. The half is fused in: of a sum
/// below 2^24 cutting it to 24 bits takes nothing but fraction. Others, and what 32 bits may not hold, are left to
/// doubles, which also clamp; `clamped` gains their lanes.
[[gnu::always_inline]] inline I to_codes(F num, F rec, F per_unit, const FloatCodes& to, Mask& clamped) {
  const F scaled = num * per_unit;
  const F half = real((bits(num) & splat(INT32_MIN)) | bits(splat(0.5f)));
  const F sum = fma(scaled, rec, half);
  if (none(at_least(keep(sum, real(splat(INT32_MAX))), splat(to.bound)))) [[likely]]
    return add(truncated(sum), splat(to.base));
  const D base = splat(static_cast<double>(to.base)), low = splat(static_cast<double>(to.low)),
          high = splat(static_cast<double>(to.high));
  const Doubles n = widened(scaled), r = widened(rec), h = widened(half);
  const Doubles code = {toward_zero(fma(n.low, r.low, h.low)) + base, toward_zero(fma(n.high, r.high, h.high)) + base};
  const Doubles in = {least(greatest(code.low, low), high), least(greatest(code.high, low), high)};
  const I beyond = truncated(Doubles{code.low - in.low, code.high - in.high});
  clamped = clamped | greater(beyond, splat(0)) | greater(splat(0), beyond);
  return truncated(in);
}

/// Function k at all lanes.
inline Halves at_pixels(const FloatForms& f, std::size_t k, Halves dx, Halves dy) {
  const D value = splat(f.value[k]), gx = splat(f.gx[k]), gy = splat(f.gy[k]);
  return {fma(dy.a, gy, fma(dx.a, gx, value)), fma(dy.b, gy, fma(dx.b, gx, value))};
}

/// The whole list; MXCSR is as it must be. `in_columns`: of both tables. `areas`: FloatQuad::areas.
template <bool in_columns, bool areas>
__attribute__((noinline)) void draw_list(const FloatLanes::Format& format, const FloatQuad& quad, const PixelList& list,
                                         int count, FloatResults& out) {
  const Arithmetic arithmetic(format.s);
  const F zero = splat(0.0f);
  const F align = splat(static_cast<float>(1 << (23 - format.prec)));
  const F attribute_scale = splat(static_cast<float>(1 << format.attribute_frac));
  const F depth_scale = splat(static_cast<float>(1 << format.depth_bits));
  const I corner_at = splat(quad.x0 | quad.y0 << 16);
  const I nothing = splat(0);

  for (int begin = 0; begin < count; begin += width) {
    const auto at = static_cast<std::size_t>(begin);
    const I place = load(list.place.data() + at);
    const Halves dx = to_doubles(place & splat(0xffff)), dy = to_doubles(shift_right<16>(place));
    Mask sign_a[6], sign_d[6];
    F v[6], d[6], r2[4];
    // As drawn a double's exponent has the code of a float's.
    const auto magnitude = [&](I h) { return arithmetic.cut(real(shift_left<3>(h))); };
    const auto distances = [&]() __attribute__((always_inline)) {
      const D unit2 = splat(quad.unit2);
      const Halves curve = {fma(dy.a, dy.a, dx.a * dx.a) * unit2, fma(dy.b, dy.b, dx.b * dx.b) * unit2};
      Halves square[4];
      for (std::size_t i = 0; i < 4; ++i) {
        const Halves linear = at_pixels(quad.r2, i, dx, dy);
        square[i] = {linear.a + curve.a, linear.b + curve.b};
        r2[i] = magnitude(upper_halves(square[i].a, square[i].b));
      }
      for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = vertex_pair[k];
        const D length2 = splat(quad.length2[k]);
        const I dot = upper_halves(square[i].a + square[j].a - length2, square[i].b + square[j].b - length2);  // 2 D
        sign_d[k] = sign(dot);
        d[k] = half(magnitude(dot));
      }
    };
    if constexpr (!areas) distances();
    constexpr std::size_t functions = areas ? 5 : 6;  // not E13
    for (std::size_t k = 0; k < functions; ++k) {
      const Halves cross = at_pixels(quad.a, k, dx, dy);
      const I a = upper_halves(cross.a, cross.b);
      sign_a[k] = sign(a);
      v[k] = magnitude(a);
    }

    // Singular pixels and edges are rare: something is 0. (Two A are at a corner.)
    const F smallest = least(least(v[0], v[1]), least(v[2], v[3]));
    unsigned singular = 0;
    Mask on_edge = no_lane(), notch = no_lane(), saturated = no_lane();
    if (none(equal(smallest, zero))) [[likely]] {
      notch = without(sign_a[0] | sign_a[1] | sign_a[2] | sign_a[3], sign_a[0] & sign_a[1] & sign_a[2] & sign_a[3]);
    } else {
      if constexpr (areas) distances();
      Mask corner = no_lane(), one = no_lane(), two = no_lane();
      const auto is_zero = [zero](F value) { return equal(value, zero); };
      for (std::size_t k = 0; k < 4; ++k) {
        corner = corner | is_zero(r2[k]);
        const Mask on = is_zero(v[k]) & sign_d[k];
        two = two | (one & on);
        one = one | on;
        const std::size_t before = (k + 3) % 4;
        notch = notch | without(sign_a[before] ^ sign_a[k], is_zero(v[before]) | is_zero(v[k]));
      }
      singular = lanes(corner | two);
      on_edge = without(one, corner | two);
      notch = without(notch, corner | two);
    }

    F m[4];
    if constexpr (areas) {
      const Mask behind_diagonal = (sign_a[0] | sign_a[1] | sign_a[2] | sign_a[3]) ^ sign_a[4];
      m[0] = select(behind_diagonal, v[2], v[1]);
      m[1] = select(behind_diagonal, zero, v[4]);
      m[2] = select(behind_diagonal, v[3], v[0]);
      m[3] = select(behind_diagonal, v[4], zero);
    } else {
      // u = r r' + |D|.
      F r[4], r_power[4];
      sqrt_lanes<in_columns>(r2, format.sqrt, arithmetic, r, r_power);
      F u[6];
      for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = vertex_pair[k];
        const F c = greatest(r_power[i] * r_power[j], Arithmetic::power(d[k])) * align;
        u[k] = arithmetic.cut(fma(r[i], r[j], c) + d[k] - c);
      }

      // root_ratio.hpp; a term of an edge cancels where D < 0, of a diagonal where D >= 0.
      struct Ratio {
        F num, den;
      };
      constexpr std::size_t near_of[3] = {0, 3, 4}, far_of[3] = {2, 1, 5};
      F under[3], root[3], no_power[3];
      for (std::size_t i = 0; i < 3; ++i) under[i] = arithmetic.multiply(u[near_of[i]], u[far_of[i]]);
      sqrt_lanes<in_columns>(under, format.sqrt, arithmetic, root, no_power);
      const auto ratio = [&](std::size_t i, bool diagonal) {
        const std::size_t near = near_of[i], far = far_of[i];
        const Mask near_sign = sign_d[near], far_sign = sign_d[far];
        const auto choose = [diagonal](Mask sign, F cancels, F regular) {
          return diagonal ? select(sign, regular, cancels) : select(sign, cancels, regular);
        };
        const F crossed = arithmetic.multiply(v[far], u[near]), scaled = arithmetic.multiply(v[near], root[i]);
        return Ratio{choose(near_sign, choose(far_sign, crossed, root[i]), choose(far_sign, v[far], u[far])),
                     choose(near_sign, choose(far_sign, scaled, v[near]), root[i])};
      };
      const Ratio a = ratio(0, false), b = ratio(1, false), e = ratio(2, true);
      m[0] = arithmetic.multiply(arithmetic.multiply(a.num, b.num), e.num);
      m[1] = arithmetic.multiply(arithmetic.multiply(a.num, b.den), e.den);
      m[2] = arithmetic.multiply(arithmetic.multiply(a.den, b.den), e.num);
      m[3] = arithmetic.multiply(arithmetic.multiply(a.den, b.num), e.den);
    }
    F power[4];
    for (std::size_t i = 0; i < 4; ++i) power[i] = Arithmetic::power(m[i]);

    const auto sum_from = [&](std::size_t first, const FloatColumn& column) __attribute__((always_inline)) {
      F c = greatest(power[2] * splat(column.align[2]), power[3] * splat(column.align[3]));
      for (std::size_t i = first; i < 2; ++i) c = greatest(power[i] * splat(column.align[i]), c);
      F positive = c;
      for (std::size_t i = first; i < 4; ++i) positive = fma(m[i], splat(column.positive[i]), positive);
      F negative = c;
      if (column.mixed)
        for (std::size_t i = first; i < 4; ++i) negative = fma(m[i], splat(column.negative[i]), negative);
      return arithmetic.cut(positive - negative);
    };
    const auto sum = [&](const FloatColumn& column) __attribute__((always_inline)) { return sum_from(0, column); };
    const auto flipped = [](F value, const FloatColumn& column) { return real(bits(value) ^ splat(column.flip)); };
    F den_k = splat(1.0f), den_w = splat(1.0f), rec_k = splat(1.0f), rec_w = splat(1.0f);
    if (quad.sum_k) den_k = sum(quad.k);
    if (quad.w_of_k)
      den_w = den_k * splat(static_cast<float>(*quad.w_of_k));
    else if (quad.sum_w)
      den_w = sum(quad.w);
    const auto reciprocal = [&](F of, F& to) {
      F one[1];
      recip_lanes<in_columns>({of}, format.recip, arithmetic, one);
      to = one[0];
    };
    const bool recip_w = quad.sum_w && quad.sum_z;
    if (quad.sum_k && recip_w && !quad.w_of_k) {
      F both[2];
      recip_lanes<in_columns>({den_k, den_w}, format.recip, arithmetic, both);
      rec_k = both[0];
      rec_w = both[1];
    } else {
      if (quad.sum_k) reciprocal(den_k, rec_k);
      if (quad.w_of_k)
        rec_w = rec_k * splat(static_cast<float>(1 / *quad.w_of_k));
      else if (recip_w)
        reciprocal(den_w, rec_w);
    }
    const unsigned small = lanes(not_at_least(least(den_k, den_w), splat(0x1p-26f)));

    I attribute[max_attribute_slots];
    for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j) {
      const FloatColumn& b = quad.b[j];
      attribute[j] = quad.sum_b[j]
                         ? to_codes(flipped(sum_from(1, b), b), rec_k, attribute_scale, quad.attribute[j], saturated)
                         : splat(quad.attribute[j].base);
    }

    unsigned discard = 0;
    I depth = nothing;
    if (format.depth) {
      const I low = splat(quad.depth.low), high = splat(quad.depth.high);
      I z = splat(quad.depth.base);
      Mask clamped = no_lane();
      if (quad.sum_z) z = to_codes(flipped(sum(quad.z), quad.z), rec_w, depth_scale, quad.depth, clamped);
      z = least(greatest(z, low), high);
      depth = greatest(z, nothing);
      discard = lanes(greater(splat(format.znear), z) | greater(z, splat(format.zfar)));
    }

    constexpr unsigned every_lane = (1u << width) - 1;
    const unsigned used = count - begin >= width ? every_lane : (1u << (count - begin)) - 1;
    const unsigned plain = (singular | small) & used, counted = used & ~plain;
    for (std::size_t b8 = 0; b8 < width / 8; ++b8) {
      out.plain[at / 8 + b8] = static_cast<std::uint8_t>(plain >> 8 * b8);
      out.drawn[at / 8 + b8] = static_cast<std::uint8_t>((used & ~discard) >> 8 * b8);
    }
    out.any_plain |= plain != 0;
    out.all_drawn &= (discard & used) == 0;
    I marks = load(list.marks.data() + at);
    if (!none(on_edge | saturated | notch)) {  // of most quads' pixels none is
      const auto tally = [&](Mask of, std::uint64_t& counter) {
        counter += static_cast<std::uint64_t>(__builtin_popcount(lanes(of) & counted));
      };
      tally(on_edge, out.on_edge);
      tally(saturated, out.saturated);
      marks = marks | flag<8>(on_edge) | flag<8 + 7>(saturated);
      if (format.notch) {
        tally(notch, out.notch);
        marks = marks | flag<8 + 6>(notch);
      }
    }

    store(reinterpret_cast<std::uint32_t*>(out.fragments.place() + at), add(place, corner_at));
    store_lower_halves(reinterpret_cast<std::uint16_t*>(out.fragments.marks() + at), marks);
    store(out.fragments.depth() + at, depth);
    for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j)
      store_widened(out.fragments.attribute(j) + at, attribute[j]);
  }
}

static_assert(offsetof(FragmentPlace, x) == 0 && offsetof(FragmentPlace, y) == 2 && sizeof(FragmentPlace) == 4 &&
              offsetof(FragmentMarks, front) == 0 && offsetof(FragmentMarks, flags) == 1 && sizeof(FragmentMarks) == 2);

void draw(const FloatLanes::Format& format, const FloatQuad& quad, const PixelList& list, int count,
          FloatResults& out) {
  const bool in_columns = looks_up_columns && format.sqrt.in_columns && format.recip.in_columns;
  const auto draws = quad.areas ? (in_columns ? draw_list<looks_up_columns, true> : draw_list<false, true>)
                                : (in_columns ? draw_list<looks_up_columns, false> : draw_list<false, false>);
  draws(format, quad, list, count, out);
}
