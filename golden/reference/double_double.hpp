// Sums of two doubles that do not overlap: some 106 bits out of plain double arithmetic, without a branch, for
// several numbers side by side in a vector. u = 2^-53. Rounding to nearest; nothing may overflow, and no product below
// 2^-960 be expected to be exact.
#pragma once

namespace quadrille::golden {

/// A vector of doubles; every processor takes it, in as many pieces as it needs.
inline constexpr int double_lanes = 8;
using Doubles = double __attribute__((vector_size(double_lanes * sizeof(double))));

/// hi + lo, in each lane; hi is the double nearest to it.
struct DoubleDouble {
  Doubles hi, lo;
};

#define QUADRILLE_INLINE [[gnu::always_inline]] inline

QUADRILLE_INLINE Doubles sqrt(Doubles a) {
  Doubles root;
  for (int l = 0; l < double_lanes; ++l) root[l] = __builtin_sqrt(a[l]);
  return root;
}
/// a b + c, rounded once.
QUADRILLE_INLINE Doubles fma(Doubles a, Doubles b, Doubles c) {
  Doubles sum;
  for (int l = 0; l < double_lanes; ++l) sum[l] = __builtin_fma(a[l], b[l], c[l]);
  return sum;
}

/// a + b, exactly (Knuth, "The Art of Computer Programming" 2, theorem 4.2.2 B).
QUADRILLE_INLINE DoubleDouble exact_sum(Doubles a, Doubles b) {
  const Doubles sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// a + b where |a| >= |b|, exactly; else within u |b| (Dekker, "A floating-point technique", 1971).
QUADRILLE_INLINE DoubleDouble ordered_sum(Doubles a, Doubles b) {
  const Doubles sum = a + b;
  return {sum, b - (sum - a)};
}

/// a b, exactly, in two ways that give the same numbers: `fused` where the processor multiplies and adds with one
/// rounding, else by halves of 26 bits (Veltkamp and Dekker), for |a|, |b| < 2^990.
template <bool fused>
QUADRILLE_INLINE DoubleDouble exact_product(Doubles a, Doubles b) {
  const Doubles product = a * b;
  if constexpr (fused) return {product, fma(a, b, -product)};
  const auto upper = [](Doubles v) __attribute__((always_inline)) {
    const Doubles scaled = 0x8000001p0 * v;
    return scaled - (scaled - v);
  };
  const Doubles a1 = upper(a), a0 = a - a1, b1 = upper(b), b0 = b - b1;
  return {product, ((a1 * b1 - product) + a1 * b0 + a0 * b1) + a0 * b0};
}

// The algorithms and bounds are those of Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic
// building blocks of double-word arithmetic" (2017).

/// Within 3 u^2 of the sum (and 13 u^3), whatever cancels: of exact operands the sign is right, and 0 means 0.
QUADRILLE_INLINE DoubleDouble accurate_sum(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble s = exact_sum(a.hi, b.hi), t = exact_sum(a.lo, b.lo);
  const DoubleDouble v = ordered_sum(s.hi, s.lo + t.hi);
  return ordered_sum(v.hi, t.lo + v.lo);
}

/// Within 6 u^2 of |a| + |b|.
QUADRILLE_INLINE DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble s = exact_sum(a.hi, b.hi);
  return ordered_sum(s.hi, s.lo + (a.lo + b.lo));
}

QUADRILLE_INLINE DoubleDouble operator-(DoubleDouble a) { return {-a.hi, -a.lo}; }

/// Within 7 u^2 of the product; exact where both lo are 0.
template <bool fused>
QUADRILLE_INLINE DoubleDouble product(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble p = exact_product<fused>(a.hi, b.hi);
  return ordered_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
template <bool fused>
QUADRILLE_INLINE DoubleDouble product(DoubleDouble a, Doubles b) {
  const DoubleDouble p = exact_product<fused>(a.hi, b);
  return ordered_sum(p.hi, p.lo + a.lo * b);
}

/// Within 16 u^2 of 1 / sqrt(a), a > 0: a step of third order from y = the doubles' result, which is within 3 u. With
/// h = 1 - a y^2, of which |h| < 7 u, 1 / sqrt(a) = y (1 + h/2 + 3 h^2 / 8 + ...); h comes of a product near 1, within
/// 15 u^2, of which it is half that.
template <bool fused>
QUADRILLE_INLINE DoubleDouble rsqrt(DoubleDouble a) {
  const Doubles y = 1 / sqrt(a.hi);
  const DoubleDouble one = product<fused>(a, exact_product<fused>(y, y));
  const Doubles h = (1 - one.hi) - one.lo;
  return ordered_sum(y, y * (h * (0.5 + 0.375 * h)));
}

/// Within 8 u^2 of 1 / a: Newton's step from the doubles' result y; the square of its error, below u, is left.
template <bool fused>
QUADRILLE_INLINE DoubleDouble reciprocal(DoubleDouble a) {
  const Doubles y = 1 / a.hi;
  const DoubleDouble one = product<fused>(a, y);
  return ordered_sum(y, y * ((1 - one.hi) - one.lo));
}

}  // namespace quadrille::golden
