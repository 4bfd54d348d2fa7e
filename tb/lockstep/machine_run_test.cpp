// The clocks of the golden vectors' machine against the test bench's own run.
#include "golden/vectors/machine_run.hpp"
#include "golden/scenes/random_quads.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace quadrille::tb {
namespace {

TEST(MachineRun, FirstFragmentOfOneQuad) {
  // Four beats in clocks 0-3, the start in 4, then rtl/SPEC.md: PREP, RUN 0-7, DRAIN 2, DONE, and the walk.
  // The test bench's run of the same quad, which lockstep compares with the RTL, takes as many clocks in all.
  const Config config;
  DrawState state = small_state(config);
  const std::vector<SnappedQuad> quads = random_quads(config, state, 1, 1);
  const std::vector<vectors::TimedFragment> run = vectors::run_machine(quads, config, state, {}).fragments;
  ASSERT_FALSE(run.empty());
  LockstepOptions options;
  options.config = config;
  options.state = state;
  const AloneRun alone = run_clocked_model_alone(quads, options);
  EXPECT_EQ(alone.fragments, run.size());
  EXPECT_LT(run.back().clock, alone.cycles);
  EXPECT_GE(run.back().clock + 4, alone.cycles) << "the end beat follows the last pixel";
}

}  // namespace
}  // namespace quadrille::tb
