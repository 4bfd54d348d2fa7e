// Draws whose fault is known: what must be left is, and nothing else.
#include "tb/check/shrink.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille::cli {
namespace {

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

bool has(const FailingDraw& draw, std::uint32_t id) {
  return std::ranges::any_of(draw.quads, [&](const WindowQuad& q) { return q.id == id; });
}

bool sees(const DrawState& s, int x, int y) {
  return x >= s.scissor_x0 && x < s.scissor_x1 && y >= s.scissor_y0 && y < s.scissor_y1;
}

TEST(Shrink, OneQuadAtOnePixel) {
  for (const std::uint32_t wrong : {0u, 1u, 500u, 998u, 999u}) {
    const FailingDraw left = shrink(
        draw_of(1000), [&](const FailingDraw& d) { return has(d, wrong) && sees(d.state, 100, 511); }, 100'000);
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
    const DrawState plain;
    EXPECT_EQ(left.state.cull, plain.cull);
    EXPECT_EQ(left.state.znear, plain.znear);
    EXPECT_EQ(left.state.perspective, plain.perspective);
    EXPECT_EQ(left.state.skip, plain.skip);
  }
}

/// Three quads that fail together, with a stall and a draw state that are needed.
TEST(Shrink, WhatIsNeededStays) {
  const auto fails = [](const FailingDraw& d) {
    return has(d, 3) && has(d, 77) && has(d, 78) && d.stall > 0 && d.state.cull == Cull::back && !d.state.perspective &&
           sees(d.state, 7, 9) && sees(d.state, 30, 200) && d.state.width > 40;
  };
  const FailingDraw left = shrink(draw_of(200), fails, 100'000);
  ASSERT_EQ(left.quads.size(), 3u);
  EXPECT_TRUE(fails(left));
  EXPECT_EQ(left.gap, 0);
  EXPECT_EQ(left.state.znear, 0);
  EXPECT_EQ(left.state.skip, skip_default);
  EXPECT_EQ(left.state.scissor_x0, 7);
  EXPECT_EQ(left.state.scissor_x1, 31);
  EXPECT_EQ(left.state.scissor_y0, 9);
  EXPECT_EQ(left.state.scissor_y1, 201);
  EXPECT_EQ(left.state.width, DrawState{}.width);
}

/// It ends after so many tries, with a draw that fails.
TEST(Shrink, EndsAfterSoManyTries) {
  for (const std::uint64_t most : {0u, 1u, 5u, 20u}) {
    std::uint64_t tries = 0;
    const FailingDraw left = shrink(
        draw_of(1000),
        [&](const FailingDraw& d) {
          ++tries;
          return has(d, 600);
        },
        most);
    EXPECT_LE(tries, most);
    EXPECT_TRUE(has(left, 600));
  }
}

/// A fault that every second try shows (as one that depends on more than the draw) is no reason to go on for ever.
TEST(Shrink, FickleFaults) {
  bool show = false;
  std::uint64_t tries = 0;
  shrink(
      draw_of(100),
      [&](const FailingDraw&) {
        ++tries;
        return show = !show;
      },
      100'000);
  EXPECT_LT(tries, 2'000u);
}

}  // namespace
}  // namespace quadrille::cli
