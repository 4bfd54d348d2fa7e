// Regression limits: set from what was measured, written, read, and passed by what they were set from alone.
#include "tb/judge/error_limits.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

/// A draw with these errors at its weights, attributes and depths, and their mean.
CheckResult draw(double largest, double mean) {
  CheckResult result;
  for (RelativeErrors* errors : {&result.weight, &result.attribute, &result.depth}) {
    errors->add(largest);
    errors->add(2 * mean - largest);
  }
  return result;
}

ErrorLimits around(std::initializer_list<CheckResult> draws, double headroom) {
  std::vector<MeasuredErrors> measured;
  for (const CheckResult& result : draws) measured.emplace_back(result);
  ErrorLimits limits;
  limits.set(golden::StressFamily::reflex, 18, measured, headroom);
  return limits;
}

TEST(ErrorLimits, LieAroundWhatWasMeasured) {
  const ErrorLimits limits = around({draw(0.5, 0.01), draw(0.4, 0.03)}, 1);
  const ErrorLimits::Family* reflex = limits.find("reflex", 18);
  ASSERT_NE(reflex, nullptr);
  EXPECT_EQ(limits.find("reflex", 12), nullptr);
  EXPECT_EQ(limits.find("general", 18), nullptr);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(reflex->max[i].high(), 0.7, 1e-3);
    EXPECT_NEAR(reflex->mean[i].low(), -0.01, 1e-4);
    EXPECT_NEAR(reflex->mean[i].high(), 0.05, 1e-4);
  }
  EXPECT_TRUE(beyond_limits(*reflex, draw(0.5, 0.01)).empty());
  EXPECT_TRUE(beyond_limits(*reflex, draw(0.1, 0.02)).empty()) << "better than before is no fault";
  EXPECT_EQ(beyond_limits(*reflex, draw(0.71, 0.02)).size(), 3u);
  EXPECT_EQ(beyond_limits(*reflex, draw(0.5, 0.06)).size(), 3u);
  EXPECT_EQ(beyond_limits(*reflex, draw(0.5, -0.02)).size(), 3u);
  CheckResult weights_alone;
  weights_alone.weight = draw(0.8, 0.02).weight;
  const std::vector<std::string> faults = beyond_limits(*reflex, weights_alone);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("largest weight error 0.8"), std::string::npos) << faults[0];
}

TEST(ErrorLimits, WithoutHeadroomHoldWhatTheyWereSetFrom) {
  // Values with more digits than the file keeps: rounding is outward.
  const CheckResult a = draw(0.123456789, -0.00123456789), b = draw(0.23456789, 0.0234567891);
  const ErrorLimits limits = around({a, b}, 0);
  for (const CheckResult& result : {a, b}) EXPECT_TRUE(beyond_limits(*limits.find("reflex", 18), result).empty());
}

TEST(ErrorLimits, SurviveTheFile) {
  ErrorLimits limits = around({draw(0.5, 0.01), draw(0.4, 0.03)}, 1);
  limits.set_climb(18, 3.5);
  const std::string text = limits.text();
  const ErrorLimits read = ErrorLimits::parse(text);
  EXPECT_EQ(read.text(), text);
  EXPECT_EQ(read.climb(18), 3.5);
  EXPECT_TRUE(std::isinf(read.climb(20)));
  EXPECT_THROW(ErrorLimits::parse("{\"families\": {\"reflex\": {\"18\": {}}}}"), std::runtime_error);
  EXPECT_THROW(ErrorLimits::parse("nonsense"), std::runtime_error);
}

/// Every family at the recorded widths, and limits below the bound, or they would be of no use.
TEST(ErrorLimits, AreRecordedAndTighterThanTheBound) {
  for (const golden::StressFamilyInfo& info : golden::stress_families())
    for (const int s : {12, 18, 24}) {
      const ErrorLimits::Family* limits = ErrorLimits::recorded().find(info.name, s);
      ASSERT_NE(limits, nullptr) << info.name << ", s = " << s;
      for (std::size_t i = 0; i < 3; ++i)
        // Few quads of any_w have every W > 0, hence a bound of depth: in some draws none, so their interval is wide.
        EXPECT_LT(limits->max[i].high(), info.family == golden::StressFamily::any_w && i == 2 ? 1 : 0.75)
            << info.name << ", s = " << s << " " << output_names[i];
      // A mean of weights 1 to 3 is known to half a unit of 2^-s, of which the bound has 8; of 30 quads no better.
      EXPECT_LT(limits->mean[0].high() - limits->mean[0].low(), 0.5 / 8) << info.name << ", s = " << s;
    }
  for (const int s : {12, 18, 24}) EXPECT_LT(ErrorLimits::recorded().climb(s), 6) << "of 8 units";
}

TEST(ErrorLimits, AreForTheirDrawAlone) {
  Config config;
  config.set("significand_bits", 24);
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = limit_extent;
  const auto family = golden::StressFamily::reflex;
  const std::size_t quads = limit_quads(family);
  EXPECT_TRUE(limits_apply(config, state, family, quads));
  EXPECT_FALSE(limits_apply(config, state, family, quads + 1));
  EXPECT_FALSE(limits_apply(config, state, golden::StressFamily::w_zero, quads));
  DrawState other = state;
  other.zfar = 0.5;
  EXPECT_FALSE(limits_apply(config, other, family, quads));
  other = state;
  other.perspective = false;
  EXPECT_FALSE(limits_apply(config, other, family, quads));
  config.set("align_guard_bits", 0);
  EXPECT_FALSE(limits_apply(config, state, family, quads));
}

}  // namespace
}  // namespace quadrille::tb
