// Draws whose fault is known: what must be left is, and nothing else.
#include "tb/lockstep/shrink.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille::tb {
namespace {

constexpr std::uint64_t clocks = 400;  ///< of every run of these tests

FailingDraw draw_of(std::size_t quads) {
  FailingDraw draw;
  draw.quads.resize(quads);
  for (std::size_t i = 0; i < quads; ++i) draw.quads[i].id = static_cast<std::uint32_t>(i);
  draw.state.cull = Cull::back;
  draw.state.znear = 0.25;
  draw.state.perspective = false;
  draw.state.skip = 0;
  draw.stall = 0.5;
  draw.gap = 0.25;
  return draw;
}

/// The waits of a draw, at random or listed.
PortWaits waits_of(const FailingDraw& draw) {
  if (draw.waits) return *draw.waits;
  PortWaits waits;
  golden::Prng stalls(draw.seed, 2), gaps(draw.seed, 1);
  for (std::uint64_t clock = 0; clock < clocks; ++clock)
    if (stalls.chance(draw.stall)) waits.stall_clocks.push_back(clock);
  for (std::uint64_t beat = 0; beat < 4 * draw.quads.size(); ++beat)
    while (gaps.chance(draw.gap)) waits.gap_beats.push_back(beat);
  return waits;
}

/// Runs that fail where `fails` says so of a draw whose waits are listed.
template <class Fails>
FailingRun failing(Fails fails) {
  return [fails](const FailingDraw& draw) -> std::optional<Failure> {
    FailingDraw listed = draw;
    listed.waits = waits_of(draw);
    if (!fails(listed)) return std::nullopt;
    return Failure{draw.quads.size(), *listed.waits};
  };
}

FailingDraw least(FailingDraw draw, const FailingRun& run, const ShrinkLimits& limits = {}) {
  const std::optional<Shrunk> shrunk = shrink(std::move(draw), run, limits);
  EXPECT_TRUE(shrunk && !shrunk->ended);
  return shrunk.value_or(Shrunk{}).draw;
}

bool has(const FailingDraw& draw, std::uint32_t id) {
  return std::ranges::any_of(draw.quads, [&](const WindowQuad& q) { return q.id == id; });
}

bool sees(const DrawState& s, int x, int y) {
  return x >= s.scissor_x0 && x < s.scissor_x1 && y >= s.scissor_y0 && y < s.scissor_y1;
}

bool stalls_in(const FailingDraw& draw, std::uint64_t clock) {
  return std::ranges::binary_search(draw.waits->stall_clocks, clock);
}

/// So many stalls in a row, from `clock` on.
bool stalls_from(const FailingDraw& draw, std::uint64_t clock, int in_a_row) {
  for (int i = 0; i < in_a_row; ++i)
    if (!stalls_in(draw, clock + static_cast<std::uint64_t>(i))) return false;
  return true;
}

TEST(Shrink, OneQuadAtOnePixel) {
  for (const std::uint32_t wrong : {0u, 1u, 500u, 998u, 999u}) {
    const FailingDraw left =
        least(draw_of(1000), failing([&](const FailingDraw& d) { return has(d, wrong) && sees(d.state, 100, 511); }));
    ASSERT_EQ(left.quads.size(), 1u);
    EXPECT_EQ(left.quads[0].id, wrong);
    EXPECT_EQ(left.state.scissor_x0, 100);
    EXPECT_EQ(left.state.scissor_x1, 101);
    EXPECT_EQ(left.state.scissor_y0, 511);
    EXPECT_EQ(left.state.scissor_y1, 512);
    EXPECT_EQ(left.state.width, 101);
    EXPECT_EQ(left.state.height, 512);
    EXPECT_EQ(left.stall, 0);
    EXPECT_EQ(left.gap, 0);
    EXPECT_TRUE(left.waits->empty());
    const DrawState plain;
    EXPECT_EQ(left.state.cull, plain.cull);
    EXPECT_EQ(left.state.znear, plain.znear);
    EXPECT_EQ(left.state.perspective, plain.perspective);
    EXPECT_EQ(left.state.skip, plain.skip);
  }
}

/// Three quads that fail together, with stalls and a draw state that are needed.
TEST(Shrink, WhatIsNeededStays) {
  const std::vector<std::uint64_t> stalls = waits_of(draw_of(1)).stall_clocks;
  const std::uint64_t early = stalls[3], late = stalls[100];
  const auto fails = [&](const FailingDraw& d) {
    return has(d, 3) && has(d, 77) && has(d, 78) && stalls_in(d, early) && stalls_in(d, late) &&
           d.state.cull == Cull::back && !d.state.perspective && sees(d.state, 7, 9) && sees(d.state, 30, 200) &&
           d.state.width > 40;
  };
  const FailingDraw left = least(draw_of(200), failing(fails));
  ASSERT_EQ(left.quads.size(), 3u);
  EXPECT_TRUE(fails(left));
  EXPECT_EQ(*left.waits, (PortWaits{{early, late}, {}}));
  EXPECT_EQ(left.stall, 0);
  EXPECT_EQ(left.gap, 0);
  EXPECT_EQ(left.state.znear, 0);
  EXPECT_EQ(left.state.skip, skip_default);
  EXPECT_EQ(left.state.scissor_x0, 7);
  EXPECT_EQ(left.state.scissor_x1, 31);
  EXPECT_EQ(left.state.scissor_y0, 9);
  EXPECT_EQ(left.state.scissor_y1, 201);
  EXPECT_EQ(left.state.width, DrawState{}.width);
}

/// A quad that fails where the output stalls as it leaves, earlier the fewer quads and pixels are before it: the waits
/// of the whole draw meet it nowhere, others do.
TEST(Shrink, FewerQuadsWantOtherWaits) {
  const auto fails = [](const FailingDraw& d) {
    for (std::size_t i = 0; i < d.quads.size(); ++i) {
      const auto rows = static_cast<std::uint64_t>(d.state.scissor_y1 - d.state.scissor_y0);
      if (d.quads[i].id % 5 == 2 && stalls_from(d, 9 + 31 * i + rows / 64, 3)) return true;
    }
    return false;
  };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    FailingDraw draw = draw_of(12);
    draw.seed = seed;
    FailingDraw listed = draw;
    listed.waits = waits_of(draw);
    if (!fails(listed)) continue;
    const FailingDraw left = least(draw, failing(fails));
    EXPECT_EQ(left.quads.size(), 1u) << seed;
    EXPECT_EQ(left.state.scissor_y1 - left.state.scissor_y0, 1) << seed;
    EXPECT_EQ(*left.waits, (PortWaits{{9, 10, 11}, {}})) << seed;
  }
}

/// Gaps go with the quads that are left out: those of the others stay before their beats.
TEST(Shrink, GapsStayBeforeTheirBeats) {
  FailingDraw draw = draw_of(8);
  draw.stall = draw.gap = 0;
  draw.waits = PortWaits{{}, {1, 4, 21, 21, 22, 30}};
  const auto fails = [](const FailingDraw& d) {
    for (std::size_t i = 0; i < d.quads.size(); ++i)
      if (d.quads[i].id == 5 && std::ranges::count(d.waits->gap_beats, 4 * i + 1) == 2) return true;
    return false;
  };
  ShrinkLimits as_listed;
  as_listed.redraws = 0;
  const FailingDraw left = least(draw, failing(fails), as_listed);
  ASSERT_EQ(left.quads.size(), 1u);
  EXPECT_EQ(left.quads[0].id, 5u);
  EXPECT_EQ(*left.waits, (PortWaits{{}, {1, 1}}));
}

/// Nothing that is left can be left out by itself, whatever the fault asks for.
TEST(Shrink, NothingCanBeLeftOutByItself) {
  golden::Prng random(8);
  for (int i = 0; i < 50; ++i) {
    FailingDraw draw = draw_of(40);
    draw.seed = static_cast<std::uint64_t>(i);
    if (i % 2 == 1) draw.gap = 0;
    const PortWaits all = waits_of(draw);
    std::vector<std::uint32_t> ids;
    std::vector<std::uint64_t> stalls;
    for (std::uint64_t n = 1 + random.below(3); n > 0; --n) ids.push_back(static_cast<std::uint32_t>(random.below(40)));
    for (std::uint64_t n = random.below(6); n > 0; --n)
      stalls.push_back(all.stall_clocks[random.below(all.stall_clocks.size())]);
    const auto fails = [&](const FailingDraw& d) {
      return std::ranges::all_of(ids, [&](std::uint32_t id) { return has(d, id); }) &&
             std::ranges::all_of(stalls, [&](std::uint64_t clock) { return stalls_in(d, clock); });
    };
    const FailingDraw left = least(draw, failing(fails));
    std::ranges::sort(ids);
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::ranges::sort(stalls);
    stalls.erase(std::unique(stalls.begin(), stalls.end()), stalls.end());
    EXPECT_EQ(left.quads.size(), ids.size());
    EXPECT_EQ(*left.waits, (PortWaits{stalls, {}}));
    EXPECT_EQ(left.stall, 0);  // which would draw others
  }
}

/// A quad that is needed only as long as there are many pixels.
TEST(Shrink, FewerPixelsMayNeedFewerQuads) {
  const FailingDraw left = least(draw_of(20), failing([](const FailingDraw& d) {
                                   return has(d, 3) && (has(d, 12) || d.state.scissor_x1 - d.state.scissor_x0 <= 8);
                                 }));
  EXPECT_EQ(left.quads.size(), 1u);
}

/// Quads that the machine had not begun are gone at once.
TEST(Shrink, OnlyQuadsThatWereTaken) {
  std::vector<std::size_t> tried;
  shrink(draw_of(1000), [&](const FailingDraw& d) -> std::optional<Failure> {
    tried.push_back(d.quads.size());
    if (!has(d, 300)) return std::nullopt;
    return Failure{300, waits_of(d)};
  });
  ASSERT_GE(tried.size(), 2u);
  EXPECT_EQ(tried[1], 301u);
}

/// Waits that are drawn anew are never those of a draw before.
TEST(Shrink, EveryRedrawHasItsSeed) {
  std::vector<std::uint64_t> seeds;
  shrink(draw_of(10), [&](const FailingDraw& d) -> std::optional<Failure> {
    if (!d.waits) seeds.push_back(d.seed);
    if (d.waits && (d.waits->stall_clocks.empty() || d.quads.size() < 10)) return std::nullopt;
    if (!d.waits && d.seed > 1) return std::nullopt;
    return Failure{d.quads.size(), waits_of(d)};
  });
  EXPECT_GT(seeds.size(), 10u);
  std::ranges::sort(seeds);
  EXPECT_EQ(std::ranges::adjacent_find(seeds), seeds.end());
}

TEST(Shrink, WhatDoesNotFailAgain) {
  EXPECT_FALSE(shrink(draw_of(10), failing([](const FailingDraw&) { return false; })));
}

/// It ends after so many tries or when the time is up, says so, and leaves a draw that fails, whose chances, where it
/// has some, draw just its waits.
TEST(Shrink, EndsAtItsLimits) {
  FailingDraw draw = draw_of(40);
  draw.stall = 0;
  const std::uint64_t beat = waits_of(draw).gap_beats[20];
  const auto needed = static_cast<std::uint32_t>(beat / 4);
  const FailingRun run = failing([&](const FailingDraw& d) {
    for (std::size_t i = 0; i < d.quads.size(); ++i)
      if (d.quads[i].id == needed && std::ranges::binary_search(d.waits->gap_beats, 4 * i + beat % 4)) return true;
    return false;
  });
  bool with_chances = false, without = false;
  for (std::uint64_t most = 1; most <= 30; ++most) {
    for (const bool timed : {false, true}) {
      std::uint64_t tries = 0;
      ShrinkLimits limits;
      if (timed)
        limits.out_of_time = [&] { return tries >= most; };
      else
        limits.tries = most;
      const std::optional<Shrunk> left = shrink(
          draw,
          [&](const FailingDraw& d) {
            ++tries;
            return run(d);
          },
          limits);
      EXPECT_EQ(tries, most);
      ASSERT_TRUE(left);
      EXPECT_TRUE(left->ended);
      EXPECT_EQ(left->tries, tries);
      EXPECT_TRUE(run(left->draw));
      FailingDraw drawn = left->draw;
      drawn.waits.reset();
      if (drawn.gap > 0) {
        EXPECT_EQ(*left->draw.waits, waits_of(drawn)) << most;
      }
      (drawn.gap > 0 ? with_chances : without) = true;
    }
  }
  EXPECT_TRUE(with_chances && without);
}

/// A fault that every second try shows (as one that depends on more than the draw) is no reason to go on for ever.
TEST(Shrink, FickleFaults) {
  bool show = false;
  std::uint64_t tries = 0;
  const std::optional<Shrunk> left = shrink(draw_of(100), [&](const FailingDraw& d) -> std::optional<Failure> {
    ++tries;
    if (!(show = !show)) return std::nullopt;
    return Failure{d.quads.size(), waits_of(d)};
  });
  EXPECT_TRUE(left && !left->ended);
  EXPECT_LT(tries, 10'000u);
}

}  // namespace
}  // namespace quadrille::tb
