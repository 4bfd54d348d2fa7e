// The walk of homogeneous quads, which have no bounding box: it enters no tile outside the scissor's tiles, it takes
// the steps that its bounds say, and what it enters is what a walk from the first tile of the screen would, in the same
// order.
#include "model/clocked.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/front/tile_walk.hpp"
#include "model/port/snap.hpp"

#include "golden/scenes/stress.hpp"
#include "model/skips/both_ways_test_support.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

/// Both ends included.
struct Range {
  int first, last;

  int count() const { return last - first + 1; }
  bool has(int n) const { return n >= first && n <= last; }
};

/// The scissor's columns and rows of tiles and of blocks, of a quad that begins at the screen's first tile.
struct ScissorTiles {
  Range column, row, block_column, block_row;

  ScissorTiles(const Config& c, const DrawState& s)
      : column{s.scissor_x0 >> c.tile_log2, (s.scissor_x1 - 1) >> c.tile_log2},
        row{s.scissor_y0 >> c.tile_log2, (s.scissor_y1 - 1) >> c.tile_log2},
        block_column{column.first / Config::block_tiles, column.last / Config::block_tiles},
        block_row{row.first / Config::block_tiles, row.last / Config::block_tiles} {}

  bool has(int x, int y) const { return column.has(x) && row.has(y); }
  int blocks() const { return block_column.count() * block_row.count(); }
  int tiles() const { return column.count() * row.count(); }
  /// Those that the walk may test: of the scissor's blocks, but for those beyond its last column and row.
  int tiles_of_blocks() const {
    return (column.last - block_column.first * Config::block_tiles + 1) *
           (row.last - block_row.first * Config::block_tiles + 1);
  }
  /// Steps without a test: down to the first row of blocks, right to the end of it at which a walk of the whole screen
  /// comes there, and one to begin with the tests.
  int approach() const {
    if (block_column.first == 0 && block_row.first == 0) return 0;
    return block_row.first + (block_row.first % 2 != 0 ? block_column.last : block_column.first) + 1;
  }
};

struct Steps {
  int approach = 0, blocks = 0, tiles = 0;
  std::vector<TileCorner> entered;
  bool left_scissor = false;  ///< a block was tested that has no tile of the scissor
};

Steps walk(const SetupResult& setup, const Config& config, const DrawState& state) {
  const ScissorTiles scissor(config, state);
  Steps steps;
  TileWalk w(config, state);
  for (w.take(setup); w.state() != TileWalk::State::end; w.advance()) {
    if (w.state() == TileWalk::State::approach) {
      ++steps.approach;
    } else if (w.state() == TileWalk::State::block) {
      ++steps.blocks;
      const TileBlock block = w.block();
      steps.left_scissor |= !scissor.block_column.has(block.tile_x / Config::block_tiles) ||
                            !scissor.block_row.has(block.tile_y / Config::block_tiles);
    } else {
      ++steps.tiles;
      if (w.hit()) steps.entered.push_back(w.corner());
    }
  }
  return steps;
}

/// What a walk of all tiles from the screen's first one finds inside the scissor's: each tile's functions from the
/// quad's, without a step.
std::vector<TileCorner> whole_walk(const SetupResult& setup, const Config& config, const DrawState& state) {
  constexpr int block_tiles = Config::block_tiles;
  const ScissorTiles scissor(config, state);
  const QuadConstants constants(setup);
  std::vector<TileCorner> entered;
  const auto test = [&](int x, int y) {
    if (x >= setup.tiles_x || y >= setup.tiles_y || !scissor.has(x, y)) return;
    WalkState at;
    for (std::size_t k = 0; k < linear_count; ++k) at.linear[k] = setup.linear[k].value;
    walk_step(at, constants, x * config.tile(), y * config.tile());
    if (Squares(constants, config.tile(), state.cull).may_cover(at)) entered.push_back({x, y, at.linear});
  };
  const auto columns_of = [&](int bx) { return std::min(block_tiles, setup.tiles_x - bx * block_tiles); };
  const int blocks_x = (setup.tiles_x + block_tiles - 1) / block_tiles;
  for (int by = 0; by * block_tiles < setup.tiles_y; ++by)
    for (int i = 0; i < blocks_x; ++i) {
      const int bx = by % 2 == 0 ? i : blocks_x - 1 - i;
      for (int ty = 0; ty < block_tiles; ++ty)
        for (int j = 0; j < columns_of(bx); ++j) {
          const int tx = ty % 2 == 0 ? j : columns_of(bx) - 1 - j;
          test(bx * block_tiles + tx, by * block_tiles + ty);
        }
    }
  return entered;
}

bool same(const TileCorner& a, const TileCorner& b) {
  return a.tile_x == b.tile_x && a.tile_y == b.tile_y && a.linear == b.linear;
}

DrawState screen(int size) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
  state.attributes = 0;
  return state;
}

/// A rectangle anywhere, of any size from a pixel to `most`, as likely small as large.
void random_scissor(Prng& rng, DrawState& state, int most) {
  const auto part = [&](int size, int& lo, int& hi) {
    const int length = std::min(size, static_cast<int>(std::exp2(rng.uniform(0, std::log2(most)))));
    lo = static_cast<int>(rng.integer(0, size - length));
    hi = lo + length;
  };
  part(state.width, state.scissor_x0, state.scissor_x1);
  part(state.height, state.scissor_y0, state.scissor_y1);
}

/// Vertices of any size that the port takes, some of them behind the eye.
SnappedQuad any_vertices(Prng& rng, const Config& c) {
  const int one = 1 << c.frac();
  const double most = std::log2(static_cast<double>(one)) + c.viewport_bits + c.guard_bits - 2;
  SnappedQuad q;
  const std::uint64_t behind = 1 + rng.below(14);
  for (std::size_t i = 0; i < 4; ++i) {
    SnappedVertex& v = q.vertex[i];
    const auto coordinate = [&] {
      return static_cast<std::int32_t>(rng.log2_spread(most - 6, most) * (rng.chance(0.5) ? -1 : 1));
    };
    v.x = coordinate();
    v.y = coordinate();
    v.w = static_cast<std::int32_t>(one * rng.log2_spread(-4, 0)) * ((behind >> i & 1) != 0 ? -1 : 1);
    v.k = {false, 0, 1u << (c.significand_bits - 1)};
    v.z = {false, -1, 1u << (c.significand_bits - 1)};
  }
  return q;
}

/// The quad whose walk was found to take 4,681,696 clocks: it covers most of the screen, and its scissor is far from
/// the screen's first tile.
SnappedQuad far_quad(const Config& c) {
  SnappedQuad q;
  constexpr std::array<std::array<std::int32_t, 3>, 4> vertices{{{-144491410, -42213348, -32768},
                                                                 {431098496, -283321344, 32768},
                                                                 {-508334954, 382684152, -32768},
                                                                 {-327419847, 17421108, -32768}}};
  for (std::size_t i = 0; i < 4; ++i) {
    SnappedVertex& v = q.vertex[i];
    v.x = vertices[i][0];
    v.y = vertices[i][1];
    v.w = vertices[i][2];
    v.k = {false, 0, 1u << (c.significand_bits - 1)};
    v.z = {false, -1, 1u << (c.significand_bits - 1)};
  }
  return q;
}

TEST(ScissorWalk, AScissorFarFromTheFirstTileCostsItsOwnTiles) {
  const Config c;
  DrawState state = screen(4096);
  state.scissor_x0 = 3898;
  state.scissor_x1 = 3919;
  state.scissor_y0 = 2494;
  state.scissor_y1 = 2720;
  const SnappedQuad quad = far_quad(c);
  ClockedModel machine(c, state);
  ClockedInputs in;
  in.vertex_valid = in.fragment_ready = true;
  for (std::size_t i = 0; i < 4; ++i) {
    in.vertex = beat_of(quad, i);
    machine.clock(in);
  }
  in.vertex_valid = false;
  // A walk that does not end soon is broken off.
  constexpr std::uint64_t patience = 50'000;
  while (machine.comb().busy && machine.counters()[PerformanceCounter::clocks] < patience) machine.clock(in);
  const PerformanceCounters counters = machine.counters();
  using enum PerformanceCounter;
  const ScissorTiles scissor(c, state);
  const auto blocks = static_cast<std::uint64_t>(scissor.blocks()),
             tiles = static_cast<std::uint64_t>(scissor.tiles_of_blocks()),
             approach = static_cast<std::uint64_t>(scissor.approach());
  EXPECT_EQ(counters[quads_homogeneous], 1u);
  EXPECT_EQ(counters[blocks_tested], blocks);
  EXPECT_LE(counters[tiles_tested], tiles);
  EXPECT_LE(counters[tiles_entered], static_cast<std::uint64_t>(scissor.tiles()));
  EXPECT_GE(counters[bound_walk], approach + blocks);
  // Beats and setup; steps of the walk, one more for each block that is entered; of each tile its functions and its
  // rows, of each pixel three parts; the pipeline.
  constexpr std::uint64_t setup = 4 + 51, around = 128, tile_functions = 29, pixel_parts = 3;
  const std::uint64_t bound = setup + approach + 2 * blocks + tiles + (tile_functions + 8) * counters[tiles_entered] +
                              pixel_parts * counters[pixels_lane0] + around;
  EXPECT_LE(counters[clocks], bound);
  std::printf("%llu clocks, at most %llu; %llu blocks and %llu tiles tested, %llu entered\n",
              static_cast<unsigned long long>(counters[clocks]), static_cast<unsigned long long>(bound),
              static_cast<unsigned long long>(counters[blocks_tested]),
              static_cast<unsigned long long>(counters[tiles_tested]),
              static_cast<unsigned long long>(counters[tiles_entered]));

  state.skip &= ~std::uint32_t{skip_walk};
  EXPECT_GT(walk(quad_setup(quad, c, state), c, state).entered.size(), 100'000u) << "the quad is no load any more";
}

/// `count` quads across the eye at 4096 x 4096, the scissor anywhere.
void nothing_outside(int count) {
  constexpr int size = 4096;
  const Config c;
  Prng rng(1, 14);
  std::vector<WindowQuad> family;
  std::uint64_t entered = 0, steps = 0;
  int quads = 0, crossed = 0, to_the_left = 0, outside_without = 0;
  for (std::uint64_t n = 0; quads < count && !testing::Test::HasFailure(); ++n) {
    DrawState state = screen(size);
    random_scissor(rng, state, size / 8);
    state.cull = static_cast<Cull>(rng.below(3));
    if (n % 512 == 0)
      family =
          golden::make_stress(n % 1024 == 0 ? golden::StressFamily::eye_crossing : golden::StressFamily::eye_in_hull,
                              256, n, 1.0, size, size, 0);
    const SnappedQuad quad = n % 2 == 0 ? snap_quad(family[n / 2 % 256], c, state) : any_vertices(rng, c);
    if (is_ordinary(quad, c)) continue;
    ++quads;
    const SetupResult setup = quad_setup(quad, c, state);
    const ScissorTiles scissor(c, state);
    const Steps taken = walk(setup, c, state);
    ASSERT_EQ(taken.approach, scissor.approach()) << "quad " << n;
    ASSERT_EQ(taken.blocks, scissor.blocks()) << "quad " << n;
    ASSERT_LE(taken.tiles, scissor.tiles_of_blocks()) << "quad " << n;
    ASSERT_FALSE(taken.left_scissor) << "quad " << n;
    for (const TileCorner& tile : taken.entered)
      ASSERT_TRUE(scissor.has(tile.tile_x, tile.tile_y)) << "quad " << n << ": " << tile.tile_x << ", " << tile.tile_y;
    entered += taken.entered.size();
    steps += static_cast<std::uint64_t>(taken.approach + taken.blocks + taken.tiles);
    crossed += scissor.column.first % Config::block_tiles != 0 && scissor.row.first % Config::block_tiles != 0 &&
               !taken.entered.empty();
    to_the_left += scissor.block_row.first % 2 != 0 && scissor.block_column.count() > 1 && !taken.entered.empty();
    if (n % 256 != 0) continue;
    state.skip &= ~std::uint32_t{skip_walk};
    const Steps without = walk(setup, c, state);
    outside_without += std::ranges::any_of(
        without.entered, [&](const TileCorner& tile) { return !scissor.has(tile.tile_x, tile.tile_y); });
  }
  std::printf("%d quads: %llu tiles entered, %.0f steps a quad; %d entered where a block is cut, %d from the right\n",
              quads, static_cast<unsigned long long>(entered), static_cast<double>(steps) / quads, crossed,
              to_the_left);
  EXPECT_GT(crossed, count / 10);
  EXPECT_GT(to_the_left, count / 50);
  EXPECT_GT(outside_without, 0);
}

TEST(ScissorWalk, AThousandEnterNothingOutside) { nothing_outside(1'000); }
TEST(ScissorWalk, TenThousandEnterNothingOutside) { nothing_outside(10'000); }

/// Scissors anywhere, tiles of every size: the tiles, their functions and their order are those of a walk of the whole
/// screen, and those of the walk without the skip.
TEST(ScissorWalk, EntersWhatAWalkOfTheWholeScreenDoes) {
  constexpr int size = 500;
  for (const int tile_log2 : {2, 3, 4}) {
    Config c;
    c.set("tile_log2", tile_log2);
    c.validate();
    Prng rng(static_cast<std::uint64_t>(tile_log2), 15);
    const std::vector<WindowQuad> crossing =
        golden::make_stress(golden::StressFamily::eye_crossing, 150, 1, 1.0, size, size, 0);
    const std::vector<WindowQuad> around =
        golden::make_stress(golden::StressFamily::eye_in_hull, 150, 2, 1.0, size, size, 0);
    std::uint64_t entered = 0, cut = 0;
    for (std::size_t n = 0; n < 600 && !HasFailure(); ++n) {
      DrawState state = screen(size);
      random_scissor(rng, state, size);
      state.cull = static_cast<Cull>(n % 3);
      const SnappedQuad quad =
          n % 2 == 0 ? any_vertices(rng, c) : snap_quad(n % 4 == 1 ? crossing[n / 4] : around[n / 4], c, state);
      if (is_ordinary(quad, c)) continue;
      const SetupResult setup = quad_setup(quad, c, state);
      const Steps taken = walk(setup, c, state);
      EXPECT_TRUE(std::ranges::equal(taken.entered, whole_walk(setup, c, state), same))
          << "tile_log2 " << tile_log2 << ", quad " << n;
      entered += taken.entered.size();

      state.skip &= ~std::uint32_t{skip_walk};
      Steps without = walk(setup, c, state);
      EXPECT_EQ(without.approach, 0);
      const ScissorTiles scissor(c, state);
      cut += std::erase_if(without.entered,
                           [&](const TileCorner& tile) { return !scissor.has(tile.tile_x, tile.tile_y); });
      EXPECT_TRUE(std::ranges::equal(taken.entered, without.entered, same))
          << "tile_log2 " << tile_log2 << ", quad " << n;
    }
    std::printf("tiles of %d: %llu entered, %llu left out\n", c.tile(), static_cast<unsigned long long>(entered),
                static_cast<unsigned long long>(cut));
    EXPECT_GT(entered, 1000u);
    EXPECT_GT(cut, 1000u);
  }
}

/// And so are the fragments, bits and order.
TEST(ScissorWalk, KeepsTheFragmentsInOrder) {
  constexpr int size = 300;
  const Config c;
  Prng rng(4, 16);
  std::size_t fragments = 0;
  for (const golden::StressFamily family : {golden::StressFamily::eye_crossing, golden::StressFamily::eye_in_hull,
                                            golden::StressFamily::w_zero, golden::StressFamily::any_w}) {
    const std::vector<WindowQuad> quads = golden::make_stress(family, 60, 3, 1.0, size, size, 4);
    for (std::size_t n = 0; n < quads.size(); n += 6) {
      DrawState state = screen(size);
      state.attributes = c.attribute_slots;
      random_scissor(rng, state, size / 2);
      BothWays both(c, state, skip_walk);
      for (std::size_t i = n; i < n + 6; ++i) fragments += both.draw(snap_quad(quads[i], c, state));
    }
  }
  EXPECT_GT(fragments, 10'000u);
}

/// An ordinary quad's box is inside the scissor: its walk begins at its own first tile, whatever the scissor.
TEST(ScissorWalk, OrdinaryQuadsDoNotApproach) {
  const Config c;
  DrawState state = screen(512);
  state.scissor_x0 = 203;
  state.scissor_y0 = 150;
  const std::vector<WindowQuad> quads = golden::make_stress(golden::StressFamily::general, 200, 5, 1.0, 512, 512, 0);
  int walked = 0;
  for (const WindowQuad& q : quads) {
    const SnappedQuad quad = snap_quad(q, c, state);
    const SetupResult setup = quad_setup(quad, c, state);
    if (setup.homogeneous || setup.tiles_x == 0) continue;
    TileWalk w(c, state);
    w.take(setup);
    EXPECT_EQ(w.state(), TileWalk::State::block);
    ++walked;
  }
  EXPECT_GT(walked, 20);
}

}  // namespace
}  // namespace quadrille
