#include "golden/analysis/error_bound.hpp"

#include "golden/analysis/range_proof.hpp"
#include "model/port/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace quadrille {
namespace {

// ---- Relative errors as natural logarithms -------------------------------------------------------------------------
//
// They are of the order 2^-s >= 2^-26; double arithmetic on them errs by less than 2^-45 in all. `widened` covers that.

struct Interval {
  double lo = 0, hi = 0;
};
Interval operator+(Interval a, Interval b) { return {a.lo + b.lo, a.hi + b.hi}; }
Interval operator-(Interval a, Interval b) { return {a.lo - b.hi, a.hi - b.lo}; }
Interval operator*(double a, Interval b) {
  return a >= 0 ? Interval{a * b.lo, a * b.hi} : Interval{a * b.hi, a * b.lo};
}
Interval hull(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

double widened(double bound) { return bound * (1 + 0x1p-16); }

// ---- Tables --------------------------------------------------------------------------------------------------------

/// Extremes on [-1/2, 1/2] of d0 + d1 v + d2 v² + d3 v³.
Interval cubic_range(double d0, double d1, double d2, double d3) {
  const auto at = [&](double v) { return d0 + v * (d1 + v * (d2 + v * d3)); };
  Interval r = hull({at(-0.5), at(-0.5)}, {at(0.5), at(0.5)});
  const double discriminant = d2 * d2 - 3 * d1 * d3;
  if (discriminant < 0) return r;
  // Both roots of d1 + 2 d2 v + 3 d3 v² without cancellation.
  const double sum = -(d2 + std::copysign(std::sqrt(discriminant), d2));
  for (const double v : {sum / (3 * d3), d1 / sum})
    if (std::fabs(v) <= 0.5) r = hull(r, {at(v), at(v)});
  return r;
}

/// Calls visit(m, error) for each segment: m its first significand in [1, 2), error the logarithm of result / f over
/// all its arguments. f = 1/x over one octave, or sqrt(x)/2 (`rising`) over two.
template <class Visit>
void visit_segments(const Table& table, int s, bool rising, Visit visit) {
  const double unit = std::ldexp(1.0, s + Config::table_guard);
  const std::size_t per_octave = std::size_t{1} << table.segments_log2;
  const double rest = 1 - std::ldexp(1.0, -table.rest_bits);  // the largest fraction of a segment
  // Binomial coefficients of (1 + r)^power.
  const double power = rising ? 0.5 : -1, sign = rising ? 1 : -1;
  const double b1 = power, b2 = b1 * (power - 1) / 2, b3 = b2 * (power - 2) / 3, b4 = b3 * (power - 3) / 4;
  const auto f = [&](double x) { return unit * (rising ? std::sqrt(x) / 2 : 1 / x); };
  for (std::size_t i = 0; i < table.entries.size(); ++i) {
    const double octave = i < per_octave ? 1 : 2;
    const double width = octave / static_cast<double>(per_octave);
    const double left = octave + static_cast<double>(i % per_octave) * width;
    const double middle = left + width / 2, step = width / middle, f0 = f(middle);
    const double c0 = table.entries[i].c0, c1 = table.entries[i].c1, c2 = table.entries[i].c2;
    // The polynomial of the ROM minus the Taylor series of f about the middle, and the rest of that series.
    Interval d = cubic_range(c0 + sign * (c1 / 2 - c2 / 4) - f0, sign * (c1 - c2) - f0 * b1 * step,
                             -sign * c2 - f0 * b2 * step * step, -f0 * b3 * step * step * step);
    const double series = f0 * std::fabs(b4) * std::pow(step / 2, 4) / (1 - step / 2);
    // The product with C2 loses less than one unit times dx, and that raises t0; t0 loses less than one unit; the
    // result 7 of 8.
    const double raised = table.entries[i].c2 != 0 ? rest * rest : 0;
    d = d + Interval{-series - (rising ? rest : raised) - 7, series + (rising ? raised : rest)};
    // The clamp moves the result towards f, or f is above the largest significand by less than half of its last bit
    // (the root), or 2^-(s-4) units.
    d = hull(d, {rising ? -4 : -std::ldexp(1.0, 4 - s), 0});
    const double least = f(rising ? left : left + width);
    visit(left / octave, Interval{std::log1p(d.lo / least), std::log1p(d.hi / least)});
  }
}

// ---- What a stored number can be off by ----------------------------------------------------------------------------

/// Of a quotient's factor K: in general, and where no term of the denominator has more than Ingredients::shared of it.
struct Quotient {
  Interval any, shared;

  /// With one more factor.
  friend Quotient operator*(const Quotient& q, Interval factor) { return {q.any + factor, q.shared + factor}; }
};

/// Logarithms of stored / exact.
struct Ingredients {
  double u;           ///< 2^-(s-1)
  double t;           ///< a truncation to S bits is in [-t, 0]
  double sum2;        ///< a sum of two positive terms is in [-sum2, 0]
  double sum4;        ///< of four
  double guard;       ///< 2^-G u: what a term of a sum loses at most, relative to the largest one
  Interval root;      ///< square root of a truncated argument
  double shared;      ///< where no term of the denominator has a larger part of it, the sum loses less
  Quotient quotient;  ///< the denominator's sum and the reciprocal
};

Ingredients ingredients(const Config& c) {
  Ingredients in;
  in.u = std::ldexp(1.0, 1 - c.significand_bits);
  in.t = std::log1p(in.u);
  const double guard = std::ldexp(1.0, -c.align_guard_bits);
  in.sum2 = std::log1p(in.u * (1 + guard));
  in.sum4 = std::log1p(in.u * (1 + 3 * guard));
  in.guard = guard * in.u;
  const TableError root = sqrt_error(c);
  in.root = {root.low, root.high};
  // The denominator's loss is relative to its significand, and so is the error of the reciprocal. Beside the sum's own
  // truncation the terms lose 3·2^-G u of the largest exponent's power of two. If that exponent is below the sum's,
  // that is half as much. If it is the sum's, the largest term is at least that power of two, the sum's significand at
  // least 1 over that term's part of it, and the loss as much less. Neither is more than `half` where no part is larger
  // than `shared`.
  const double all = 1 + 3 * guard, half = 1 + 1.5 * guard;
  in.shared = half / all / (1 + in.u * all);
  Quotient denominator{{0, in.sum4}, {0, std::log1p(in.u * half)}};
  visit_segments(make_recip_table(c), c.significand_bits, false, [&](double m, Interval error) {
    denominator.any = hull(denominator.any, error + Interval{0, std::log1p(in.u * all / m)});
    denominator.shared = hull(denominator.shared, error + Interval{0, std::log1p(in.u * std::min(half, all / m))});
  });
  in.quotient = denominator;
  return in;
}

// ---- The weights M -------------------------------------------------------------------------------------------------
//
// M_i / M_j for the vertices i, j and the others k, l is sqrt(q_jk q_jl / (q_ik q_il)), where q = u = r r' + |D|, or
// A²/u where the terms of q cancel. With c = |D| / (r r') <= 1 and g = 1 / (1 + c) in [1/2, 1], ln û/u = g (ρ + ρ') +
// (1-g) δ + κ by the mean value theorem: ρ the errors of the two roots, δ the truncation of D, κ that of the sum.

/// One of the four pairs of a ratio M_i / M_j.
struct Pair {
  bool above;    ///< in the numerator
  bool cancels;  ///< q = A²/u
  double g;
};

/// Roundings of sqrt(q_above / q_below) behind the two u and A, by either of the ways in which root_ratio may form it.
Interval ratio_roundings(bool above_cancels, bool below_cancels, const Ingredients& in) {
  const Interval down = -1.0 * in.root;
  if (above_cancels && below_cancels) return hull(down, in.root) + Interval{-in.t, in.t};
  if (above_cancels) return down;
  if (below_cancels) return in.root;
  return hull(down, in.root);
}

/// Largest ln of (M̂_i / M_i) / (M̂_j / M_j) over the vertices i, j of one pixel.
double weight_spread(const Ingredients& in, bool w_is_cut = false) {
  const auto width = [](Interval r) { return r.hi - r.lo; };
  // Two edges: r times a sum of r k, or two such terms. A corner at the pixel has no error here.
  const double two_edge = 2 * width(in.root) + 2 * in.sum2 + in.t + (w_is_cut ? in.t : 0);

  // In u the stored and the exact terms are both possible weights of the mean.
  const double least_g = 1 / (1 + std::exp(-2 * in.root.lo));
  double spread = 0;
  // The expression is linear in each g and each error, so its largest value is at a corner of their ranges. Bits of
  // `code`: g of the pairs jk, jl, ik, il, then which of them cancel.
  for (unsigned code = 0; code < 256; ++code) {
    std::array<Pair, 4> pair;
    for (std::size_t n = 0; n < 4; ++n)
      pair[n] = {n < 2, (code >> (4 + n) & 1) != 0, (code >> n & 1) != 0 ? 1 : least_g};
    // The factor of u's logarithm.
    const auto sign = [&](std::size_t n) { return 0.5 * (pair[n].above == pair[n].cancels ? -1 : 1); };
    Interval error{-2 * in.t, 2 * in.t};  // M_i and M_j, two products each
    for (std::size_t n = 0; n < 4; ++n) {
      error = error + sign(n) * (Interval{-in.sum2, 0} + (1 - pair[n].g) * Interval{-in.t, 0});
      if (pair[n].cancels) error = error + (pair[n].above ? 1.0 : -1.0) * Interval{-in.t, 0};  // of A
    }
    // Each vertex is in two of the pairs: j in 0, 1; i in 2, 3; k in 0, 2; l in 1, 3.
    const auto slope = [&](std::size_t n) { return sign(n) * pair[n].g; };
    for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {2, 3}, {0, 2}, {1, 3}})
      error = error + (slope(a) + slope(b)) * in.root;
    // Pairs without a vertex in common share a root: jk with il, jl with ik.
    error = error + ratio_roundings(pair[0].cancels, pair[3].cancels, in) +
            ratio_roundings(pair[1].cancels, pair[2].cancels, in);
    spread = std::max(spread, error.hi);
  }
  return std::max(two_edge, spread);
}

// ---- Quotients of sums ---------------------------------------------------------------------------------------------
//
// A part λ of a sum of positive terms whose relative errors differ by a factor up to q, times a factor K, is within
// K λ / (λ + (1 - λ) q) and K λ q / (λ q + 1 - λ). The largest distances from λ, over λ in [0, 1]:

double rise(double log_q, double log_k) {
  const double x = std::expm1((log_q + log_k) / 2), y = std::expm1(log_q);
  if (x <= 0) return 0;
  return x >= y ? std::expm1(log_k) : x * x / y;
}
double fall(double log_q, double log_k) {
  const double x = std::exp(log_q / 2) - std::exp(log_k / 2);
  return log_q + log_k <= 0 ? -std::expm1(log_k) : x * x / std::expm1(log_q);
}

/// The rise where the stored part p = λ q / (λ q + 1 - λ) or 1 - p is at least `part`. K p - λ is concave in p.
double rise_beyond(double part, double log_q, double log_k) {
  const double y = std::expm1(log_q), peak = 1 - std::expm1((log_q - log_k) / 2) / y;
  if (y <= 0 || peak <= 1 - part || peak >= part) return rise(log_q, log_k);
  const auto at = [&](double p) { return p * (std::expm1(log_k) + (1 - p) * y / (1 + (1 - p) * y)); };
  return std::max(at(part), at(1 - part));
}

/// The largest of `error(rise, K)` over the two cases of a denominator: terms that share it, and one that has most of
/// it; then the group of terms that rises has as much, or the other one.
template <class Error>
double over_denominators(const Ingredients& in, const Quotient& k, double log_q, Error error) {
  return std::max(error(rise(log_q, k.shared.hi), k.shared.hi),
                  error(rise_beyond(in.shared, log_q, k.any.hi), k.any.hi));
}

/// The largest of rise and fall of a quotient of which the factor is `above` when it rises, `below` when it falls.
double quotient_error(const Ingredients& in, double log_q, const Quotient& above, const Quotient& below) {
  const double up = over_denominators(in, above, log_q, [](double rise, double) { return rise; });
  return std::max(up, fall(log_q, below.any.lo));
}

/// Error of base + sum(M D) / sum(M k) before its rounding, relative to the spread of the differences D/k and 0, with a
/// numerator of `terms` terms of any sign (README.md, "Values").
double value_error(const Config& config, int terms, bool w_is_cut) {
  const Ingredients in = ingredients(config);
  const double lost = (terms - 1) * in.guard;
  const Interval w{0, w_is_cut ? in.t : 0};  // of the denominator alone
  return quotient_error(in, weight_spread(in, w_is_cut), in.quotient * (w + Interval{0, std::log1p(lost)}),
                        in.quotient * Interval{std::log1p(-in.u - lost), 0});
}

constexpr int attribute_terms = 3, depth_terms = 4;

enum class Quads { any, ordinary };

/// The best that can be said where the proof's assumptions do not hold; proved where they do, with no value yet.
ErrorBound without_proof(const Config& c, Quads quads) {
  if (!keeps_ordinary_products(c))
    return {
        std::numeric_limits<double>::infinity(), false,
        "quadratic_frac_bits drops bits that D and r² of ordinary vertices have: their relative error has no bound"};
  const double rule = std::ldexp(1.0, 3 - c.significand_bits);
  if (c.qdrop() > 0 && quads == Quads::any)
    return {rule, false, "quadratic_frac_bits drops bits that D and r² of homogeneous vertices have"};
  return {0, true,
          "relative errors of every truncation and of both tables, accumulated over the roots, M and the sums"};
}

}  // namespace

TableError sqrt_error(const Config& config) {
  const double u = std::ldexp(1.0, 1 - config.significand_bits);
  Interval all;
  visit_segments(make_sqrt_table(config), config.significand_bits, true, [&](double m, Interval error) {
    all = hull(all, error - Interval{0, std::log1p(u / m) / 2});
  });
  return {all.lo, all.hi};
}

TableError reciprocal_error(const Config& config) {
  Interval all;
  visit_segments(make_recip_table(config), config.significand_bits, false,
                 [&](double, Interval error) { all = hull(all, error); });
  return {all.lo, all.hi};
}

ErrorBound bound_lambda(const Config& config) {
  ErrorBound bound = without_proof(config, Quads::any);
  if (!bound.proved) return bound;
  const Ingredients in = ingredients(config);
  // The numerator is one product, truncated.
  const double error = quotient_error(in, weight_spread(in), in.quotient, in.quotient * Interval{-in.t, 0});
  bound.value = widened(error + std::ldexp(0.5, -config.attribute_frac()));
  return bound;
}

double value_bound_factor(const Config& config, bool w_is_cut) {
  return widened(std::ldexp(value_error(config, depth_terms, w_is_cut), config.significand_bits - 3));
}

ErrorBound bound_attribute(const Config& config, double spread) {
  ErrorBound bound = without_proof(config, Quads::any);
  const double factor =
      bound.proved ? value_error(config, attribute_terms, false) : bound.value * value_bound_factor(config);
  bound.value = widened(factor * std::fabs(spread) + std::ldexp(0.5, -config.attribute_frac()));
  return bound;
}

ErrorBound bound_depth(const Config& config, double spread) {
  ErrorBound bound = without_proof(config, Quads::ordinary);
  if (!bound.proved) return bound;
  bound.value =
      widened(value_error(config, depth_terms, false) * std::fabs(spread) + std::ldexp(0.5, -config.depth_bits));
  return bound;
}

}  // namespace quadrille
