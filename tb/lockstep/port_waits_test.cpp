#include "tb/lockstep/port_waits.hpp"

#include "golden/scenes/random_quads.hpp"
#include "tb/lockstep/driven_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace quadrille::tb {
namespace {

using List = std::vector<std::uint64_t>;

TEST(PortWaits, AsTextAndBack) {
  EXPECT_EQ(parse_stall_clocks("0"), List{0});
  EXPECT_EQ(parse_stall_clocks("17,40-43,44"), (List{17, 40, 41, 42, 43, 44}));
  EXPECT_EQ(spell_stall_clocks({17, 40, 41, 42, 43, 45}), "17,40-43,45");
  EXPECT_EQ(parse_gap_beats("5:2,9"), (List{5, 5, 9}));
  EXPECT_EQ(spell_gap_beats({5, 5, 9, 10}), "5:2,9,10");
  EXPECT_EQ(spell_stall_clocks({}) + spell_gap_beats({}), "");
  EXPECT_EQ(parse_stall_clocks("18446744073709551615"), List{UINT64_MAX});
  golden::Prng random(3);
  for (int i = 0; i < 100; ++i) {
    List clocks, beats;
    for (std::uint64_t at = 0; at < 60; ++at) {
      if (random.chance(0.5)) clocks.push_back(at);
      beats.insert(beats.end(), random.below(3), at);
    }
    EXPECT_EQ(parse_stall_clocks(spell_stall_clocks(clocks)), clocks);
    EXPECT_EQ(parse_gap_beats(spell_gap_beats(beats)), beats);
  }
}

TEST(PortWaits, WhatIsRefused) {
  for (const char* text : {"", ",", "1,", "x", "-1", "1-", "3-1", "1,1", "5,3", "1-4,4", "1:2", "1 2", "0-99999999999",
                           "0-18446744073709551615", "18446744073709551616"})
    EXPECT_THROW(parse_stall_clocks(text), std::invalid_argument) << text;
  for (const char* text : {"", "1,", "x", "1:", "1:0", "1:2,1", "5,3", "1-2", "1:99999999999"})
    EXPECT_THROW(parse_gap_beats(text), std::invalid_argument) << text;
  const Config config;
  const DrawState state = small_state(config);
  const std::vector<SnappedQuad> quads = random_quads(config, state, 1, 1);
  const List falling{3, 2}, twice{2, 2};
  EXPECT_THROW(ReadyDriver(1, 0, falling), std::invalid_argument);
  EXPECT_THROW(ReadyDriver(1, 0, twice), std::invalid_argument);
  EXPECT_THROW(ReadyDriver(1, 0.5, List{2}), std::invalid_argument);
  EXPECT_THROW(VertexDriver(quads, config, 4, 1, 0, falling), std::invalid_argument);
  EXPECT_NO_THROW(VertexDriver(quads, config, 4, 1, 0, twice));
  EXPECT_THROW(VertexDriver(quads, config, 4, 1, 0.5, twice), std::invalid_argument);
}

TEST(PortWaits, ListedOnesAndNoOthers) {
  LockstepOptions options;
  options.state = small_state(options.config);
  options.waits = {{0, 3, 4, 90}, {0, 0, 5, 6, 6, 6, 1000}};
  const std::vector<SnappedQuad> quads = random_quads(options.config, options.state, 1, 3);
  EXPECT_EQ(recorded_waits(quads, options, 1000, 1000), (PortWaits{{0, 3, 4, 90}, {0, 0, 5, 6, 6, 6}}));
}

/// Every signal of both drivers in every clock, rubbish included, whenever the beats are taken.
TEST(PortWaits, RecordedRunIsTheSame) {
  for (const auto& [stall, gap] : {std::pair{0.3, 0.2}, {0.0, 0.5}, {0.7, 0.0}, {0.9, 0.9}}) {
    LockstepOptions drawn;
    drawn.state = small_state(drawn.config);
    drawn.state.attributes = 2;  // with rubbish in the others
    drawn.seed = 11;
    drawn.stall = stall;
    drawn.gap = gap;
    const std::vector<SnappedQuad> quads = random_quads(drawn.config, drawn.state, 1, 40);
    LockstepOptions listed = drawn;
    listed.stall = listed.gap = 0;
    listed.waits = recorded_waits(quads, drawn, 3000, 160);
    EXPECT_EQ(listed.waits.stall_clocks.empty(), stall == 0);
    EXPECT_EQ(listed.waits.gap_beats.empty(), gap == 0);
    Stimulus a(quads, drawn), b(quads, listed);
    golden::Prng random(5);
    int clocks = 0;
    for (; !a.done() && clocks < 3000; ++clocks) {
      ASSERT_EQ(a.valid(), b.valid()) << clocks;
      ASSERT_EQ(a.ready(), b.ready()) << clocks;
      ASSERT_EQ(a.changed(), b.changed()) << clocks;
      ASSERT_TRUE(std::ranges::equal(a.vertices.words(), b.vertices.words())) << clocks;
      const bool taken = a.valid() && random.chance(0.5);
      a.advance(taken);
      b.advance(taken);
    }
    EXPECT_TRUE(a.done() && b.done());
  }
}

}  // namespace
}  // namespace quadrille::tb
