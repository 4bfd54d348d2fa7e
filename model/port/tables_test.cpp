// The sqrt and reciprocal tables over their whole domain, judged by exact integer comparisons.
#include "model/port/tables.hpp"

#include "model/pixel/reciprocal.hpp"
#include "model/pixel/sqrt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstdio>
#include <string>

namespace quadrille {
namespace {

/// Errors in ulp of the S-bit result, signed: result minus exact value.
struct Findings {
  double lowest = 0, highest = 0;
  std::uint64_t cases = 0, unfaithful = 0, rises = 0;  ///< rises: places where a larger argument gave a larger result

  double worst() const { return std::max(-lowest, highest); }
  bool faithful() const { return unfaithful == 0; }
};

Config config_for(int s, int degree) {
  Config c;
  c.significand_bits = s;
  c.sqrt_degree = c.recip_degree = degree;
  c.validate();
  return c;
}

/// Every argument in [1, 2). Exact result 2^(2S-1) / sig in units of 2^-S: |y - exact| < 1 is |y·sig - 2^(2S-1)| < sig.
Findings check_reciprocal(const Config& c) {
  const int s = c.significand_bits;
  const SignificandFormat f{s, 2};
  const Table table = make_recip_table(c);
  Findings r;
  std::uint64_t before = 1ull << s;
  for (std::uint64_t sig = 1ull << (s - 1); sig < 1ull << s; ++sig) {
    const PipelineFloat got = reciprocal({false, 0, static_cast<std::uint32_t>(sig)}, table, f);
    const std::uint64_t y = static_cast<std::uint64_t>(got.sig) << (got.exp + 1);  // exp is 0 or -1
    const std::int64_t off = static_cast<std::int64_t>(y * sig) - static_cast<std::int64_t>(1ull << (2 * s - 1));
    const double ulp = static_cast<double>(off) / static_cast<double>(sig);
    r.lowest = std::min(r.lowest, ulp);
    r.highest = std::max(r.highest, ulp);
    r.unfaithful += static_cast<std::uint64_t>(off < 0 ? -off : off) >= sig;
    r.rises += y > before;
    before = y;
    ++r.cases;
  }
  return r;
}

/// Every argument in [1, 4). Exact result e = sqrt(sig 2^(S-1+p)) in units of 2^-(S-1): y - 1 < e < y + 1 by squares.
Findings check_sqrt(const Config& c) {
  const int s = c.significand_bits;
  const SignificandFormat f{s, 2};
  const Table table = make_sqrt_table(c);
  Findings r;
  std::uint64_t before = 0;
  for (int p = 0; p < 2; ++p)
    for (std::uint64_t sig = 1ull << (s - 1); sig < 1ull << s; ++sig) {
      const std::uint64_t square = sig << (s - 1 + p);
      const PipelineFloat got = fp_sqrt({false, p, static_cast<std::uint32_t>(sig)}, table, f);
      const std::uint64_t y = static_cast<std::uint64_t>(got.sig) << got.exp;
      r.unfaithful += !((y - 1) * (y - 1) < square && square < (y + 1) * (y + 1));
      const auto off = static_cast<std::int64_t>(y * y - square);
      const double ulp = static_cast<double>(off) / (static_cast<double>(y) + std::sqrt(static_cast<double>(square)));
      r.lowest = std::min(r.lowest, ulp);
      r.highest = std::max(r.highest, ulp);
      r.rises += y < before;  // falls: the root rises
      before = y;
      ++r.cases;
    }
  return r;
}

void print(const char* name, const Config& c, int segments, int degree, const Findings& r) {
  std::printf("| %-10s | %2d | %d | %4d | %+.4f .. %+.4f | %s | %s | %llu |\n", name, c.significand_bits, degree,
              1 << segments, r.lowest, r.highest, r.faithful() ? "yes" : "NO ",
              r.rises == 0 ? "yes" : ("no, " + std::to_string(r.rises) + " steps up").c_str(),
              static_cast<unsigned long long>(r.cases));
}

class TableAtWidth : public testing::TestWithParam<int> {};

/// The contract of model/pixel/sqrt.hpp and model/pixel/reciprocal.hpp: below 1 ulp with the automatic segments, for
/// every S.
TEST_P(TableAtWidth, FaithfulWithAutomaticSegments) {
  const int s = GetParam();
  const Config c = config_for(s, 2);
  const Findings rs = check_sqrt(c), rc = check_reciprocal(c);
  print("sqrt", c, c.sqrt_segments(), 2, rs);
  print("reciprocal", c, c.recip_segments(), 2, rc);
  EXPECT_EQ(rs.cases, 1ull << s);
  EXPECT_EQ(rc.cases, 1ull << (s - 1));
  EXPECT_EQ(rs.unfaithful, 0u) << rs.worst() << " ulp";
  EXPECT_EQ(rc.unfaithful, 0u) << rc.worst() << " ulp";
  EXPECT_LE(rs.worst(), 0.81);  // as the headers say
  EXPECT_LE(rc.worst(), 0.81);
}
TEST_P(TableAtWidth, FaithfulAtDegreeOne) {
  const Config c = config_for(GetParam(), 1);
  const Findings rs = check_sqrt(c), rc = check_reciprocal(c);
  print("sqrt", c, c.sqrt_segments(), 1, rs);
  print("reciprocal", c, c.recip_segments(), 1, rc);
  EXPECT_EQ(rs.unfaithful, 0u) << rs.worst() << " ulp";
  EXPECT_EQ(rc.unfaithful, 0u) << rc.worst() << " ulp";
  EXPECT_LT(rs.worst(), 1.0);
  EXPECT_LT(rc.worst(), 1.0);
}
INSTANTIATE_TEST_SUITE_P(EveryWidth, TableAtWidth, testing::Range(8, 27), testing::PrintToStringParamName());

TEST(Tables, PowersOfTwoAreExactAndExponentsFollow) {
  for (int s = 8; s <= 26; s += 3) {
    const Config c = config_for(s, 2);
    const SignificandFormat f{s, 2};
    const Table rt = make_sqrt_table(c), rc = make_recip_table(c);
    const std::uint32_t one = 1u << (s - 1);
    EXPECT_EQ(fp_sqrt({}, rt, f), PipelineFloat{});
    EXPECT_EQ(reciprocal({}, rc, f), PipelineFloat{});
    for (int e = -300; e <= 300; ++e) {
      EXPECT_EQ(reciprocal({(e & 1) != 0, e, one}, rc, f), (PipelineFloat{(e & 1) != 0, -e, one}));
      EXPECT_EQ(fp_sqrt({false, 2 * e, one}, rt, f), (PipelineFloat{false, e, one}));
      // A factor of 4 in the argument is one of 2 in the root, one of 2 is 1/2 in the reciprocal.
      const std::uint32_t sig = one + (one >> 1) + 5;
      for (int p = 0; p < 2; ++p) {
        const PipelineFloat at = fp_sqrt({false, p, sig}, rt, f), moved = fp_sqrt({false, p + 2 * e, sig}, rt, f);
        EXPECT_EQ(moved, (PipelineFloat{false, at.exp + e, at.sig}));
      }
      const PipelineFloat at = reciprocal({false, 0, sig}, rc, f), moved = reciprocal({true, e, sig}, rc, f);
      EXPECT_EQ(moved, (PipelineFloat{true, at.exp - e, at.sig}));
    }
  }
}

/// Coefficients fit the ROM word {C0: S+4, C1: S, C2: S bits} and the package holds exactly these words.
TEST(Tables, CoefficientsFitAndThePackageHoldsThem) {
  for (int s = 8; s <= 26; ++s)
    for (int degree = 1; degree <= 2; ++degree) {
      const Config c = config_for(s, degree);
      const Table tables[] = {make_sqrt_table(c), make_recip_table(c)};
      ASSERT_EQ(tables[0].entries.size(), 2ull << c.sqrt_segments());
      ASSERT_EQ(tables[1].entries.size(), 1ull << c.recip_segments());
      std::string text = tables_package(c);
      std::size_t at = 0;
      for (const Table& t : tables) {
        EXPECT_EQ(t.rest_bits, s - 1 - t.segments_log2);
        for (std::size_t i = 0; i < t.entries.size(); ++i) {
          const TableEntry& e = t.entries[i];
          ASSERT_LT(e.c0, 1ull << (s + 4));
          ASSERT_LT(e.c1, 1ull << s);
          ASSERT_LT(e.c2, 1ull << s);
          ASSERT_TRUE(degree == 2 || e.c2 == 0);
          const std::string word = std::to_string(s + 4) + "'d" + std::to_string(e.c0) + ", " + std::to_string(s) +
                                   "'d" + std::to_string(e.c1) + ", " + std::to_string(s) + "'d" + std::to_string(e.c2);
          at = text.find(word, at);
          ASSERT_NE(at, std::string::npos) << "entry " << i << " of S = " << s;
        }
      }
    }
}

/// Every table that a configuration can have, by the hash (FNV-1a of 64 bits) of all its coefficients, as they were
/// made in extended precision at first: integers give the same, on every platform and in every rounding mode.
TEST(Tables, AllAreTheSameAsInExtendedPrecision) {
  std::uint64_t hash = 14695981039346656037u, entries = 0;
  const auto add = [&](const Table& table) {
    for (const TableEntry& e : table.entries)
      for (const std::uint32_t c : {e.c0, e.c1, e.c2}) hash = (hash ^ c) * 1099511628211u;
    entries += table.entries.size();
  };
  for (int s = 8; s <= 26; ++s)
    for (int degree = 1; degree <= 2; ++degree)
      for (int segments = 2; segments <= std::min(14, s - 2); ++segments) {
        Config c = config_for(s, degree);
        c.sqrt_segments_log2 = c.recip_segments_log2 = segments == 2 ? -1 : segments;
        add(make_sqrt_table(c));
        add(make_recip_table(c));
      }
  EXPECT_EQ(entries, 2475712u);
  EXPECT_EQ(hash, 0x8bb00252ca9e4cc4u);
}

TEST(Tables, TheCallersRoundingModeDoesNotMatter) {
  const Config c = config_for(24, 2);
  const std::string nearest = tables_package(c);
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const std::string other = tables_package(c);
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(other, nearest) << "mode " << mode;
  }
}

}  // namespace
}  // namespace quadrille
