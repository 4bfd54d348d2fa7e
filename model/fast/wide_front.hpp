// The front of kernel.hpp in double precision, of any quad and any width, and its codes.
//
// Why the bits are the machine's, besides kernel.hpp's reasons:
//  - A, D and r² are integers of 64 bits, whose partial sums may wrap. What is made of them, rounded toward zero, has
//    their first 53 bits, of which S <= 26 stay.
//  - PREC_BITS <= 31, coefficients have 29 bits and dx 22, codes 48: all far below 53.
//  - Range: integers below 2^63 make u below 2^64 and M, a product of six of them at most, below 2^381. Numbers of the
//    port are within 2^±256: no sum overflows, nor is one 0 that should not. Quotients beyond are clamped, or 0,
//    anyway.

using Real = double;
using Code = std::int64_t;
using C = F;  ///< codes
using Base = double;
using Quad = WideQuad;
using Column = LaneColumnOf<double>;
using Table = LaneTableOf<double>;
using Format = LaneFormatOf<double>;
constexpr int fraction_bits = 52;
constexpr Code bias = 1023, exponent_code = 0x7ff0000000000000;

inline F magnitude(F v) { return keep(v, real(splat(INT64_MAX))); }
/// Of a reciprocal, with the sign of the number that it is of: that of 0 is 0.
inline F signed_like(F v, F of) {
  const F zero = splat(0.0);
  return select(equal(of, zero), zero, real(bits(v) | (bits(of) & splat(INT64_MIN))));
}
inline Mask not_above(F a, F b) { return at_least(b, a); }
inline unsigned out_of_range(F, F, const WideQuad&) { return 0; }

/// base + num * rec * per_unit, the quotient rounded to nearest, halves away from zero: the half is added before the
/// unit cuts what is below 53 bits, fraction. What has no integer part of 52 bits is beyond every limit.
[[gnu::always_inline]] inline C to_codes(F num, F rec, F per_unit, const LaneCodes<double>& to, Mask& clamped) {
  const I sign = (bits(num) ^ bits(rec)) & splat(INT64_MIN);
#ifdef __wasm__
  // With the number before a half: of what is less than a half the nearest sum is below 1, of a half it is 1.
  const F rounded = toward_zero(num * per_unit * rec + real(sign | bits(splat(0x1.fffffffffffffp-2))));
#else
  const F half = real(sign | bits(splat(0.5))), most = splat(0x1p51);
  const F rounded = toward_zero(least(greatest(fma(num * per_unit, rec, half), splat(-0x1p51)), most));
#endif
  const F sum = rounded + splat(to.base), low = splat(to.low), high = splat(to.high);
  clamped = clamped | greater(low, sum) | greater(sum, high);
  return least(greatest(sum, low), high);
}

/// What A, D and r² are at the pixels of a vector, as magnitudes.
template <class Arithmetic>
struct FrontOf {
  static constexpr bool drops_bits = true, any_w = true;

  const WideQuad& quad;
  const Arithmetic& arithmetic;
  I dx, dy;
  F x, y;  ///< the same

  FrontOf(const WideQuad& q, const Arithmetic& a, I place)
      : quad(q),
        arithmetic(a),
        dx(place & splat(Code{0xffff})),
        dy(shift_right<16>(place)),
        x(converted(dx)),
        y(converted(dy)) {}

  [[gnu::always_inline]] inline F linear(const WideQuad::Form& f) const {
    return splat(f.value) + x * splat(f.gx) + y * splat(f.gy);
  }
  /// WideQuad::in_doubles: every number here is exact.
  [[gnu::always_inline]] inline void exact_distances(Mask (&sign_d)[6], F (&d)[6], F (&r2)[4]) const {
    const F zero = splat(0.0), square = x * x + y * y;
    F squares[4];
    const auto quadratic_form = [&](std::size_t k) LANE_LAMBDA {
      return linear(quad.quadratic_forms[k]) + square * splat(quad.quadratic_forms[k].q);
    };
    for (std::size_t i = 0; i < 4; ++i) {
      squares[i] = quadratic_form(linear_count + i);
      r2[i] = arithmetic.cut(greatest(squares[i], zero));
    }
    F dot[6];
    if (quad.homogeneous)
      for (std::size_t k = 0; k < 6; ++k) dot[k] = quadratic_form(k);
    else  // the law of cosines
      for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = vertex_pair[k];
        dot[k] = (squares[i] + squares[j] - splat(quad.length2_values[k])) * splat(0.5);
      }
    for (std::size_t k = 0; k < 6; ++k) {
      sign_d[k] = greater(zero, dot[k]);
      d[k] = arithmetic.cut_size(dot[k]);
    }
  }

  [[gnu::always_inline]] inline I quadratic(std::size_t k, I square) const {
    const QuadraticForm& f = quad.quadratic[k];
    return add(add(splat(f.value), times(square, f.q)), add(times(dx, f.gx), times(dy, f.gy)));
  }

  [[gnu::always_inline]] inline void distances(Mask (&sign_d)[6], F (&d)[6], F (&r2)[4]) const {
    if (quad.in_doubles) return exact_distances(sign_d, d, r2);
    const I square = add(multiply_words(dx, dx), multiply_words(dy, dy));
    I squares[4];
    for (std::size_t i = 0; i < 4; ++i) {
      squares[i] = quadratic(linear_count + i, square);
      r2[i] = arithmetic.cut(greatest(converted_any(squares[i]), splat(0.0)));
    }
    for (std::size_t k = 0; k < 6; ++k) {
      I dot;
      if (quad.homogeneous) {
        dot = quadratic(k, square);
      } else {
        // The law of cosines: half of a sum that may have 65 bits, by halves.
        const auto [i, j] = vertex_pair[k];
        const auto length2 = static_cast<Code>(quad.length2[k]);
        const I odd = subtract(add(squares[i] & splat(Code{1}), squares[j] & splat(Code{1})), splat(length2 & 1));
        dot = add(add(halved(squares[i]), halved(squares[j])),
                  subtract(halved(odd), splat(static_cast<Code>(quad.length2[k] >> 1))));
      }
      sign_d[k] = sign(dot);
      d[k] = arithmetic.cut(magnitude(converted_any(dot)));
    }
  }

  template <std::size_t functions>
  [[gnu::always_inline]] inline void edges(Mask (&sign_a)[6], F (&v)[6]) const {
    const F scale = splat(quad.a_scale);
    if (quad.in_doubles) {
      for (std::size_t k = 0; k < functions; ++k) {
        const F a = linear(quad.linear_forms[k]);
        sign_a[k] = greater(splat(0.0), a);
        v[k] = arithmetic.cut_size(a) * scale;
      }
      return;
    }
    for (std::size_t k = 0; k < functions; ++k) {
      const LinearForm& f = quad.linear[k];
      const I a = add(splat(f.value), add(times(dx, f.gx), times(dy, f.gy)));
      sign_a[k] = sign(a);
      v[k] = arithmetic.cut(magnitude(converted_any(a))) * scale;
    }
  }
};
