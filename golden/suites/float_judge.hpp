// What floating point says of one vector: a value is the integer or lies in the span that the stage's truncations can
// leave. Of the float engine alone.
#pragma once

#include "golden/reference/port_number.hpp"
#include "golden/suites/stage_suite.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace quadrille::vectors::floating {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "64-bit integers must fit a long double");

/// Relative rounding of a few operations in Real: 2^-64 each.
inline constexpr Real rounding = 0x1p-60L;

// ---- Verdicts ----

/// Collects what the fields of one vector say; the first difference counts.
class Judge {
 public:
  void same(const char* name, int index, Real actual, Real expected) {
    within(name, index, actual, expected, expected);
  }

  void within(const char* name, int index, Real actual, Real lowest, Real highest) {
    compared_ = true;
    if (!(actual >= lowest && actual <= highest)) differs(name, index, actual, lowest, highest);
  }

  void differs(const char* name, int index, Real actual, Real lowest, Real highest) {
    char text[200];
    const std::string label = index < 0 ? name : std::string(name) + "[" + std::to_string(index) + "]";
    if (lowest == highest)
      std::snprintf(text, sizeof text, "%s: expected %.12Lg, actual %.12Lg", label.c_str(), lowest, actual);
    else
      std::snprintf(text, sizeof text, "%s: expected %.12Lg to %.12Lg, actual %.12Lg", label.c_str(), lowest, highest,
                    actual);
    differs(text);
  }
  void differs(std::string text) {
    if (difference_.empty()) difference_ = std::move(text);
  }

  void undecided() { undecided_ = true; }

  VectorOutcome outcome() const {
    if (!difference_.empty()) return {VectorOutcome::Kind::mismatch, difference_};
    return {undecided_ ? VectorOutcome::Kind::undefined : VectorOutcome::Kind::match, {}, compared_ || !undecided_};
  }

 private:
  std::string difference_;
  bool undecided_ = false, compared_ = false;
};

// ---- Significand numbers ----

/// PipelineFloat or PortNumber.
template <class Number>
inline Real value_of(const Number& v, int s) {
  const Real magnitude = ldexpl(static_cast<Real>(v.sig), v.exp - (s - 1));
  return v.neg ? -magnitude : magnitude;
}

/// Where a real number lies.
struct Span {
  Real lo = 0, hi = 0;
};

inline Span exactly(Real v) { return {v, v}; }
inline Span operator+(Span a, Span b) { return {a.lo + b.lo, a.hi + b.hi}; }
/// Of magnitudes.
inline Span operator*(Span a, Span b) { return {a.lo * b.lo, a.hi * b.hi}; }
inline Span magnitude(Span v) {
  if (v.lo >= 0) return v;
  if (v.hi <= 0) return {-v.hi, -v.lo};
  return {0, std::max(-v.lo, v.hi)};
}

/// What a configuration loses where, rtl/SPEC.md, Widths.
struct Losses {
  explicit Losses(const Config& c)
      : s(c.significand_bits), unit(ldexpl(1, -(s - 1))), grain(ldexpl(1, -c.prec_bits())) {
    // A polynomial through Chebyshev points misses by f^(n)/n! · 2 (h/4)^n, n = degree + 1, h the width of a segment;
    // of 1/x and x^(1/2), relative to them, that is largest at x = 1 (and 2).
    const Real h_recip = ldexpl(1, -c.recip_segments()), h_sqrt = ldexpl(1, -c.sqrt_segments());
    reciprocal = unit + (c.recip_degree == 2 ? h_recip * h_recip * h_recip / 32 : h_recip * h_recip / 8);
    sqrt = unit + (c.sqrt_degree == 2 ? h_sqrt * h_sqrt * h_sqrt / 512 : h_sqrt * h_sqrt / 64);
  }

  int s;
  Real unit;              ///< u = 2^-(s-1): a truncation to S bits leaves (1 - u, 1] of the value
  Real grain;             ///< of the largest term: a term of an aligned sum loses less than that
  Real reciprocal, sqrt;  ///< relative errors: u, and what the polynomial of a segment misses

  /// Truncated toward zero to S bits.
  Span cut(Span v) const { return {v.lo > 0 ? v.lo * (1 - unit) : v.lo, v.hi < 0 ? v.hi * (1 - unit) : v.hi}; }

  /// Of exact roots what the table makes of them.
  Span rooted(Span v) const { return {v.lo * (1 - sqrt), v.hi * (1 + sqrt)}; }

  /// A sum of exact terms, aligned and truncated: every term loses magnitude, so positive ones pull down, negative ones
  /// up. The largest exponent is never above that of the largest term.
  template <std::size_t Count>
  Span sum(const std::array<Real, Count>& terms) const {
    Real total = 0, largest = 0, size = 0;
    for (const Real t : terms) total += t, size += fabsl(t), largest = std::max(largest, fabsl(t));
    Span v{total - rounding * size, total + rounding * size};
    for (const Real t : terms) (t > 0 ? v.lo : v.hi) += (t > 0 ? -1 : t < 0 ? 1 : 0) * grain * largest;
    return cut(v);
  }
};

/// The number must be normalised (or zero with all fields 0) and in the span, but for Real's own rounding.
template <class Number>
inline void check_number(Judge& judge, const char* name, int index, const Number& actual, Span expected,
                         const Losses& l) {
  const Real v = value_of(actual, l.s);
  if (actual.sig == 0 ? actual.neg || actual.exp != 0 : actual.sig >> (l.s - 1) != 1)
    return judge.differs(std::string(name) + (index < 0 ? "" : "[" + std::to_string(index) + "]") +
                         ": not a normalised number");
  const Real lo = expected.lo - rounding * fabsl(expected.lo), hi = expected.hi + rounding * fabsl(expected.hi);
  judge.within(name, index, v, lo, hi);
}

// ---- Integers ----

/// A sum of integers, evaluated in Real: exact while every term and every partial sum stays below 2^64.
struct IntegerSum {
  Real value = 0, size = 0;
  bool exact = true;

  void add(Real term) {
    value += term;
    size += fabsl(term);
    exact = exact && fabsl(term) < 0x1p64L && fabsl(value) < 0x1p64L;
  }
  Real tolerance() const { return exact ? 0 : size * rounding; }
  bool decided() const { return value == 0 ? tolerance() == 0 : fabsl(value) > tolerance(); }
  int sign() const { return (value > 0) - (value < 0); }
};

inline void check_integer(Judge& judge, const char* name, int index, Real actual, const IntegerSum& expected) {
  judge.within(name, index, actual, expected.value - expected.tolerance(), expected.value + expected.tolerance());
}

/// The same after an arithmetic shift right.
inline void check_shifted(Judge& judge, const char* name, int index, Real actual, const IntegerSum& expected,
                          int drop) {
  judge.within(name, index, actual, floorl(ldexpl(expected.value - expected.tolerance(), -drop)),
               floorl(ldexpl(expected.value + expected.tolerance(), -drop)));
}

}  // namespace quadrille::vectors::floating
