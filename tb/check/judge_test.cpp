// Whole draws of the untimed model against the truth: what is right passes, on every stress family and at the port.
#include "tb/check/judge.hpp"

#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/stress.hpp"

#include <gtest/gtest.h>

namespace quadrille::cli {
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

TEST(JudgeUntimed, PassesEveryStressFamily) {
  for (const bool perspective : {true, false})
    for (const golden::StressFamilyInfo& info : golden::stress_families()) {
      DrawState state = square(48);
      state.perspective = perspective;
      const auto quads = golden::make_stress(info.family, 30, 7, 1.0, 48, 48, 6);
      const CheckResult result = judge_untimed(quads, 6, Config{}, state);
      EXPECT_TRUE(result.ok()) << info.name << (perspective ? "" : " without perspective") << ": " << faults(result);
    }
}

TEST(JudgeUntimed, PassesQuadsAtThePort) {
  for (const int s : {10, 18}) {
    Config config;
    config.set("significand_bits", s);
    const DrawState state = tb::small_state(config);
    const CheckResult result = judge_untimed(tb::random_quads(config, state, 3, 400), config, state);
    EXPECT_TRUE(result.ok()) << "s = " << s << ": " << faults(result);
  }
}

}  // namespace
}  // namespace quadrille::cli
