// Sums of kernel.hpp whose terms are cut at the last place of a number c: `c` is 2^(E - PREC_BITS + P - 1). Included by
// it. No term is negative.

#ifdef __wasm__
// WebAssembly rounds to nearest alone. Products are exact there, of 52 bits.

/// Whole last places of c, which are cut as integers.
class Places {
 public:
  explicit Places(F c)
      : place_(real(subtract(bits(c), splat(Code{fraction_bits} << fraction_bits)))),
        inverse_(real(subtract(splat((2 * bias) << fraction_bits), bits(place_)))) {}
  F of(F v) const { return __builtin_elementwise_trunc(v * inverse_); }
  F of(F a, F b) const { return __builtin_elementwise_trunc(a * inverse_ * b); }
  F size(F count) const { return count * place_; }

 private:
  F place_, inverse_;
};

inline F cut_sum(F a, F b, F d, F c) {
  const Places places(c);
  return places.size(places.of(a, b) + places.of(d));
}
[[gnu::always_inline]] inline F cut_sum(const F (&m)[4], std::size_t first, const Column& column, F c) {
  const Places places(c);
  F sum = splat(Real{0});
  if (column.mixed)  // cut toward zero, whatever the sign
    for (std::size_t i = first; i < 4; ++i) sum = sum + places.of(m[i], splat(column.positive[i] - column.negative[i]));
  else
    for (std::size_t i = first; i < 4; ++i) sum = sum + places.of(m[i], splat(column.positive[i]));
  return places.size(sum);
}
/// c + a b, cut at the last place of c. `half` of it, less half of the product's own: what is nearest then is below.
inline F cut_fma(F a, F b, F c, F half) { return (a * b - half) + c; }

#else
inline F cut_sum(F a, F b, F d, F c) { return add(fma(a, b, c), d) - c; }
/// Of m[i] and the column, from `first` on.
[[gnu::always_inline]] inline F cut_sum(const F (&m)[4], std::size_t first, const Column& column, F c) {
  F positive = c;
  for (std::size_t i = first; i < 4; ++i) positive = fma(m[i], splat(column.positive[i]), positive);
  F negative = c;
  if (column.mixed)
    for (std::size_t i = first; i < 4; ++i) negative = fma(m[i], splat(column.negative[i]), negative);
  return positive - negative;
}
inline F cut_fma(F a, F b, F c, F) { return fma(a, b, c); }
#endif
