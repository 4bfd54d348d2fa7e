// fp_from_signed, fp_multiply, fp_sum, sqrt, reciprocal against exact integers.
#include "model/reciprocal.hpp"
#include "model/significand.hpp"
#include "model/sqrt.hpp"
#include "model/support/prng.hpp"
#include "tb/check/exact_number.hpp"
#include "tb/check/function_tally.hpp"

#include <cmath>
#include <cstdio>

namespace quadrille::cli {
namespace {

using exact::Number;
using exact::Term;
using exact::value_of;
using exact::Wide;
using golden::Prng;

constexpr int operands = 4000;        ///< of each function but the tables
constexpr int all_arguments_to = 17;  ///< significand bits up to which a table is tried whole
constexpr int random_arguments = 1 << 16;

std::string text(const PipelineFloat& v) {
  char out[64];
  std::snprintf(out, sizeof out, "%s0x%x * 2^%d", v.neg ? "-" : "", v.sig, v.exp);
  return out;
}

PipelineFloat random_float(Prng& rng, int s, int exponents) {
  const std::uint32_t half = 1u << (s - 1);
  if (rng.below(16) == 0) return {};
  PipelineFloat v{rng.chance(0.5), static_cast<int>(rng.integer(-exponents, exponents)),
                  half + static_cast<std::uint32_t>(rng.below(half))};
  if (rng.below(8) == 0) v.sig = half;
  if (rng.below(8) == 0) v.sig = 2 * half - 1;
  return v;
}

void check_significand(const SignificandFormat& f, Prng& rng, FunctionTally& tally) {
  for (int n = 0; n < operands; ++n) {
    const int bits = static_cast<int>(rng.below(64));
    auto v = static_cast<std::int64_t>(rng.next() >> (63 - bits) >> 1);
    if (rng.below(4) == 0) v = (std::int64_t{1} << bits >> 1) + static_cast<int>(rng.integer(-1, 1));
    if (rng.chance(0.5)) v = -v;
    const int bias = static_cast<int>(rng.integer(-40, 40));
    const PipelineFloat r = fp_from_signed(v, bias, f);
    tally.expect(exact::is(r, exact::cut({v, bias}, f.s), f.s),
                 [&] { return std::to_string(v) + " * 2^" + std::to_string(bias) + " gives " + text(r); });
  }
}

void check_multiply(const SignificandFormat& f, Prng& rng, FunctionTally& tally) {
  for (int n = 0; n < operands; ++n) {
    const PipelineFloat a = random_float(rng, f.s, 60), b = random_float(rng, f.s, 60);
    const PipelineFloat r = fp_multiply(a, b, f);
    tally.expect(exact::is(r, exact::cut(exact::product(value_of(a, f.s), value_of(b, f.s)), f.s), f.s),
                 [&] { return text(a) + " times " + text(b) + " gives " + text(r); });
  }
}

void check_sum(const SignificandFormat& f, Prng& rng, FunctionTally& tally) {
  for (int n = 0; n < operands; ++n) {
    const std::size_t count = n % 2 == 0 ? 4 : n % 4 == 1 ? 3 : 2;
    // Nearly equal exponents, as far apart as the window is wide, or beyond a shifter's width.
    constexpr int spreads[] = {0, 1, 3};
    const int spread = n % 5 < 3 ? spreads[n % 5] : n % 5 == 3 ? f.s + f.g : 70;
    std::array<PipelineFloat, 4> a, b;
    std::array<RawProduct, 4> raw;
    std::array<Term, 4> terms;
    for (std::size_t i = 0; i < count; ++i) {
      a[i] = random_float(rng, f.s, spread);
      b[i] = random_float(rng, f.s, spread);
      // Terms that cancel, all but their last bits.
      if (i > 0 && rng.below(4) == 0) {
        a[i] = a[i - 1];
        b[i] = b[i - 1];
        a[i].neg = !a[i].neg;
        if (b[i].sig > 1u << (f.s - 1)) b[i].sig -= static_cast<std::uint32_t>(rng.below(2));
      }
      raw[i] = raw_product(a[i], b[i]);
      terms[i] = {value_of(a[i], f.s), value_of(b[i], f.s)};
      if (rng.below(8) == 0) {
        raw[i] = raw_from_fp(a[i], f);
        terms[i].b = {1, 0};
      }
    }
    const PipelineFloat r = fp_sum(std::span<const RawProduct>(raw).first(count), f);
    tally.expect(exact::is(r, exact::sum(std::span<const Term>(terms).first(count), f.s, f.g), f.s), [&] {
      std::string out = "of";
      for (std::size_t i = 0; i < count; ++i) out += (i ? ", (" : " (") + text(a[i]) + ")(" + text(b[i]) + ")";
      return out + " gives " + text(r);
    });
  }
}

/// Arguments of a table: significands of S bits whose leading K fraction bits choose the segment.
template <class Try>
void for_each_argument(int s, int rest_bits, Prng& rng, Try&& attempt) {
  const std::uint32_t half = 1u << (s - 1);
  if (s <= all_arguments_to) {
    for (std::uint32_t sig = half; sig < 2 * half; ++sig) attempt(sig);
    return;
  }
  const std::uint32_t step = 1u << rest_bits;
  for (std::uint32_t first = half; first < 2 * half; first += step)
    for (const std::uint32_t rest : {0u, 1u, step / 4, step / 2, step - step / 4, step - 1})
      if (rest < step) attempt(first + rest);
  for (int n = 0; n < random_arguments; ++n) attempt(half + static_cast<std::uint32_t>(rng.below(half)));
}

/// Limits in units of 2^-3 of the result's last bit as integers of 2^-8 of it, outward.
struct Limits {
  Wide below, above;
  explicit Limits(const TableLimit& limit)
      : below(static_cast<Wide>(std::ceil(limit.below * 32))), above(static_cast<Wide>(std::ceil(limit.above * 32))) {}
};

void check_sqrt(const Config& config, const SignificandFormat& f, Prng& rng, FunctionTally& tally) {
  const Table table = make_sqrt_table(config);
  const Limits limit(sqrt_limit(config));
  const std::uint32_t half = 1u << (f.s - 1);
  const auto attempt = [&](std::uint32_t sig, int exponent) {
    const PipelineFloat a{false, exponent, sig}, r = fp_sqrt(a, table, f);
    const int octave = exponent & 1, whole = (exponent - octave) / 2;
    // sig 2^octave = x 2^(S-1), 1 <= x < 4; the result is t 2^(whole-(S-1)) with t = sqrt(x) 2^(S-1): t^2 = sig
    // 2^(octave+S-1).
    bool right = !r.neg && r.exp == whole && r.sig >> (f.s - 1) == 1;
    if (sig == half && octave == 0) right = right && r.sig == half;
    const Wide square = Wide{sig} << (octave + f.s - 1 + 16);
    const Wide low = (Wide{r.sig} << 8) - limit.above, high = (Wide{r.sig} << 8) + limit.below;
    right = right && low * low <= square && square <= high * high;
    tally.expect(right, [&] { return "of " + text(a) + " gives " + text(r); });
  };
  for_each_argument(f.s, table.rest_bits, rng, [&](std::uint32_t sig) {
    attempt(sig, 0);
    attempt(sig, 1);
  });
  for (int exponent = -301; exponent <= 301; ++exponent) {
    attempt(half, exponent);
    attempt(half + static_cast<std::uint32_t>(rng.below(half)), exponent);
  }
  tally.expect(fp_sqrt({}, table, f) == PipelineFloat{}, [] { return std::string("of zero is not zero"); });
}

void check_reciprocal(const Config& config, const SignificandFormat& f, Prng& rng, FunctionTally& tally) {
  const Table table = make_recip_table(config);
  const Limits limit(reciprocal_limit(config));
  const std::uint32_t half = 1u << (f.s - 1);
  const auto attempt = [&](std::uint32_t sig, int exponent, bool neg) {
    const PipelineFloat a{neg, exponent, sig}, r = reciprocal(a, table, f);
    bool right = r.neg == neg;
    if (sig == half) {
      right = right && r.sig == half && r.exp == -exponent;
    } else {
      // sig = x 2^(S-1), 1 < x < 2; the result is y 2^(-exponent-1) with y = 2/x, in last bits y 2^(S-1) = t: t sig =
      // 2^(2S-1).
      right = right && r.exp == -exponent - 1 && r.sig >> (f.s - 1) == 1;
      const Wide whole = Wide{1} << (2 * f.s - 1 + 8);
      right = right && ((Wide{r.sig} << 8) - limit.above) * sig <= whole &&
              whole <= ((Wide{r.sig} << 8) + limit.below) * sig;
    }
    tally.expect(right, [&] { return "of " + text(a) + " gives " + text(r); });
  };
  for_each_argument(f.s, table.rest_bits, rng, [&](std::uint32_t sig) { attempt(sig, 0, false); });
  for (int exponent = -301; exponent <= 301; ++exponent) {
    attempt(half, exponent, rng.chance(0.5));
    attempt(half + static_cast<std::uint32_t>(rng.below(half)), exponent, rng.chance(0.5));
  }
  tally.expect(reciprocal({}, table, f) == PipelineFloat{}, [] { return std::string("of zero is not zero"); });
}

/// A segment's polynomial interpolates in Chebyshev points, so it misses by `miss` (of the function's values) at most.
/// In units of 2^-(S+3): coefficients are rounded to nearest (1/2 each), `added` are added, t1 and t0 are truncated
/// (one down, one up), and the last truncation takes up to 7 away.
TableLimit table_limit(const Config& config, double miss, int degree, double added) {
  const double rounding = degree == 2 ? 1.5 : 1, polynomial = std::ldexp(miss, config.significand_bits + 3) + rounding;
  constexpr double truncated = 1, units = 8;
  return {units + polynomial + truncated - added, polynomial + truncated + added};
}

}  // namespace

TableLimit sqrt_limit(const Config& config) {
  // x^(1/2)/2: the n-th derivative over n! times 2 (h/4)^n, n = degree + 1; relative to the value largest at x = 1 and
  // 2, and the value is below 1.
  const double h = std::ldexp(1.0, -config.sqrt_segments());
  return table_limit(config, config.sqrt_degree == 2 ? h * h * h / 512 : h * h / 64, config.sqrt_degree, 4);
}

TableLimit reciprocal_limit(const Config& config) {
  const double h = std::ldexp(1.0, -config.recip_segments());
  return table_limit(config, config.recip_degree == 2 ? h * h * h / 32 : h * h / 8, config.recip_degree, 3);
}

void check_arithmetic(const Config& config, std::vector<FunctionResult>& results) {
  const SignificandFormat f{config.significand_bits, config.align_guard_bits};
  FunctionTally significand("significand"), multiply("multiply"), sum("sum"), root("sqrt"), inverse("reciprocal");
  Prng rng(1);
  check_significand(f, rng, significand);
  check_multiply(f, rng, multiply);
  check_sum(f, rng, sum);
  check_sqrt(config, f, rng, root);
  check_reciprocal(config, f, rng, inverse);
  for (const FunctionTally* tally : {&significand, &multiply, &sum, &root, &inverse})
    results.push_back(tally->result());
}

}  // namespace quadrille::cli
