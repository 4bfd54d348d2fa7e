#include "model/port/snap.hpp"
#include "model/skips/hierarchical_z_test_support.hpp"

#include <gtest/gtest.h>

namespace quadrille {
namespace {

/// A block's bound is that of its farthest tile, whichever comes first, and the next round's is its own.
TEST(HiddenBlocks, FarthestTileDecidesAndEachRoundBeginsAnew) {
  constexpr std::uint32_t before = 500;
  for (int farthest = 0; farthest < 64; ++farthest)
    for (const bool first : {false, true}) {
      HiddenBlocks blocks(configured({{"hierarchical_z_bits", 10}}));
      const auto learn = [&](int tile, std::uint32_t far) { blocks.learn(8 + tile % 8, 16 + tile / 8, far); };
      const auto hidden = [&](std::uint32_t near) { return blocks.hidden(8, 16, 8, 8, near); };
      const auto round = [&](std::uint32_t far) {
        if (first) learn(farthest, far + 1);
        for (int tile = 0; tile < 64; ++tile)
          if (tile != farthest) learn(tile, far);
        if (!first) {
          EXPECT_FALSE(hidden(far + 1)) << "a tile is missing";
          learn(farthest, far + 1);
        }
        EXPECT_TRUE(hidden(far + 1)) << "tile " << farthest << (first ? " first" : " last");
        EXPECT_FALSE(hidden(far)) << "tile " << farthest << (first ? " first" : " last");
      };
      round(before);
      round(before / 2);
    }
}

/// Rows of tiles with depths drawn at random from a quad's interval, a depth buffer beside them: what is left out is
/// behind what the buffer holds, and a tile that is hidden is so in all its pixels.
TEST(MaskedDepth, NothingIsLeftOutThatTheBufferWouldTake) {
  for (const int tile_log2 : {2, 3, 4}) {
    const Config config =
        configured({{"tile_log2", tile_log2}, {"hierarchical_z_bits", 6}, {"hierarchical_z_tiles_log2", 6}});
    const int edge = config.tile();
    const std::uint32_t whole = (1u << edge) - 1, cleared = 1u << config.hierarchical_z_bits;
    MaskedDepth memory(config);
    Prng rng(static_cast<std::uint64_t>(40 + tile_log2));
    // Two tiles at one place of 8 × 8, and one elsewhere.
    const std::array<std::array<int, 2>, 3> tiles{{{1, 2}, {9, 2}, {2, 2}}};
    std::array<std::array<std::uint32_t, 256>, 3> buffer;
    for (auto& b : buffer) b.fill(cleared);
    std::uint64_t left_out = 0, hidden_tiles = 0, tests = 0;
    for (int n = 0; n < 60'000; ++n) {
      if (n % 300 == 299) {
        memory.clear();
        for (auto& b : buffer) b.fill(cleared);
      }
      const std::size_t t = rng.below(10) == 0 ? rng.below(3) : 0;
      DepthInterval depth;
      // Nearer and nearer until the clear, or nothing would be seen.
      const auto base = static_cast<std::uint32_t>((300 - n % 300) / 6 + static_cast<int>(rng.below(12)));
      depth.near = std::min(base, cleared - 2);
      depth.far = std::min(depth.near + 1 + static_cast<std::uint32_t>(rng.below(4)), cleared - 1);
      depth.lowers = rng.below(4) != 0 && depth.far != cleared - 1;
      // A rectangle of the tile, or pixels at random.
      const bool sparse = rng.below(8) == 0;
      const int x0 = static_cast<int>(rng.below(static_cast<std::uint64_t>(edge))) / 2 * 2 *
                     static_cast<int>(rng.below(2)),
                y0 = static_cast<int>(rng.below(static_cast<std::uint64_t>(edge))) * static_cast<int>(rng.below(2));
      memory.begin(tiles[t][0], tiles[t][1], depth);
      const bool hidden = memory.hidden();
      hidden_tiles += hidden;
      const auto draw = [&](int y, std::uint32_t covered, std::uint32_t seen) {
        ASSERT_EQ(seen & ~covered, 0u);
        for (int x = 0; x < edge; ++x) {
          if ((covered >> x & 1) == 0) continue;
          std::uint32_t& held = buffer[t][static_cast<std::size_t>(y * edge + x)];
          ++tests;
          if ((seen >> x & 1) == 0) {
            ++left_out;
            ASSERT_GE(depth.near, held) << "tile " << t << ", step " << n << ", pixel " << x << ", " << y;
            continue;
          }
          // The farthest depth that it can have; without `lowers` it may not be a fragment.
          if (depth.lowers) held = std::min(held, depth.far);
        }
      };
      for (int y = 0; y < edge; ++y) {
        const auto random = static_cast<std::uint32_t>(rng.below(std::uint64_t{1} << edge));
        const std::uint32_t covered = y < y0 ? 0 : sparse ? random : whole >> x0 << x0;
        draw(y, covered, hidden ? 0 : memory.row(y, covered));
        if (HasFatalFailure()) return;
      }
      if (!hidden) memory.end();
    }
    EXPECT_GT(left_out, tests / 20);
    EXPECT_GT(hidden_tiles, 1000u);
  }
}

TEST(MaskedDepth, QuadsThatCoverATileTogetherHideIt) {
  const Config config = configured();
  const DrawState state = viewport(32, 32);
  BothWays both(config, state);
  // Four quads that meet inside tile (1, 1), and nothing beside it.
  both.draw(snap_quad(rectangle(0, 8, 8, 13, 11, 0.25), config, state));
  both.draw(snap_quad(rectangle(1, 13, 8, 16, 11, 0.26), config, state));
  both.draw(snap_quad(rectangle(2, 8, 11, 13, 16, 0.27), config, state));
  EXPECT_EQ(both.pixels(), 64u - 15);
  both.draw(snap_quad(rectangle(3, 13, 11, 16, 16, 0.28), config, state));
  EXPECT_EQ(both.pixels(), 64u);
  EXPECT_EQ(both.masked(), 0u);
  both.draw(snap_quad(rectangle(4, 8, 8, 16, 16, 0.5), config, state));
  EXPECT_EQ(both.masked(), 1u);
  EXPECT_EQ(both.pixels(), 64u);
  // Something in front is seen, and what is cleared does not hide.
  both.draw(snap_quad(rectangle(5, 9, 9, 15, 15, 0.125), config, state));
  EXPECT_EQ(both.pixels(), 64u + 36);
  EXPECT_TRUE(both.same());
  both.clear();
  both.draw(snap_quad(rectangle(6, 9, 9, 15, 15, 0.5), config, state));
  EXPECT_EQ(both.masked(), 1u);
  EXPECT_EQ(both.pixels(), 64u + 72);
  EXPECT_TRUE(both.same());
}

TEST(MaskedDepth, WhatBeginsWhereAllEndsIsHiddenAndBeforeItIsNot) {
  const Config config = configured();
  for (const std::uint32_t near : {499u, 500u, 501u}) {
    MaskedDepth masked(config);
    const auto cover = [&](const DepthInterval& depth, std::uint32_t mask) {
      masked.begin(1, 1, depth);
      std::uint32_t seen = 0;
      for (int row = 0; row < 1 << config.tile_log2; ++row) seen |= masked.row(row, mask);
      masked.end();
      return seen;
    };
    EXPECT_EQ(cover({400, 500, true}, 0xff), 0xffu);
    masked.begin(1, 1, {near, near + 1, false});
    EXPECT_EQ(masked.hidden(), near >= 500) << near;
    EXPECT_EQ(cover({near, near + 1, false}, 0x3c), near >= 500 ? 0u : 0x3cu) << near;
  }
}

TEST(MaskedDepth, OnePixelMoreJoinsTheMask) {
  const Config config = configured();
  MaskedDepth masked(config);
  const int rows = 1 << config.tile_log2;
  masked.begin(0, 0, {400, 500, true});  // all but the first pixel of the tile, and then that one
  for (int row = 0; row < rows; ++row) masked.row(row, row == 0 ? 0xfe : 0xff);
  masked.end();
  masked.begin(0, 0, {500, 501, false});
  EXPECT_FALSE(masked.hidden());
  masked.begin(0, 0, {400, 500, true});
  masked.row(0, 0x01);
  masked.end();
  masked.begin(0, 0, {500, 501, false});
  EXPECT_TRUE(masked.hidden());
}

TEST(MaskedDepth, PixelsInTheMaskAreLeftOutOneByOne) {
  const Config config = configured();
  DrawState state = viewport(32, 32);
  BothWays both(config, state);
  both.draw(snap_quad(rectangle(0, 8, 8, 13, 11, 0.25), config, state));
  both.draw(snap_quad(rectangle(1, 10, 11, 16, 14, 0.27), config, state));
  EXPECT_EQ(both.pixels(), 15u + 18);
  state.zfar = 0.7;  // what is behind lowers nothing
  both.set_state(state);
  both.draw(snap_quad(rectangle(2, 8, 8, 16, 16, 0.6999), config, state));
  EXPECT_EQ(both.pixels(), 64u);
  both.draw(snap_quad(rectangle(3, 8, 8, 16, 16, 0.26), config, state));
  EXPECT_EQ(both.pixels(), 128u) << "before the farther of the two, which the mask is as near as";
  EXPECT_TRUE(both.same());
}

}  // namespace
}  // namespace quadrille
