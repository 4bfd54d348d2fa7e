// Whole draws of the untimed model against the truth: what is right passes, on every stress family and at the port.
#include "tb/judge/judge.hpp"

#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/stress.hpp"
#include "model/support/prng.hpp"
#include "tb/judge/directed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace quadrille::tb {
namespace {

DrawState square(int size) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  return state;
}

std::string faults(const CheckResult& result) {
  std::string text = result.first.text;
  for (const auto& counter : fault_counters)
    text += " " + std::string(counter.key) + " " + std::to_string(result.*counter.value);
  return text;
}

/// Every family. Bases far from zero, beside a spread of a few codes: values that the bound of their size would leave
/// unjudged.
TEST(JudgeUntimed, PassesNarrowSpreadsFarFromZero) {
  for (const int s : {8, 26})
    for (const bool perspective : {true, false})
      for (const golden::StressFamilyInfo& info : golden::stress_families()) {
        Config config;
        config.set("significand_bits", s);
        config.set("notch_exact", perspective);
        DrawState state = square(48);
        state.perspective = perspective;
        auto quads = golden::make_stress(info.family, 8, 11, 1.0, 48, 48, 4);
        golden::Prng rng(static_cast<std::uint64_t>(s));
        for (WindowQuad& quad : quads) {
          const double depth = rng.uniform(0, 1), spread = rng.log2_spread(-28, -2);
          for (std::size_t i = 0; i < 4; ++i) {
            quad.vertex[i].z = (depth + rng.uniform(0, 1) * spread * (1 - depth)) * quad.vertex[i].w;
            quad.attribute[i] = {-100 + rng.uniform(-1, 1) * spread, 100 + rng.uniform(-1, 1) * spread, 127.5,
                                 rng.uniform(-127, 127)};
          }
        }
        const CheckResult result = judge_untimed(quads, 4, config, state);
        EXPECT_TRUE(result.ok()) << info.name << (perspective ? "" : " without perspective") << ", s = " << s << ": "
                                 << faults(result);
      }
}

/// Limits at the corners' codes and one code beside: nothing is tolerated where no corner is cut off.
TEST(JudgeUntimed, PassesLimitsAtTheCornersCodes) {
  golden::Prng rng(21);
  std::uint64_t compared = 0, cut = 0;
  for (int n = 0; n < 150; ++n) {
    Config config;
    config.set("significand_bits", n % 2 == 0 ? 12 : 18);
    DrawState state = square(48);
    const double unit = std::ldexp(1.0, -config.depth_bits), spread = rng.log2_spread(-24, 0);
    const double depth = rng.uniform(0, 1 - spread);
    auto quads =
        golden::make_stress(golden::StressFamily::perspective, 1, static_cast<std::uint64_t>(n), 1.0, 48, 48, 0);
    double low = 1, high = 0;
    for (WindowVertex& v : quads[0].vertex) {
      v.z = (depth + rng.uniform(0, spread)) * v.w;
      low = std::min(low, std::floor(v.z / v.w / unit + 0.5) * unit);
      high = std::max(high, std::floor(v.z / v.w / unit + 0.5) * unit);
    }
    for (const int inward : {-1, 0, 1, 2}) {
      state.znear = std::clamp(low + inward * unit, 0.0, 1.0);
      state.zfar = std::clamp(high - inward * unit, 0.0, 1.0);
      if (state.zfar < state.znear) continue;
      const CheckResult result = judge_untimed(quads, 0, config, state);
      EXPECT_EQ(result.faults(), 0u) << n << ", " << inward << ": " << faults(result);
      EXPECT_TRUE(inward > 0 || result.discarded + result.tolerated_depth == 0) << n;
      (inward <= 0 ? compared : cut) += result.compared;
    }
  }
  EXPECT_GT(compared, 10'000u);
  EXPECT_GT(cut, 1'000u);
}

TEST(JudgeUntimed, PassesQuadsAtThePort) {
  for (const int s : {10, 18}) {
    Config config;
    config.set("significand_bits", s);
    const DrawState state = small_state(config);
    const CheckResult result = judge_untimed(random_quads(config, state, 3, 400), config, state);
    EXPECT_TRUE(result.ok()) << "s = " << s << ": " << faults(result);
  }
}

/// Quads of which a corner is c times another one, c of either sign: they fall on one pixel, before the eye or on both
/// sides of it.
TEST(JudgeUntimed, PassesCoincidentAndAntipodalCorners) {
  golden::Prng rng(3);
  const auto pick = [&](std::initializer_list<double> of) { return of.begin()[rng.below(of.size())]; };
  std::vector<WindowQuad> quads(1500);
  for (WindowQuad& quad : quads) {
    for (WindowVertex& v : quad.vertex) {
      const double w = pick({1, 1, 0.5, 0.25, -0.5, -1});
      v.x = (static_cast<double>(rng.below(24)) + 0.5) * w;
      v.y = (static_cast<double>(rng.below(24)) + 0.5) * w;
      v.z = 0.5 * w;
      v.w = w;
    }
    const std::size_t from = rng.below(4), to = (from + 1 + rng.below(2)) % 4;
    const double c = pick({-1, -0.5, 0.5, 1});
    const WindowVertex& v = quad.vertex[from];
    quad.vertex[to] = {c * v.x, c * v.y, c * v.z, c * v.w};
  }
  for (const bool perspective : {true, false}) {
    DrawState state = square(32);
    state.perspective = perspective;
    const CheckResult result = judge_untimed(quads, 0, Config{}, state);
    EXPECT_TRUE(result.ok()) << (perspective ? "" : "without perspective ") << faults(result);
    EXPECT_GT(result.two_corner, 20u);
  }
}

TEST(Directed, DrawsPassInEveryKindOfConfiguration) {
  for (const int s : {8, 18, 26}) {
    Config config;
    config.set("significand_bits", s);
    const CheckResult result = judge_directed(config);
    EXPECT_TRUE(result.ok()) << "s = " << s << ": " << faults(result);
  }
  Config config;
  config.set("quadratic_frac_bits", 6);
  EXPECT_TRUE(judge_directed(config).ok()) << faults(judge_directed(config));
}

TEST(Directed, DrawsHoldWhatTheyAreFor) {
  const Config config;
  std::map<std::string_view, CheckResult> results;
  for (const golden::CornerDraw& draw : directed_draws(config))
    results[draw.group] = judge_untimed(draw.quads, config, draw.state);
  EXPECT_GT(results.at("z_limits").on_vertex, 50u);
  EXPECT_GT(results.at("z_limits").discarded, 50u);
  EXPECT_GT(results.at("two_corner").two_corner, 5u);
  EXPECT_GT(results.at("face_plane").compared, 5000u);
  EXPECT_GT(results.at("two_edge").eye_crossing, 1000u) << "without perspective";
  EXPECT_EQ(results.at("at_infinity").compared, 0u);
  EXPECT_GT(results.at("saturated").compared, 500u);
  EXPECT_FALSE(results.contains("tall"));
}

}  // namespace
}  // namespace quadrille::tb
