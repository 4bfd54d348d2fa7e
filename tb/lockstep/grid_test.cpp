// Every quad of a small grid, with w of -1, 0 and 1, in lockstep: what tb/judge/exhaustive_test.cpp holds of the model
// against exact integers the RTL does too, clock by clock.
#include "model/skips/both_ways_test_support.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace quadrille::tb {
namespace {

/// Those whose number is `first` modulo `stride`.
void grid(std::uint64_t first, std::uint64_t stride) {
  LockstepOptions o;
  o.config = tiny();
  o.state.width = o.state.height = o.state.scissor_x1 = o.state.scissor_y1 = 5;
  o.state.attributes = 0;
  o.state.depth = false;
  const std::vector<SnappedVertex> vertices = grid_vertices(o.config);
  const std::uint64_t n = vertices.size(), all = n * n * n * n;
  VerilatedDevice device(o.config, VerilateOptions{}, o.seed);
  constexpr std::size_t at_a_time = 1 << 14;
  std::vector<SnappedQuad> quads;
  std::uint64_t drawn = 0, fragments = 0, clocks = 0;
  for (std::uint64_t number = first; number < all; number += stride) {
    quads.push_back(grid_quad(vertices, number));
    quads.back().id = static_cast<std::uint32_t>(quads.size() - 1);
    if (quads.size() < at_a_time && number + stride < all) continue;
    const LockstepReport report = run_lockstep(device, quads, o);
    ASSERT_TRUE(report.agreed()) << "quads up to " << number << ": " << report.first_divergence.value_or("");
    ASSERT_TRUE(report.complete);
    drawn += report.quads;
    fragments += report.fragments;
    clocks += report.cycles_rtl;
    quads.clear();
  }
  EXPECT_EQ(drawn, (all - first + stride - 1) / stride);
  EXPECT_GT(fragments, drawn);
}

TEST(Grid, SomeInLockstep) { grid(7, 23); }
TEST(Grid, AllInLockstep) { grid(0, 1); }

}  // namespace
}  // namespace quadrille::tb
