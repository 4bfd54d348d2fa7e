// The front of kernel.hpp in single precision, and its codes in 32 bits.
//
// Why the bits are the machine's, besides kernel.hpp's reasons:
//  - A and r² are functions value + gx dx + gy dy (+ dx² + dy²) in doubles, 2 D follows from three of r² and lengths:
//    every part is a multiple of the same last place, 53 bits wide at most (FloatLanes::take), so that nothing is
//    rounded. No sum is -0: of a number and its opposite the unit makes +0, and the first one is of value, which is no
//    -0.
//  - Numbers scale: the quad is drawn about one unit large.
//  - Range: u, v, r <= 4, M <= 2^12; those functions are far from the smallest double. Products of three can
//    go below 2^-126 and become 0: such an M is below 2^-120, a term with it below 2^(e - 119), e the largest exponent
//    of the quad's numbers. Where the sums of M k and of M W are at least 2^t, t = e - 65, their E is at least t - 4,
//    and a quotient of 2^-31 or more is of a sum with E >= t - 35: the term is below its quantum 2^(t - 54) and is
//    nothing there either. A smaller quotient, less than half of the last bit that an output can have, is 0 in both.
//    Not fused, a term below 2^-126 becomes 0 before it is added: t is -72 at least, and no quantum smaller than that.
//    Lanes with a sum below FloatQuad::least_sum are for wide_lanes.hpp.

using Real = float;
using Code = std::int32_t;
using C = I;  ///< codes
using Base = std::int32_t;
using Quad = FloatQuad;
using Column = LaneColumnOf<float>;
using Table = LaneTableOf<float>;
using Format = LaneFormatOf<float>;
constexpr int fraction_bits = 23;
constexpr Code bias = 127, exponent_code = 0x7f800000;

/// Sums of W and k are positive here.
inline F magnitude(F v) { return v; }
inline F signed_like(F v, F) { return v; }
inline Mask not_above(F a, F b) { return at_least(b, a); }
/// Lanes of which this range does not hold everything.
inline unsigned out_of_range(F den_k, F den_w, const FloatQuad& quad) {
  return lanes(not_at_least(least(den_k, den_w), splat(quad.least_sum)));
}

/// base + num * rec * per_unit, the quotient rounded to nearest, halves away from zero. The half is fused in: of a sum
/// below 2^24 cutting it to 24 bits takes nothing but fraction. Others, and what 32 bits may not hold, are left to
/// doubles, which also clamp; `clamped` gains their lanes. Not fused, a half has a place below 2^23 alone.
[[gnu::always_inline]] inline I to_codes(F num, F rec, F per_unit, const LaneCodes<float>& to, Mask& clamped) {
  const F scaled = num * per_unit;
  const F half = real((bits(num) & splat(INT32_MIN)) | bits(splat(0.5f)));
  const F sum = fma(scaled, rec, half);
  if (none(at_least(keep(sum, real(splat(INT32_MAX))), splat(fused ? to.bound : std::min(to.bound, 0x1p23f)))))
      [[likely]]
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

/// What A, D and r² are at the pixels of a vector, as magnitudes.
template <class Arithmetic>
struct FrontOf {
  static constexpr bool drops_bits = false;  ///< of r²
  static constexpr bool any_w = false;       ///< sums of W and k have any sign

  const FloatQuad& quad;
  const Arithmetic& arithmetic;
  Halves dx, dy;

  FrontOf(const FloatQuad& q, const Arithmetic& a, I place)
      : quad(q), arithmetic(a), dx(to_doubles(place & splat(0xffff))), dy(to_doubles(shift_right<16>(place))) {}

  // As drawn a double's exponent has the code of a float's.
  F magnitude_of(I h) const { return arithmetic.cut(real(shift_left<3>(h))); }

  [[gnu::always_inline]] inline void distances(Mask (&sign_d)[6], F (&d)[6], F (&r2)[4]) const {
    const D unit2 = splat(quad.unit2);
    const Halves curve = {fma(dy.a, dy.a, dx.a * dx.a) * unit2, fma(dy.b, dy.b, dx.b * dx.b) * unit2};
    Halves square[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const Halves linear = at_pixels(quad.r2, i, dx, dy);
      square[i] = {linear.a + curve.a, linear.b + curve.b};
      r2[i] = magnitude_of(upper_halves(square[i].a, square[i].b));
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = vertex_pair[k];
      const D length2 = splat(quad.length2[k]);
      const I dot = upper_halves(square[i].a + square[j].a - length2, square[i].b + square[j].b - length2);  // 2 D
      sign_d[k] = sign(dot);
      d[k] = half(magnitude_of(dot));
    }
  }

  template <std::size_t functions>
  [[gnu::always_inline]] inline void edges(Mask (&sign_a)[6], F (&v)[6]) const {
    for (std::size_t k = 0; k < functions; ++k) {
      const Halves cross = at_pixels(quad.a, k, dx, dy);
      const I a = upper_halves(cross.a, cross.b);
      sign_a[k] = sign(a);
      v[k] = magnitude_of(a);
    }
  }
};
