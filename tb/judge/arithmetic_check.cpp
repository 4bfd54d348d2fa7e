// fp_from_signed, fp_multiply, fp_sum, sqrt, reciprocal against exact integers.
#include "golden/reference/rsqrt.hpp"
#include "model/support/float113.hpp"
#include "model/support/prng.hpp"
#include "tb/judge/function_tally.hpp"
#include "tb/judge/stage_judge.hpp"

#include <bit>
#include <cmath>
#include <cstdio>

namespace quadrille::tb {
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
  const TableLimit limit = sqrt_limit(config);
  const std::uint32_t half = 1u << (f.s - 1);
  const auto attempt = [&](const PipelineFloat& a) {
    const PipelineFloat r = fp_sqrt(a, table, f);
    tally.expect(is_sqrt(a, r, limit, f.s), [&] { return "of " + text(a) + " gives " + text(r); });
  };
  for_each_argument(f.s, table.rest_bits, rng, [&](std::uint32_t sig) {
    attempt({false, 0, sig});
    attempt({false, 1, sig});
  });
  for (int exponent = -301; exponent <= 301; ++exponent) {
    attempt({false, exponent, half});
    attempt({false, exponent, half + static_cast<std::uint32_t>(rng.below(half))});
  }
  attempt({});
}

void check_reciprocal(const Config& config, const SignificandFormat& f, Prng& rng, FunctionTally& tally) {
  const Table table = make_recip_table(config);
  const TableLimit limit = reciprocal_limit(config);
  const std::uint32_t half = 1u << (f.s - 1);
  const auto attempt = [&](const PipelineFloat& a) {
    const PipelineFloat r = reciprocal(a, table, f);
    tally.expect(is_reciprocal(a, r, limit, f.s), [&] { return "of " + text(a) + " gives " + text(r); });
  };
  for_each_argument(f.s, table.rest_bits, rng, [&](std::uint32_t sig) { attempt({false, 0, sig}); });
  for (int exponent = -301; exponent <= 301; ++exponent) {
    attempt({rng.chance(0.5), exponent, half});
    attempt({rng.chance(0.5), exponent, half + static_cast<std::uint32_t>(rng.below(half))});
  }
  attempt({});
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

bool is_sqrt(const PipelineFloat& a, const PipelineFloat& r, const TableLimit& limit, int s) {
  if (a.sig == 0) return r == PipelineFloat{};
  const int octave = a.exp & 1, whole = (a.exp - octave) / 2;
  if (r.neg || r.exp != whole || r.sig >> (s - 1) != 1) return false;
  // At a power of four the result is C0 truncated, exactly while the table misses by less than the half that C0 has.
  if (std::has_single_bit(a.sig) && octave == 0 && limit.above < 9.5 && r.sig != a.sig) return false;
  // sig 2^octave = x 2^(S-1), 1 <= x < 4; the result is t 2^(whole-(S-1)) with t = sqrt(x) 2^(S-1): t^2 = sig
  // 2^(octave+S-1).
  const Limits limits(limit);
  const Wide square = Wide{a.sig} << (octave + s - 1 + 16);
  const Wide low = (Wide{r.sig} << 8) - limits.above, high = (Wide{r.sig} << 8) + limits.below;
  return low * low <= square && square <= high * high;
}

bool is_reciprocal(const PipelineFloat& a, const PipelineFloat& r, const TableLimit& limit, int s) {
  if (a.sig == 0) return r == PipelineFloat{};
  if (std::has_single_bit(a.sig)) return r == PipelineFloat{a.neg, -a.exp, a.sig};
  if (r.neg != a.neg || r.exp != -a.exp - 1 || r.sig >> (s - 1) != 1) return false;
  // sig = x 2^(S-1), 1 < x < 2; the result is y 2^(-exponent-1) with y = 2/x, in last bits y 2^(S-1) = t: t sig =
  // 2^(2S-1).
  const Limits limits(limit);
  const Wide whole = Wide{1} << (2 * s - 1 + 8);
  return ((Wide{r.sig} << 8) - limits.above) * a.sig <= whole && whole <= ((Wide{r.sig} << 8) + limits.below) * a.sig;
}

std::string table_fault(bool sqrt, const Config& config, std::size_t index, const TableEntry& entry) {
  const std::size_t segments = std::size_t{1} << (sqrt ? config.sqrt_segments() : config.recip_segments());
  const bool quadratic = (sqrt ? config.sqrt_degree : config.recip_degree) == 2;
  const Float113 h = (index < segments ? 1.0 : 2.0) / static_cast<double>(segments);
  const Float113 x0 = (index < segments ? 1 : 2) + h * static_cast<double>(index % segments);
  // In units of 2^-(S+3), at the Chebyshev points 1/2 - c, 1/2, 1/2 + c; the line goes through the outer two.
  const double unit = std::ldexp(1.0, config.significand_bits + Config::table_guard);
  const auto at = [&](Float113 u) {
    const Float113 x = x0 + h * u, r = golden::rsqrt(x);
    return unit * (sqrt ? x * r / 2 : r * r);
  };
  const Float113 three = 3, two = 2, c = quadratic ? three * golden::rsqrt(three) / 4 : two * golden::rsqrt(two) / 4;
  const Float113 low = at(0.5 - c), middle = at(0.5), high = at(0.5 + c), slope = (high - low) / (2 * c);
  const Float113 a2 = quadratic ? (high - 2 * middle + low) / (2 * c * c) : 0, a1 = slope - a2,
                 a0 = (quadratic ? middle : (low + high) / 2) - slope / 2 + a2 / 4;
  const double sign = sqrt ? 1 : -1;
  struct Coefficient {
    const char* name;
    std::uint32_t actual;
    Float113 exact;
  };
  // To nearest, ties apart: the program's own root ends more than 30 bits below them.
  for (const auto& [name, actual, exact] : {Coefficient{"c0", entry.c0, a0 + (sqrt ? 4 : 3)},
                                            Coefficient{"c1", entry.c1, sign * a1},
                                            {"c2", entry.c2, -sign * a2}})
    if (const auto off = static_cast<double>(exact - actual); std::fabs(off) > 0.5 + 0x1p-20)
      return std::string(name) + ": expected " + std::to_string(std::llround(static_cast<double>(exact))) +
             ", actual " + std::to_string(actual);
  return "";
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

}  // namespace quadrille::tb
