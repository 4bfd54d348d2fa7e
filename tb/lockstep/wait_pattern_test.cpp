// Patterns of waits: what each is made of, and that one which was recorded comes again.
#include "tb/lockstep/wait_pattern.hpp"

#include "golden/scenes/random_quads.hpp"
#include "tb/lockstep/driven_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace quadrille::tb {
namespace {

using Port = WaitPattern::Port;

std::vector<bool> drawn(WaitKind kind, Port port, std::uint64_t seed, std::size_t count = 20'000) {
  WaitPattern pattern(kind, port, seed);
  std::vector<bool> waits(count);
  for (std::size_t i = 0; i < count; ++i) waits[i] = pattern.next();
  return waits;
}

/// Runs of clocks alike: how many of each length.
std::map<std::size_t, int> runs(const std::vector<bool>& waits, bool value) {
  std::map<std::size_t, int> lengths;
  for (std::size_t at = 0, end = 0; at < waits.size(); at = end) {
    for (end = at; end < waits.size() && waits[end] == waits[at];) ++end;
    if (waits[at] == value) ++lengths[end - at];
  }
  return lengths;
}

double share(const std::vector<bool>& waits) {
  return static_cast<double>(std::ranges::count(waits, true)) / static_cast<double>(waits.size());
}

TEST(WaitPattern, NamesAndNoOthers) {
  for (std::size_t i = 0; i < wait_kind_names().size(); ++i)
    EXPECT_EQ(parse_wait_kind(wait_kind_names()[i]), static_cast<WaitKind>(i));
  EXPECT_THROW(parse_wait_kind("often"), std::invalid_argument);
}

TEST(WaitPattern, TheSeedDecides) {
  for (const Port port : {Port::input, Port::output}) {
    EXPECT_EQ(drawn(WaitKind::mixed, port, 1), drawn(WaitKind::mixed, port, 1));
    EXPECT_NE(drawn(WaitKind::mixed, port, 1), drawn(WaitKind::mixed, port, 2));
  }
  EXPECT_NE(drawn(WaitKind::mixed, Port::input, 1), drawn(WaitKind::mixed, Port::output, 1));
}

TEST(WaitPattern, WhatEachHolds) {
  for (const Port port : {Port::input, Port::output}) {
    const double sparse = share(drawn(WaitKind::sparse, port, 1));
    EXPECT_NEAR(sparse, port == Port::input ? 0.97 : 0.93, 0.01);
    const std::vector<bool> bursts = drawn(WaitKind::bursts, port, 1);
    EXPECT_GE(runs(bursts, true).rbegin()->first, 60u) << "a long wait";
    EXPECT_GE(runs(bursts, false).rbegin()->first, 20u) << "a long run without one";
    // Locked: few lengths of waits, each many times.
    const std::map<std::size_t, int> locked = runs(drawn(WaitKind::locked, port, 1), true);
    int usual = 0;
    for (const auto& [length, count] : locked) usual = std::max(usual, count);
    EXPECT_GT(usual, 30);
    EXPECT_GT(locked.size(), 5u);
    const std::map<std::size_t, int> mixed = runs(drawn(WaitKind::mixed, port, 1), false);
    EXPECT_GT(mixed.rbegin()->first, 40u) << "a stretch without waits";
    EXPECT_GT(mixed.begin()->second, 100) << "and single clocks";
  }
}

/// Between quads alone: of a quad's four beats none waits but the first, for every number of clocks sooner or later.
TEST(WaitPattern, LockedWaitsBetweenQuads) {
  std::map<std::size_t, int> lengths;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<bool> waits = drawn(WaitKind::locked, Port::input, seed);
    for (const auto& [length, count] : runs(waits, true))
      if (runs(waits, false).contains(4)) lengths[length] += count;
  }
  EXPECT_GT(lengths.size(), 100u);
  EXPECT_GE(lengths.rbegin()->first, 150u);
}

TEST(WaitPattern, RecordedItComesAgain) {
  LockstepOptions options;
  options.state = small_state(options.config);
  const std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 1, 30);
  for (const WaitKind kind : {WaitKind::bursts, WaitKind::sparse, WaitKind::locked, WaitKind::mixed}) {
    options.pattern = kind;
    options.waits = {};
    const PortWaits waits = recorded_waits(quads, options, 2000, 1000);
    EXPECT_FALSE(waits.stall_clocks.empty());
    EXPECT_FALSE(waits.gap_beats.empty());
    LockstepOptions listed = options;
    listed.pattern = WaitKind::chance;
    listed.waits = waits;
    EXPECT_EQ(recorded_waits(quads, listed, 2000, 1000), waits);
    Stimulus first(quads, options), again(quads, listed);
    for (int clock = 0; clock < 1500; ++clock) {
      ASSERT_EQ(first.valid(), again.valid()) << clock;
      ASSERT_EQ(first.ready(), again.ready()) << clock;
      ASSERT_TRUE(std::ranges::equal(first.vertices.words(), again.vertices.words())) << clock;
      const bool taken = first.valid() && clock % 3 != 0;
      first.advance(taken);
      again.advance(taken);
    }
  }
}

}  // namespace
}  // namespace quadrille::tb
