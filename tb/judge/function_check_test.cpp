// The oracle of the functions passes what the model computes, in every kind of configuration.
#include "tb/judge/function_check.hpp"

#include "tb/judge/exact_number.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

Config configured(std::initializer_list<std::pair<const char*, int>> settings) {
  Config config;
  for (const auto& [key, value] : settings) config.set(key, value);
  config.validate();
  return config;
}

void expect_passes(const Config& config, const std::string& name) {
  const FunctionReport report = check_functions(config);
  EXPECT_TRUE(report.ok()) << name << ": " << report.beyond() << " beyond their limit; " << report.first();
  for (const FunctionResult& function : report.functions) EXPECT_GT(function.arguments, 400u) << function.name;
}

TEST(FunctionCheck, PassesEverySignificand) {
  for (int s = 8; s <= 26; ++s) expect_passes(configured({{"significand_bits", s}}), "s = " + std::to_string(s));
}

/// A table that errs by less than a unit of the last bit is called faithful; the limits that hold for any coefficients
/// must leave room for no more, or an entry that is 3 units off could pass.
TEST(FunctionCheck, LimitsOfTheAutomaticTablesAreFaithful) {
  for (int s = 8; s <= 26; ++s)
    for (int degree = 1; degree <= 2; ++degree) {
      const Config config = configured({{"significand_bits", s}, {"sqrt_degree", degree}, {"recip_degree", degree}});
      for (const TableLimit& limit : {sqrt_limit(config), reciprocal_limit(config)}) {
        EXPECT_LE(limit.below, 10) << "in eighths, s = " << s << ", degree " << degree;
        EXPECT_LE(limit.above, 8) << "s = " << s << ", degree " << degree;
        EXPECT_GT(limit.below, 6);
        EXPECT_GT(limit.above, 4);
      }
    }
}

/// By hand, with significands of 4 bits.
TEST(ExactNumber, TruncatesTowardZero) {
  using exact::Number;
  const auto same = [](const Number& a, exact::Wide m, int e) {
    return a.e >= e ? (a.m << (a.e - e)) == m : a.m == (m << (e - a.e));
  };
  EXPECT_TRUE(same(exact::cut({0b110111, 0}, 4), 0b110100, 0));
  EXPECT_TRUE(same(exact::cut({-0b110111, 0}, 4), -0b110100, 0));
  EXPECT_TRUE(same(exact::cut({5, 3}, 4), 5, 3));
  EXPECT_TRUE(exact::cut({}, 4).zero());
  // 225 - 210, the exponents of the products' factors 3 and 3: a grain of 2^(6 - 3 - G).
  const exact::Term plus{{15, 0}, {15, 0}}, minus{{-15, 0}, {14, 0}};
  EXPECT_TRUE(same(exact::sum(std::array{plus, minus}, 4, 0), 28 * 8 - 26 * 8, 0));
  EXPECT_TRUE(same(exact::sum(std::array{plus, minus}, 4, 2), 112 * 2 - 105 * 2, 0));
  EXPECT_TRUE(same(exact::sum(std::array{plus, minus}, 4, 4), 15, 0));
  EXPECT_TRUE(same(exact::sum(std::array{minus, plus, minus}, 4, 4), -195 + 3, 0)) << "-195 has 8 bits";
}

TEST(ExactNumber, KnowsTheNormalForm) {
  const exact::Number three{3, 0};
  EXPECT_TRUE(exact::is(PipelineFloat{false, 1, 0b1100}, three, 4));
  EXPECT_FALSE(exact::is(PipelineFloat{true, 1, 0b1100}, three, 4));
  EXPECT_FALSE(exact::is(PipelineFloat{false, 2, 0b0110}, three, 4));
  EXPECT_FALSE(exact::is(PipelineFloat{false, 1, 0b1101}, three, 4));
  EXPECT_TRUE(exact::is(PipelineFloat{}, {}, 4));
  EXPECT_FALSE(exact::is(PipelineFloat{true, 0, 0}, {}, 4));
}

TEST(FunctionCheck, PassesOtherConfigurations) {
  expect_passes(configured({{"align_guard_bits", 0}, {"notch_exact", 0}}), "no guard bits");
  expect_passes(configured({{"align_guard_bits", 6}, {"attribute_slots", 8}}), "six guard bits");
  expect_passes(configured({{"sqrt_degree", 1}, {"recip_degree", 1}}), "degree 1");
  expect_passes(configured({{"significand_bits", 12}, {"sqrt_segments_log2", 5}, {"recip_segments_log2", 6}}),
                "finer tables");
  expect_passes(configured({{"sqrt_segments_log2", 4}, {"recip_segments_log2", 4}}), "coarser tables");
  expect_passes(configured({{"sqrt_segments_log2", 3}, {"recip_segments_log2", 3}}), "the coarsest tables");
  expect_passes(configured({{"quadratic_frac_bits", 12}, {"depth_bits", 16}}), "dropped bits");
  expect_passes(configured({{"viewport_bits", 6},
                            {"guard_bits", 1},
                            {"subpixel_bits", 2},
                            {"homogeneous_frac_bits", 4},
                            {"tile_log2", 2},
                            {"significand_bits", 8},
                            {"attribute_slots", 1},
                            {"attribute_int_bits", 8},
                            {"depth_bits", 30}}),
                "odd widths");
}

}  // namespace
}  // namespace quadrille::tb
