// Significand arithmetic against exact integers.
#include "model/pixel/significand.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <array>

namespace quadrille {
namespace {

using golden::Prng;
using Wide = __int128;
using UWide = unsigned __int128;

/// The truncation contract: sig·2^exp-(S-1) <= exact < (sig + 1)·2^exp-(S-1), sig with its top bit set. `exact` is
/// numerator · 2^scale.
void expect_truncated(const PipelineFloat& r, UWide numerator, int scale, int s) {
  ASSERT_GE(r.sig, 1u << (s - 1));
  ASSERT_LT(r.sig, 1ull << s);
  const int shift = r.exp - (s - 1) - scale;  // sig · 2^shift against numerator
  if (shift >= 0) {
    ASSERT_LT(shift, 100);
    ASSERT_LE(static_cast<UWide>(r.sig) << shift, numerator);
    ASSERT_GT((static_cast<UWide>(r.sig) + 1) << shift, numerator);
  } else {
    ASSERT_LT(-shift, 64);
    ASSERT_LE(static_cast<UWide>(r.sig), numerator << -shift);
    ASSERT_GT(static_cast<UWide>(r.sig) + 1, numerator << -shift);
  }
}

PipelineFloat random_fp(Prng& rng, int s, int exp_range) {
  if (rng.chance(0.03)) return {};
  std::uint32_t sig = static_cast<std::uint32_t>((1u << (s - 1)) + rng.below(1u << (s - 1)));
  if (rng.chance(0.1)) sig = 1u << (s - 1);
  if (rng.chance(0.1)) sig = static_cast<std::uint32_t>((1ull << s) - 1);
  return {rng.chance(0.5), static_cast<int>(rng.integer(-exp_range, exp_range)), sig};
}

TEST(Significand, FromMagnitude) {
  Prng rng(1);
  for (int s = 8; s <= 26; ++s) {
    const SignificandFormat f{s, 2};
    EXPECT_EQ(fp_from_magnitude(0, 7, f), PipelineFloat{});
    for (std::uint64_t v = 1; v < 5000; ++v) expect_truncated(fp_from_magnitude(v, -3, f), v, -3, s);
    for (int n = 0; n < 20000; ++n) {
      const std::uint64_t v = (rng.next() >> rng.below(64)) | (rng.chance(0.1) ? 0x8000000000000000u : 0u);
      if (v == 0) continue;
      const int bias = static_cast<int>(rng.integer(-40, 40));
      const PipelineFloat r = fp_from_magnitude(v, bias, f);
      expect_truncated(r, v, bias, s);
      EXPECT_FALSE(r.neg);
    }
    expect_truncated(fp_from_magnitude(~0ull, 0, f), ~0ull, 0, s);
    for (int bit = 0; bit < 64; ++bit) {
      const PipelineFloat r = fp_from_magnitude(1ull << bit, 5, f);
      EXPECT_EQ(r, (PipelineFloat{false, bit + 5, 1u << (s - 1)}));
    }
  }
}

TEST(Significand, MultiplyExhaustivelyAtEightBits) {
  const int s = 8;
  const SignificandFormat f{s, 0};
  for (std::uint32_t a = 128; a < 256; ++a)
    for (std::uint32_t b = 128; b < 256; ++b)
      for (int sign = 0; sign < 4; ++sign) {
        const PipelineFloat x{(sign & 1) != 0, 3, a}, y{(sign & 2) != 0, -9, b};
        const PipelineFloat r = fp_multiply(x, y, f);
        expect_truncated(r, static_cast<UWide>(a) * b, x.exp + y.exp - 2 * (s - 1), s);
        ASSERT_EQ(r.neg, sign == 1 || sign == 2);
        // Relative error in (-2^-(S-1), 0].
        const double exact = static_cast<double>(a) * b, got = std::ldexp(r.sig, r.exp - (x.exp + y.exp) + s - 1);
        ASSERT_LE(got, exact);
        ASSERT_GT(got, exact * (1 - 0x1p-7));
      }
  for (std::uint32_t a = 128; a < 256; ++a) {
    EXPECT_EQ(fp_multiply({true, 3, a}, {}, f), PipelineFloat{});
    EXPECT_EQ(fp_multiply({}, {true, 3, a}, f), PipelineFloat{});
    EXPECT_EQ(fp_multiply({true, 3, a}, f.one(), f), (PipelineFloat{true, 3, a})) << "1 is neutral";
  }
}

TEST(Significand, MultiplyRandom) {
  Prng rng(2);
  for (int s = 8; s <= 26; ++s) {
    const SignificandFormat f{s, 2};
    for (int n = 0; n < 30000; ++n) {
      const PipelineFloat a = random_fp(rng, s, 900), b = random_fp(rng, s, 900);
      const PipelineFloat r = fp_multiply(a, b, f);
      if (a.sig == 0 || b.sig == 0) {
        ASSERT_EQ(r, PipelineFloat{});
        continue;
      }
      expect_truncated(r, static_cast<UWide>(a.sig) * b.sig, a.exp + b.exp - 2 * (s - 1), s);
      ASSERT_EQ(r.neg, a.neg != b.neg);
      ASSERT_EQ(r, fp_multiply(b, a, f));
    }
  }
}

/// fp_sum as its definition reads, from exact integers: every term as a fraction of 2^E, cut at S-1+G fraction bits.
PipelineFloat defined_sum(const std::vector<RawProduct>& terms, int s, int g) {
  int largest = -100000;
  for (const RawProduct& t : terms)
    if (t.p != 0) largest = std::max(largest, t.exp);
  Wide sum = 0;
  for (const RawProduct& t : terms) {
    if (t.p == 0) continue;
    // value = p 2^(exp-(2S-2)); in units of 2^(E-(S-1+G)) it is p 2^(exp-E + G - (S-1)).
    int shift = t.exp - largest + g - (s - 1);
    UWide v = t.p;
    for (; shift > 0; --shift) v *= 2;
    for (; shift < 0 && v != 0; ++shift) v /= 2;
    sum += t.neg ? -static_cast<Wide>(v) : static_cast<Wide>(v);
  }
  if (sum == 0) return {};
  UWide m = static_cast<UWide>(sum < 0 ? -sum : sum);
  int exp = largest - g;  // of a number whose bit S-1 is the highest
  while (m >= static_cast<UWide>(1) << s) {
    m /= 2;
    ++exp;
  }
  while (m < static_cast<UWide>(1) << (s - 1)) {
    m *= 2;
    --exp;
  }
  return {sum < 0, exp, static_cast<std::uint32_t>(m)};
}

/// |result - exact| < n 2^(E-(S-1+G)) + 1 ulp of the result, in exact integers; exponents of the terms within 40 of
/// one another.
void expect_sum_bound(const PipelineFloat& r, const std::vector<RawProduct>& terms, int s, int g) {
  int largest = -100000, smallest = 100000;
  for (const RawProduct& t : terms) {
    if (t.p == 0) continue;
    largest = std::max(largest, t.exp);
    smallest = std::min(smallest, t.exp);
  }
  if (largest < smallest) {
    ASSERT_EQ(r, PipelineFloat{});
    return;
  }
  ASSERT_LE(largest - smallest, 40);
  Wide exact = 0;  // units of 2^(smallest-(2S-2)-8)
  for (const RawProduct& t : terms)
    if (t.p != 0) exact += (t.neg ? -1 : 1) * (static_cast<Wide>(t.p) << (t.exp - smallest + 8));
  const int unit = smallest - (2 * s - 2) - 8;
  const auto scaled = [&](Wide v, int exponent) {
    return exponent >= unit ? v << (exponent - unit) : v >> (unit - exponent);
  };
  const Wide got = (r.neg ? -1 : 1) * scaled(r.sig, r.exp - (s - 1));
  const Wide bound =
      scaled(static_cast<Wide>(terms.size()), largest - (s - 1 + g)) + (r.sig != 0 ? scaled(1, r.exp - (s - 1)) : 0);
  const Wide error = got > exact ? got - exact : exact - got;
  ASSERT_LT(error, bound);
}

TEST(Significand, SumExhaustivelyAtEightBits) {
  const int s = 8;
  for (int g = 0; g <= 6; ++g) {
    const SignificandFormat f{s, g};
    for (int difference = 0; difference <= 20; ++difference)
      for (std::uint32_t a = 128; a < 256; a += (difference > 10 ? 5 : 1))
        for (std::uint32_t b = 128; b < 256; b += (g > 2 ? 3 : 1))
          for (const bool negative : {false, true}) {
            const std::vector<RawProduct> terms{raw_from_fp({false, 2, a}, f),
                                                raw_from_fp({negative, 2 - difference, b}, f)};
            const PipelineFloat r = fp_sum(terms, f);
            ASSERT_EQ(r, defined_sum(terms, s, g));
            expect_sum_bound(r, terms, s, g);
          }
  }
}

TEST(Significand, SumRandom) {
  Prng rng(3);
  int cancelled = 0, zeros = 0;
  for (int s = 8; s <= 26; ++s)
    for (int g = 0; g <= 6; ++g) {
      const SignificandFormat f{s, g};
      for (int n = 0; n < 4000; ++n) {
        const int range = static_cast<int>(rng.below(21));
        std::vector<RawProduct> terms;
        for (std::size_t count = rng.chance(0.5) ? 2 : 4; terms.size() < count;) {
          const PipelineFloat a = random_fp(rng, s, range), b = random_fp(rng, s, 0);
          terms.push_back(rng.chance(0.5) ? raw_product(a, b) : raw_from_fp(a, f));
        }
        if (rng.chance(0.2)) {  // near or full cancellation
          terms[1] = terms[0];
          terms[1].neg = !terms[0].neg;
          if (rng.chance(0.5) && terms[1].p > std::uint64_t{1} << (2 * s - 2)) terms[1].p -= rng.below(2);
        }
        const PipelineFloat r = fp_sum(terms, f);
        ASSERT_EQ(r, defined_sum(terms, s, g)) << "S " << s << " G " << g;
        expect_sum_bound(r, terms, s, g);
        zeros += r.sig == 0;
        cancelled += r.sig != 0 && r.exp < std::max(terms[0].exp, terms[1].exp) - 4;
      }
    }
  EXPECT_GT(zeros, 1000);
  EXPECT_GT(cancelled, 100);
}

TEST(Significand, SumOfFarExponentsAndZeros) {
  for (int s = 8; s <= 26; ++s) {
    const SignificandFormat f{s, 2};
    const PipelineFloat big{false, 1500, (1u << (s - 1)) | 1}, small{true, -1500, 1u << (s - 1)};
    EXPECT_EQ(fp_sum({raw_from_fp(big, f), raw_from_fp(small, f)}, f), big);
    EXPECT_EQ(fp_sum({RawProduct{}, raw_from_fp(small, f)}, f), small);
    EXPECT_EQ(fp_sum({RawProduct{}, RawProduct{true, 2000, 0}}, f), PipelineFloat{});
    EXPECT_EQ(fp_sum({RawProduct{true, 2000, 0}, raw_from_fp(small, f)}, f), small)
        << "a zero's exponent counts for nothing";
    EXPECT_EQ(fp_sum({raw_from_fp(big, f), raw_from_fp({true, big.exp, big.sig}, f)}, f), PipelineFloat{});
  }
}

}  // namespace
}  // namespace quadrille
