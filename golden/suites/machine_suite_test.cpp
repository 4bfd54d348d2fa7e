// The machine's suites: clocks against the test bench's own runs, responses against the untimed model, damage found.
#include "golden/suites/machine_suite.hpp"

#include "golden/io/error.hpp"
#include "golden/suites/machine_run.hpp"
#include "model/untimed.hpp"
#include "tb/lockstep.hpp"
#include "tb/random_quads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace quadrille::vectors {
namespace {

TEST(MachineRun, FragmentsAreThoseOfTheUntimedModel) {
  const Config config;
  const DrawState state = tb::small_state(config);
  const std::vector<SnappedQuad> quads = tb::random_quads(config, state, 5, 60);
  std::vector<Fragment> expected;
  UntimedModel model(config, state, PixelEngine::plain);
  for (const SnappedQuad& quad : quads)
    model.draw(quad,
               [&](std::span<const Fragment> drawn) { expected.insert(expected.end(), drawn.begin(), drawn.end()); });
  ASSERT_GT(expected.size(), 1000u);
  const std::vector<StallClock> stalls = make_stalls(3, 257);
  for (const std::span<const StallClock> pattern :
       {std::span<const StallClock>(), std::span<const StallClock>(stalls)}) {
    const std::vector<TimedFragment> run = run_machine(quads, config, state, pattern);
    ASSERT_EQ(run.size(), expected.size());
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < run.size(); ++i) {
      ASSERT_EQ(run[i].fragment, expected[i]) << i;
      if (i > 0) {
        ASSERT_GT(run[i].clock, before);
      }
      before = run[i].clock;
      if (!pattern.empty()) {
        ASSERT_TRUE(pattern[run[i].clock % pattern.size()].ready) << "handed over in a stalled clock";
      }
    }
  }
}

TEST(MachineRun, FirstFragmentOfOneQuad) {
  // Four beats in clocks 0-3, the start in 4, then rtl/README.md section 4: PREP, RUN 0-7, DRAIN 2, DONE, and the walk.
  // The test bench's run of the same quad, which lockstep compares with the RTL, takes as many clocks in all.
  const Config config;
  DrawState state = tb::small_state(config);
  const std::vector<SnappedQuad> quads = tb::random_quads(config, state, 1, 1);
  const std::vector<TimedFragment> run = run_machine(quads, config, state, {});
  ASSERT_FALSE(run.empty());
  tb::LockstepOptions options;
  options.config = config;
  options.state = state;
  const tb::AloneRun alone = tb::run_clocked_model_alone(quads, options);
  EXPECT_EQ(alone.fragments, run.size());
  EXPECT_LT(run.back().clock, alone.cycles);
  EXPECT_GE(run.back().clock + 4, alone.cycles) << "the end beat follows the last pixel";
}

TEST(MachineRun, StallsStallBothSides) {
  const std::vector<StallClock> stalls = make_stalls(1, 1024);
  const auto offers = std::ranges::count(stalls, true, &StallClock::offer);
  const auto takes = std::ranges::count(stalls, true, &StallClock::ready);
  EXPECT_TRUE(stalls.front().offer);
  EXPECT_GT(offers, 300);
  EXPECT_LT(offers, 1000);
  EXPECT_GT(takes, 300);
  EXPECT_LT(takes, 1000);
}

TEST(MachineSuites, OneForTheMachineAndOneForEachFamily) {
  std::vector<std::unique_ptr<Suite>> suites;
  add_machine_suites(suites);
  ASSERT_EQ(suites.size(), 23u);
  std::set<std::string> names;
  for (const auto& suite : suites) {
    names.insert(suite->info().name);
    EXPECT_EQ(suite->info().kind, "machine");
  }
  EXPECT_EQ(names.size(), 23u);
  EXPECT_TRUE(names.contains("machine"));
  EXPECT_TRUE(names.contains("stress_bowtie"));
}

}  // namespace
}  // namespace quadrille::vectors
