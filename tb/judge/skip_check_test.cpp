// The comparison of skips is itself checked: what a machine draws otherwise, and a skip that changes a fragment.
#include "tb/judge/skip_check.hpp"

#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/random_state.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

namespace quadrille::tb {
namespace {

struct Drawn {
  Config config;
  DrawState state;
  std::vector<SnappedQuad> quads;
  std::vector<Fragment> fragments;

  explicit Drawn(std::uint64_t seed, bool hides = false) {
    config.set("significand_bits", 12);
    if (hides) config.set("hierarchical_z_bits", 12);
    state = small_state(config);
    if (seed > 0) state = golden::random_draw_state(config, 48, 40, {}, seed);
    if (hides) {
      state.depth = true;
      state.skip |= skip_hidden;
    }
    quads = random_quads(config, state, seed, 150);
    UntimedModel model(config, state);
    for (const SnappedQuad& quad : quads)
      model.draw(quad, [&](std::span<const Fragment> f) { fragments.insert(fragments.end(), f.begin(), f.end()); });
  }
  SkipResult check(bool complete = true) const {
    WorkQueue queue(1, 8);
    SkipCheck check(config, state, quads.size());
    for (const Fragment& f : fragments) check.fragment(f);
    return check.compare(quads, quads.size(), complete, queue);
  }
};

TEST(SkipCheck, NoSkipChangesAFragment) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Drawn drawn(seed, seed % 3 == 2);
    const SkipResult result = drawn.check();
    EXPECT_EQ(result.differences, 0u) << "seed " << seed << ": " << result.first;
    EXPECT_GE(result.compared, 5 * drawn.fragments.size());
  }
}

/// Each way in which a machine's own list may differ: a bit, a pixel less, one twice, another order.
TEST(SkipCheck, WhatTheMachineDrawsOtherwiseShows) {
  const Drawn good(0);
  ASSERT_GT(good.fragments.size(), 1000u);
  const auto differs = [&](const auto& change) {
    Drawn bad = good;
    change(bad.fragments);
    const SkipResult result = bad.check();
    EXPECT_FALSE(result.first.empty());
    return result.differences == 1;
  };
  using List = std::vector<Fragment>;
  EXPECT_TRUE(differs([](List& f) { f[500].depth ^= 1; }));
  EXPECT_TRUE(differs([](List& f) { f[500].flags ^= flag_tie; }));
  EXPECT_TRUE(differs([](List& f) { f[500].front = !f[500].front; }));
  EXPECT_TRUE(differs([](List& f) { f[500].attribute[3] += 1; }));
  EXPECT_TRUE(differs([](List& f) { f.erase(f.begin() + 500); }));
  EXPECT_TRUE(differs([](List& f) { f.insert(f.begin() + 500, f[500]); }));
  EXPECT_TRUE(differs([](List& f) {
    std::size_t at = 500;
    while (f[at].quad != f[at + 1].quad) ++at;
    std::swap(f[at], f[at + 1]);
  }));
}

/// A draw that was cut off: of the quad that it was in, and of those behind, nothing is held against the machine.
TEST(SkipCheck, OfADrawThatWasCutOffTheQuadsBefore) {
  Drawn cut(0);
  cut.fragments.resize(600);
  EXPECT_EQ(cut.check(false).differences, 0u);
  EXPECT_GT(cut.check(true).differences, 0u);
  cut.fragments[10].depth ^= 1;
  EXPECT_EQ(cut.check(false).differences, 1u);
}

}  // namespace
}  // namespace quadrille::tb
