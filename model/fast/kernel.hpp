// The pixel pipeline on vectors of one kind of floating-point number, included once for each kind and instruction set,
// inside a namespace of its own that has the vectors (float_avx2.hpp, wide_avx2.hpp, …) and their front
// (float_front.hpp, wide_front.hpp). `Real` is the kind, `Code` an integer of its size, C what codes are computed in.
//
// Why the bits are the machine's (rtl/SPEC.md, Numbers), with the unit rounding toward zero and what is too small
// for a normal number going to zero; P is 24 for float, 53 for double:
//  - A product of two S-bit numbers is cut to P bits by the unit, then to S by `cut`: the same as cutting it to S.
//  - fp_sum cuts each term at the quantum 2^(E - PREC_BITS), E the largest sum of two factors' exponents. C = 2^(E -
//    PREC_BITS + P - 1) has its last place there, and so has what is less than 2 C: C + term is the cut term above C,
//    and adding the next one cuts that one alone. A term is below 4 * 2^E, four of them are below 2^(PREC_BITS + 4)
//    quanta, and C is 2^(P - 1) of them: with PREC_BITS <= P - 5 the sum stays below 2 C. The product may be rounded
//    before, toward zero to finer places, or not, fused. Taking C away is exact.
//  - Terms of either sign have a sum each, for truncation is of magnitudes; the difference of the two is exact.
//  - Tables: products of integers, floor by adding Table::integer; everything else there is an integer below 2^P, or
//    such times a power of two: dx is taken as the integer that the fraction's last bits are.
//  - Numbers scale: D, A and r² of a quad times one power of 4 give M times a power of two, and quotients that are the
//    same. So root_ratio's `balanced` is left out.
//  - Areas for weights are |A|, cut, as they are.

#include "model/fast/cut_sums.hpp"

struct Arithmetic {
  F cut_mask, size_mask;  ///< the second one without the sign
  F lowest, highest;      ///< a table's result with its guard bits
  I fraction_mask;        ///< of what `cut` leaves of a fraction
  Real half_place;        ///< of what `cut` leaves, as an integer of the fraction's bits

  explicit Arithmetic(int s)
      : cut_mask(real(splat(-(Code{1} << (fraction_bits + 1 - s))))),
        size_mask(magnitude(cut_mask)),
        lowest(splat(static_cast<Real>(Code{1} << (s - 1 + Config::table_guard)))),
        highest(splat(static_cast<Real>((Code{1} << (s + Config::table_guard)) - 1))),
        fraction_mask(splat((Code{1} << fraction_bits) - (Code{1} << (fraction_bits + 1 - s)))),
        half_place(static_cast<Real>(Code{1} << (fraction_bits - s))) {}

  F cut(F v) const { return keep(v, cut_mask); }
  F cut_size(F v) const { return keep(v, size_mask); }
  F multiply(F a, F b) const { return cut(a * b); }
  /// 2^floor(log2 v), 0 of 0.
  static F power(F v) { return keep(v, real(splat(exponent_code))); }

  /// table_polynomial of the arguments' fractions, cut, with codes of exponents in the place of their own.
  template <bool in_columns, std::size_t n>
  [[gnu::always_inline]] inline void polynomials(const F (&a)[n], const Table& table, bool rising,
                                                 const I (&exponent)[n], F (&out)[n]) const {
    Coefficients c[n];
    if constexpr (in_columns) look_up_columns(table, a, c);
    const I rest = splat((Code{1} << table.rest_bits) - 1);
    const F last_place = splat(table.last_place), integer = splat(Table::integer);
    const Real step = table.last_place / Table::integer, below_half = Real{0.5} - step * half_place;
    const F half_step = splat(step * below_half), half = splat(below_half);
    LANE_UNROLL
    for (std::size_t i = 0; i < n; ++i) {
      if constexpr (!in_columns) c[i] = look_up(table, a[i]);
      const F dx = converted(bits(a[i]) & rest);
      const F t1 = c[i].c1 - cut_fma(c[i].c2, dx, last_place, half_step);
      const F y = rising ? cut_fma(t1, dx, c[i].c0, half) - integer : c[i].c0 - cut_fma(t1, dx, integer, half);
      out[i] = real((bits(least(greatest(y, lowest), highest)) & fraction_mask) | exponent[i]);
    }
  }
};

/// Roots, and their powers of two.
template <bool in_columns, std::size_t n>
[[gnu::always_inline]] inline void sqrt_lanes(const F (&a)[n], const Table& table, const Arithmetic& arithmetic,
                                              F (&root)[n], F (&power)[n]) {
  I exponent[n];
  // The code E + bias of an exponent: floor(E / 2) + bias.
  for (std::size_t i = 0; i < n; ++i) {
    exponent[i] = shift_right<1>(add(bits(a[i]), splat(bias << fraction_bits))) & splat(exponent_code);
    power[i] = real(exponent[i]);
  }
  arithmetic.polynomials<in_columns>(a, table, true, exponent, root);
}

/// Of a > 0 below 2^(bias - 1): -E - 1 is the exponent of the table's result, -E of a power of two.
template <bool in_columns, std::size_t n>
[[gnu::always_inline]] inline void recip_lanes(const F (&a)[n], const Table& table, const Arithmetic& arithmetic,
                                               F (&out)[n]) {
  I power[n], exponent[n];
  for (std::size_t i = 0; i < n; ++i) {
    power[i] = bits(Arithmetic::power(a[i]));
    exponent[i] = subtract(splat((2 * bias - 1) << fraction_bits), power[i]);
  }
  arithmetic.polynomials<in_columns>(a, table, false, exponent, out);
  for (std::size_t i = 0; i < n; ++i)
    out[i] =
        real(select(equal(bits(a[i]), power[i]), subtract(splat((2 * bias) << fraction_bits), power[i]), bits(out[i])));
}

/// Bits `mask` of the pixels from `at` on, eight to a byte.
template <int lanes>
inline void put_mask(std::uint8_t* bytes, std::size_t at, unsigned mask) {
  if constexpr (lanes >= 8) {
    for (std::size_t b = 0; b < lanes / 8; ++b) bytes[at / 8 + b] = static_cast<std::uint8_t>(mask >> 8 * b);
  } else {
    const unsigned before = at % 8 == 0 ? 0 : bytes[at / 8];
    bytes[at / 8] = static_cast<std::uint8_t>(before | mask << at % 8);
  }
}

/// The whole list; the unit rounds as it must. `in_columns`: of both tables. `areas`: LaneQuad::areas.
template <bool in_columns, bool areas>
__attribute__((noinline)) void draw_list(const Format& __restrict format, const Quad& quad, const PixelList& list,
                                         int count, LaneResults& out) {
  const Arithmetic arithmetic(format.s);
  const F zero = splat(Real{0}), one = splat(Real{1});
  const F align = splat(static_cast<Real>(Code{1} << (fraction_bits - format.prec)));
  const F attribute_scale = splat(static_cast<Real>(Code{1} << format.attribute_frac));
  const F depth_scale = splat(static_cast<Real>(Code{1} << format.depth_bits));
  const I corner_at = splat(Code{quad.x0 | quad.y0 << 16});

  for (int begin = 0; begin < count; begin += width) {
    const auto at = static_cast<std::size_t>(begin);
    const I place = load(list.place.data() + at);
    using Front = FrontOf<Arithmetic>;
    const Front front(quad, arithmetic, place);
    Mask sign_a[6], sign_d[6];
    F v[6], d[6], r2[4];
    if constexpr (!areas) front.distances(sign_d, d, r2);
    front.template edges<areas ? 5 : 6>(sign_a, v);  // not E13

    // Singular pixels and edges are rare: an A is 0 there. Where bits of r² are dropped that may be 0 alone.
    F smallest = least(least(v[0], v[1]), least(v[2], v[3]));
    if constexpr (Front::drops_bits) {
      if constexpr (areas) front.distances(sign_d, d, r2);
      smallest = least(smallest, least(least(r2[0], r2[1]), least(r2[2], r2[3])));
    }
    unsigned singular = 0;
    Mask on_edge = no_lane(), notch = no_lane(), saturated = no_lane();
    if (none(equal(smallest, zero))) [[likely]] {
      notch = without(sign_a[0] | sign_a[1] | sign_a[2] | sign_a[3], sign_a[0] & sign_a[1] & sign_a[2] & sign_a[3]);
    } else {
      if constexpr (areas && !Front::drops_bits) front.distances(sign_d, d, r2);
      Mask corner = no_lane(), one_edge = no_lane(), two = no_lane();
      const auto is_zero = [zero](F value) { return equal(value, zero); };
      for (std::size_t k = 0; k < 4; ++k) {
        corner = corner | is_zero(r2[k]);
        const Mask on = is_zero(v[k]) & sign_d[k];
        two = two | (one_edge & on);
        one_edge = one_edge | on;
        const std::size_t before = (k + 3) % 4;
        notch = notch | without(sign_a[before] ^ sign_a[k], is_zero(v[before]) | is_zero(v[k]));
      }
      singular = lanes(corner | two);
      on_edge = without(one_edge, corner | two);
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
      LANE_UNROLL
      for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = vertex_pair[k];
        const F largest = greatest(r_power[i] * r_power[j], Arithmetic::power(d[k]));
        u[k] = arithmetic.cut(cut_sum(r[i], r[j], d[k], largest * align));
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

    const auto sum_from = [&](std::size_t first, const Column& column) LANE_LAMBDA {
      F c = greatest(power[2] * splat(column.align[2]), power[3] * splat(column.align[3]));
      for (std::size_t i = first; i < 2; ++i) c = greatest(power[i] * splat(column.align[i]), c);
      return arithmetic.cut(cut_sum(m, first, column, c));
    };
    const auto sum = [&](const Column& column) LANE_LAMBDA { return sum_from(0, column); };
    const auto flipped = [](F value, const Column& column) { return real(bits(value) ^ splat(column.flip)); };
    F den_k = one, den_w = one, rec_k = one, rec_w = one;
    const auto denominator = [&](const Column& column)
                                 LANE_LAMBDA { return Front::any_w ? flipped(sum(column), column) : sum(column); };
    if (quad.sum_k) den_k = denominator(quad.k);
    if (quad.w_of_k)
      den_w = den_k * splat(static_cast<Real>(*quad.w_of_k));
    else if (quad.sum_w)
      den_w = denominator(quad.w);
    const auto reciprocal = [&](F of, F& to) {
      F rec[1];
      recip_lanes<in_columns>({magnitude(of)}, format.recip, arithmetic, rec);
      to = signed_like(rec[0], of);
    };
    const bool recip_w = quad.sum_w && quad.sum_z;
    if (quad.sum_k && recip_w && !quad.w_of_k) {
      F both[2];
      recip_lanes<in_columns>({magnitude(den_k), magnitude(den_w)}, format.recip, arithmetic, both);
      rec_k = signed_like(both[0], den_k);
      rec_w = signed_like(both[1], den_w);
    } else {
      if (quad.sum_k) reciprocal(den_k, rec_k);
      if (quad.w_of_k)
        rec_w = rec_k * splat(static_cast<Real>(1 / *quad.w_of_k));
      else if (recip_w)
        reciprocal(den_w, rec_w);
    }
    const unsigned small = out_of_range(den_k, den_w, quad);

    C attribute[max_attribute_slots];
    for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j) {
      const Column& b = quad.b[j];
      attribute[j] = quad.sum_b[j]
                         ? to_codes(flipped(sum_from(1, b), b), rec_k, attribute_scale, quad.attribute[j], saturated)
                         : splat(quad.attribute[j].base);
    }

    unsigned discard = quad.hull ? lanes(not_above(den_w, zero)) : 0;
    C depth = splat(Base{0});
    if (format.depth) {
      const C low = splat(quad.depth.low), high = splat(quad.depth.high);
      C z = splat(quad.depth.base);
      Mask clamped = no_lane();
      if (quad.sum_z) z = to_codes(flipped(sum(quad.z), quad.z), rec_w, depth_scale, quad.depth, clamped);
      z = least(greatest(z, low), high);
      if (quad.w_may_vanish) z = select(equal(den_w, zero), high, z);
      depth = greatest(z, splat(Base{0}));
      discard |=
          lanes(greater(splat(static_cast<Base>(format.znear)), z) | greater(z, splat(static_cast<Base>(format.zfar))));
    }

    constexpr unsigned every_lane = (1u << width) - 1;
    const unsigned used = count - begin >= width ? every_lane : (1u << (count - begin)) - 1;
    const unsigned counted = used & ~(singular | small);
    put_mask<width>(out.plain.data(), at, singular & used);
    put_mask<width>(out.small.data(), at, small & ~singular & used);
    put_mask<width>(out.drawn.data(), at, used & ~discard);
    out.any_small |= (small & ~singular & used) != 0;
    out.any_plain |= (singular & used) != 0;
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
    store_lower_halves(reinterpret_cast<std::uint16_t*>(out.fragments.marks() + at), marks | splat(Code{quad.marks}));
    store(out.fragments.depth() + at, depth);
    for (std::size_t j = 0; j < static_cast<std::size_t>(format.attributes); ++j)
      store_widened(out.fragments.attribute(j) + at, attribute[j]);
  }
}

void draw(const Format& format, const Quad& quad, const PixelList& list, int count, LaneResults& out) {
  const bool in_columns = looks_up_columns && format.sqrt.in_columns && format.recip.in_columns;
  const auto draws = quad.areas ? (in_columns ? draw_list<looks_up_columns, true> : draw_list<false, true>)
                                : (in_columns ? draw_list<looks_up_columns, false> : draw_list<false, false>);
  draws(format, quad, list, count, out);
}
