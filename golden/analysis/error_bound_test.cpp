// The proofs against what can be computed without them: extreme inputs, every argument of a table, narrower widths, and
// the largest errors that climbing has found.
#include "golden/analysis/error_bound.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <span>
#include <string>

namespace quadrille {
namespace {

Config with_significand(int s) {
  Config c;
  c.significand_bits = s;
  c.validate();
  return c;
}

/// What the headers of sqrt and reciprocal say is proved, in units of 2^-(S-1).
TEST(TableErrors, AreWithinWhatTheHeadersSay) {
  for (int s = 8; s <= 26; ++s) {
    const Config c = with_significand(s);
    const double unit = std::ldexp(1.0, 1 - s);
    const TableError root = sqrt_error(c), inverse = reciprocal_error(c);
    EXPECT_TRUE(std::expm1(root.low) > -1.13 * unit && std::expm1(root.high) < 0.76 * unit) << "s " << s;
    EXPECT_TRUE(std::expm1(inverse.low) > -0.76 * unit && std::expm1(inverse.high) < 0.65 * unit) << "s " << s;
  }
}

/// Every argument: the analysis is never below the truth, and above it by little.
TEST(TableErrors, HoldForEveryArgument) {
  for (int s = 8; s <= 17; ++s)
    for (int degree = 1; degree <= 2; ++degree)
      for (const int segments : {-1, 4}) {
        Config c;
        c.significand_bits = s;
        c.sqrt_degree = c.recip_degree = degree;
        c.sqrt_segments_log2 = c.recip_segments_log2 = segments;
        c.validate();
        const SignificandFormat f{s, 2};
        const Table root = make_sqrt_table(c), inverse = make_recip_table(c);
        TableError seen_root, seen_inverse;
        const auto see = [](TableError& seen, double log) {
          seen.low = std::min(seen.low, log);
          seen.high = std::max(seen.high, log);
        };
        const double one = std::ldexp(1.0, s - 1);
        for (std::uint32_t sig = 1u << (s - 1); sig < 1u << s; ++sig) {
          const double x = sig / one, next = (sig + 1.0) / one;
          const PipelineFloat y = reciprocal({false, 0, sig}, inverse, f);
          see(seen_inverse, std::log(std::ldexp(y.sig / one, y.exp) * x));
          for (int octave = 0; octave < 2; ++octave) {
            const PipelineFloat r = fp_sqrt({false, octave, sig}, root, f);
            // The argument stands for everything in [x, next).
            const double result = std::ldexp(r.sig / one, r.exp);
            see(seen_root, std::log(result / std::sqrt(std::ldexp(x, octave))));
            see(seen_root, std::log(result / std::sqrt(std::ldexp(next, octave))));
          }
        }
        const auto compare = [&](const char* name, const TableError& bound, const TableError& seen) {
          const std::string where = std::string(name) + " s " + std::to_string(s) + " degree " +
                                    std::to_string(degree) + " segments " + std::to_string(segments);
          EXPECT_LE(bound.low, seen.low) << where;
          EXPECT_GE(bound.high, seen.high) << where;
          const double slack = std::ldexp(0.4, -s);
          EXPECT_GE(bound.low, 1.1 * seen.low - slack) << where;
          EXPECT_LE(bound.high, 1.1 * seen.high + slack) << where;
        };
        compare("sqrt", sqrt_error(c), seen_root);
        compare("reciprocal", reciprocal_error(c), seen_inverse);
      }
}

/// Largest |Δλ'| in units of 2^-s that `quadrille stress --search --leave` has found: tb/MEASUREMENTS.md,
/// Errors.
TEST(ErrorBound, LiesAboveWhatClimbingFindsAndNotFar) {
  const std::pair<int, double> found[] = {{8, 3.39}, {12, 3.50}, {18, 3.46}, {26, 3.66}};
  for (const auto& [s, units] : found) {
    const double bound = std::ldexp(bound_lambda(with_significand(s)).value, s);
    EXPECT_GT(bound, units);
    EXPECT_LT(bound, 4 * units);
  }
}

/// The rule of thumb that is checked everywhere, 2^-(s-3), is what is proved of the machine as it is configured.
TEST(ErrorBound, ProvesTheRule) {
  for (int s = 8; s <= 26; ++s) {
    const ErrorBound bound = bound_lambda(with_significand(s));
    EXPECT_TRUE(bound.proved);
    EXPECT_LE(bound.value, std::ldexp(1.0, 3 - s)) << s;
  }
}

/// What a sum of four positive products loses, against what the bound takes for it: the less where no term has most of
/// the sum. Terms with many ones behind the window, sums a little above a power of two.
TEST(ErrorBound, HoldsWhatASumOfFourLoses) {
  for (const int s : {8, 12, 26})
    for (int g = 0; g <= 3; ++g) {
      const SignificandFormat f{s, g};
      const double u = std::ldexp(1.0, 1 - s), guard = std::ldexp(1.0, -g);
      const double all = 1 + 3 * guard, half = 1 + 1.5 * guard, part = half / all / (1 + u * all);
      golden::Prng rng(static_cast<std::uint64_t>(100 * s + g));
      double nearest = 0, nearest_shared = 0;
      for (int n = 0; n < 400'000; ++n) {
        std::array<RawProduct, 4> term;
        double sum = 0, largest = 0;
        const double first = rng.uniform(0, 2);
        for (std::size_t i = 0; i < 4; ++i) {
          const std::uint64_t low = std::uint64_t{1} << (s - 1);
          const PipelineFloat a{false, 0, static_cast<std::uint32_t>(low + rng.below(low))};
          const int exp = i == 0 ? 0 : -static_cast<int>(rng.below(i < 2 ? 2 : 12));
          // The first ones near 1 or 1/2, or anything.
          const PipelineFloat b{
              false, exp, static_cast<std::uint32_t>(low + (first < 1 ? rng.below(1 + low / 32) : rng.below(low)))};
          term[i] = raw_product(a, b);
          const double value = std::ldexp(static_cast<double>(term[i].p), term[i].exp - (2 * s - 2));
          sum += value;
          largest = std::max(largest, value);
        }
        const PipelineFloat stored = fp_sum(term, f);
        const double m = std::ldexp(static_cast<double>(stored.sig), 1 - s);
        const double lost = (sum - std::ldexp(m, stored.exp)) / std::ldexp(m, stored.exp);
        ASSERT_LE(lost, u * all / m);
        nearest = std::max(nearest, lost / (u * all));
        if (largest > part * sum) continue;
        ASSERT_LE(lost, u * std::min(half, all / m)) << "S " << s << ", G " << g << ", sum " << sum;
        nearest_shared = std::max(nearest_shared, lost / (u * half));
      }
      std::printf("S = %d, G = %d: %.2f of what any sum may lose, %.2f where the terms share it\n", s, g, nearest,
                  nearest_shared);
      EXPECT_GT(nearest_shared, 0.8);
    }
}

/// Every term of first order is a truncation or a table's error, both proportional to 2^-s; the tables' segments differ
/// from width to width by a few percent of that.
TEST(ErrorBound, OneMoreBitHalvesIt) {
  for (int s = 8; s < 26; ++s) {
    const ErrorBound wide = bound_lambda(with_significand(s)), narrow = bound_lambda(with_significand(s + 1));
    EXPECT_TRUE(wide.proved && narrow.proved);
    EXPECT_NEAR(narrow.value / wide.value, 0.5, 0.025) << s;
  }
}

/// c <= 1.1 at every width with the default guard bits, 1.25 where W is cut; more guard bits, less.
TEST(ErrorBound, ProvesTheFactorOfValues) {
  for (int s = 8; s <= 26; ++s) {
    double before = 2.3;
    for (int g = 0; g <= 6; ++g) {
      Config c = with_significand(s);
      c.align_guard_bits = g;
      const double factor = value_bound_factor(c), of_cut_w = value_bound_factor(c, true);
      EXPECT_LT(factor, of_cut_w);
      EXPECT_LT(of_cut_w, before);
      before = of_cut_w;
      EXPECT_LE(factor, g >= 2 ? 1.1 : 2) << "s " << s << ", G " << g;
      EXPECT_LE(of_cut_w, g >= 2 ? 1.25 : 2.3) << "s " << s;
      // Fewer terms lose less, and one weight is a value.
      const double rule = std::ldexp(1.0, 3 - s), code = std::ldexp(0.5, -c.attribute_frac());
      EXPECT_LT(bound_attribute(c, 1).value, rule * factor + code);
      EXPECT_GT(bound_attribute(c, 1).value, bound_lambda(c).value);
      EXPECT_NEAR(bound_depth(c, 1).value, rule * factor + std::ldexp(0.5, -c.depth_bits), rule * 1e-4);
    }
  }
}

/// What a sum of products of any signs loses, against what the bound takes for it: of one sign u + (n-1) g of itself;
/// of both, (n-1) g of the largest term away from zero, u of the sum and that much toward it.
TEST(ErrorBound, HoldsWhatASumOfAnySignsLoses) {
  for (const int s : {8, 26})
    for (int g = 0; g <= 3; ++g)
      for (const std::size_t n : {std::size_t{3}, std::size_t{4}}) {
        const SignificandFormat f{s, g};
        const double u = std::ldexp(1.0, 1 - s), grain = std::ldexp(u, -g) * static_cast<double>(n - 1);
        golden::Prng rng(static_cast<std::uint64_t>(1000 * s + 10 * g) + n);
        double away = 0, toward = 0;
        for (int trial = 0; trial < 300'000; ++trial) {
          std::array<RawProduct, 4> term;
          const std::uint64_t low = std::uint64_t{1} << (s - 1);
          __int128 sum = 0;  // in units of 2^(-2 s - 60)
          double largest = 0;
          const int far = static_cast<int>(rng.below(3)) * s;
          for (std::size_t i = 0; i < n; ++i) {
            const auto significand = [&] {
              return static_cast<std::uint32_t>(rng.chance(0.4) ? low + rng.below(3) : low + rng.below(low));
            };
            const int exp =
                i == 0 ? 0 : -static_cast<int>(rng.below(static_cast<std::uint64_t>(std::min(3 + far, 50))));
            const PipelineFloat a{rng.chance(0.5), 0, significand()}, b{false, exp, significand()};
            term[i] = raw_product(a, b);
            const __int128 value = static_cast<__int128>(term[i].p) << (62 + exp);
            sum += term[i].neg ? -value : value;
            largest = std::max(largest, static_cast<double>(value));
          }
          const PipelineFloat stored = fp_sum(std::span<const RawProduct>(term).first(n), f);
          const auto magnitude = static_cast<__int128>(stored.sig);
          const int shift = stored.exp + s - 1 + 62;
          const __int128 kept = stored.sig == 0 ? 0 : shift >= 0 ? magnitude << shift : magnitude >> -shift;
          const bool neg = stored.sig == 0 ? sum < 0 : stored.neg;
          const auto lost = static_cast<double>((neg ? -sum : sum) - kept), size = std::fabs(static_cast<double>(sum));
          ASSERT_LE(-lost, grain * largest * (1 + u));
          ASSERT_LE(lost, u * size + grain * largest * (1 + u));
          away = std::max(away, -lost / (grain * largest));
          toward = std::max(toward, lost / (u * size + grain * largest));
        }
        EXPECT_GT(away, 0.5) << "S " << s << ", G " << g << ", " << n << " terms";
        EXPECT_GT(toward, 0.5);
      }
}

TEST(ErrorBound, FollowsTheConfiguration) {
  const Config standard;
  for (int g = 0; g < 6; ++g) {
    Config less = standard, more = standard;
    less.align_guard_bits = g;
    more.align_guard_bits = g + 1;
    EXPECT_GT(bound_lambda(less).value, bound_lambda(more).value);
    EXPECT_GT(bound_attribute(less, 1).value, bound_attribute(more, 1).value);
    EXPECT_GT(bound_depth(less, 1).value, bound_depth(more, 1).value);
  }
  // A coarse table has an error of its own, in M and in the quotient.
  for (const char* key : {"sqrt_segments_log2", "recip_segments_log2"}) {
    Config coarse = with_significand(24);
    const double fine = bound_lambda(coarse).value;
    coarse.set(key, 3);
    EXPECT_GT(bound_lambda(coarse).value, 4 * fine) << key;
  }
  // Half a code of the output's grid is added once.
  Config grid = standard;
  grid.attribute_frac_bits = 18;
  EXPECT_NEAR(bound_attribute(grid, 1).value - bound_attribute(standard, 1).value, 0x1p-19 - 0x1p-25, 0x1p-32);
  // An attribute's error is proportional to its spread beyond that grid.
  EXPECT_NEAR(bound_attribute(standard, 4).value - 0x1p-25, 4 * (bound_attribute(standard, 1).value - 0x1p-25),
              0x1p-30);
  EXPECT_NEAR(bound_attribute(standard, 0).value, 0x1p-25, 0x1p-40);
}

TEST(ErrorBound, IsNotClaimedWithoutItsAssumptions) {
  Config homogeneous, dropped;
  homogeneous.quadratic_frac_bits = 16;  // all bits of positions on the grid of 1/256
  dropped.quadratic_frac_bits = 15;
  const double rule = 0x1p-15;
  EXPECT_FALSE(bound_lambda(homogeneous).proved);
  EXPECT_EQ(bound_lambda(homogeneous).value, rule);
  EXPECT_FALSE(bound_attribute(homogeneous, 3).proved);
  EXPECT_NEAR(bound_attribute(homogeneous, 3).value, 3 * rule * value_bound_factor(homogeneous) + 0x1p-25, 0x1p-28);
  EXPECT_FALSE(bound_lambda(homogeneous).reason.empty());
  EXPECT_TRUE(bound_depth(homogeneous, 1).proved);
  EXPECT_EQ(bound_depth(homogeneous, 1).value, bound_depth(Config{}, 1).value);
  for (const ErrorBound& b : {bound_lambda(dropped), bound_attribute(dropped, 1), bound_depth(dropped, 1)}) {
    EXPECT_FALSE(b.proved);
    EXPECT_TRUE(std::isinf(b.value));
  }
  EXPECT_TRUE(bound_lambda(Config{}).proved);
}

}  // namespace
}  // namespace quadrille
