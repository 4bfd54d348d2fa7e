// Which draws --draws makes of an input.
#include "tb/commands/cosim_draws.hpp"

#include "golden/scenes/stress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace quadrille::tb {
namespace {

Config hiding(int tiles_log2) {
  Config config;
  config.set("hierarchical_z_bits", 12);
  config.set("hierarchical_z_tiles_log2", tiles_log2);
  return config;
}

TEST(CosimDraws, EveryQuadInOrderAndEarlierOnesAgain) {
  const auto quads = golden::make_stress(golden::StressFamily::general, 100, 1, 1, 64, 64);
  const auto draws = plan_draws(quads, 12, Config{}, 64, 64, 1);
  ASSERT_EQ(draws.size(), 12u);
  std::size_t next = 0, again = 0;
  for (const PlannedDraw& draw : draws)
    for (const WindowQuad& quad : draw.quads) {
      ASSERT_LE(quad.id, next);
      (quad.id == next ? next : again) += 1;
    }
  EXPECT_EQ(next, 100u);
  EXPECT_GT(again, 20u);
  EXPECT_TRUE(plan_draws({}, 3, Config{}, 64, 64, 1).empty());
  const auto few = plan_draws(std::span(quads).first(2), 5, Config{}, 64, 64, 1);
  EXPECT_EQ(few.size(), 5u);
  EXPECT_TRUE(std::ranges::none_of(few, [](const PlannedDraw& draw) { return draw.quads.empty(); }));
}

TEST(CosimDraws, ClearsResetsAndStates) {
  const auto quads = golden::make_stress(golden::StressFamily::general, 300, 1, 1, 64, 64);
  for (const int tiles_log2 : {6, 12}) {
    std::set<unsigned> clears;
    int resets = 0, cut = 0, hidden = 0, again_after_half = 0;
    std::set<WaitKind> waits;
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
      for (const PlannedDraw& draw : plan_draws(quads, 20, hiding(tiles_log2), 64, 64, seed)) {
        clears.insert(draw.clears);
        resets += draw.reset;
        cut += draw.limit > 0;
        hidden += (draw.state.skip & skip_hidden) != 0;
        waits.insert(draw.waits);
        again_after_half += draw.clears == 1u << (tiles_log2 - 5) && draw.quads.size() > 20;
      }
    EXPECT_EQ(clears, (std::set<unsigned>{0, 1, 2, 1u << (tiles_log2 - 5)}));
    EXPECT_GT(resets, 20);
    EXPECT_GT(cut, 10);
    EXPECT_GT(hidden, 160);
    EXPECT_GT(again_after_half, 12) << "what half of the epochs ago was drawn is drawn again";
    EXPECT_EQ(waits.size(), 5u);
  }
}

TEST(CosimDraws, TheSeedDecides) {
  const auto quads = golden::make_stress(golden::StressFamily::general, 60, 1, 1, 64, 64);
  const auto skips = [&](std::uint64_t seed) {
    std::vector<std::uint32_t> all;
    for (const PlannedDraw& draw : plan_draws(quads, 12, hiding(6), 64, 64, seed)) {
      all.push_back(draw.state.skip);
      all.push_back(draw.clears);
      all.push_back(static_cast<std::uint32_t>(draw.quads.size()));
    }
    return all;
  };
  EXPECT_EQ(skips(1), skips(1));
  EXPECT_NE(skips(1), skips(2));
}

}  // namespace
}  // namespace quadrille::tb
