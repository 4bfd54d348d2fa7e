// The counters of the clocked model on draws whose counts follow from the picture: squares on corners of tiles, pixels
// by a test of points, a quad of every reason; and which unit a clock is charged to.
#include "model/port/performance_counters_test_support.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace quadrille {
namespace {

/// Every counter, the first and the last too.
TEST(PerformanceCounters, AddUp) {
  PerformanceCounters sum, other;
  for (std::size_t i = 0; i < sum.value.size(); ++i) {
    sum.value[i] = i + 1;
    other.value[i] = 1000 * (i + 1);
  }
  sum += other;
  for (std::size_t i = 0; i < sum.value.size(); ++i) EXPECT_EQ(sum.value[i], 1001 * (i + 1)) << counter_info[i].name;
}

TEST(PerformanceCounters, NamesAreThoseOfTheEnumeration) {
  EXPECT_EQ(counter_info.back().name, "bound_idle");
  EXPECT_EQ(static_cast<std::size_t>(bound_idle) + 1, counter_count);
  EXPECT_EQ(counter_info[static_cast<std::size_t>(stamps)].name, "stamps");
  EXPECT_EQ(counter_info[static_cast<std::size_t>(fragments)].name, "fragments");
  EXPECT_EQ(counter_info[static_cast<std::size_t>(products_sqrt)].name, "products_sqrt");
  EXPECT_EQ(counter_info[static_cast<std::size_t>(bound_pixels)].name, "bound_pixels");
}

TEST(PerformanceCounters, TheSpecificationListsThem) {
  std::ifstream spec(QUADRILLE_SOURCE_DIR "/rtl/SPEC.md");
  std::size_t next = 0;
  for (std::string line; std::getline(spec, line);) {
    if (next == counter_count) break;
    const std::string row = "| " + std::to_string(next) + " | `" + std::string(counter_info[next].name) + "` | " +
                            std::string(counter_info[next].meaning) + " |";
    if (line.starts_with(row)) ++next;
  }
  EXPECT_EQ(next, counter_count) << counter_info[std::min(next, counter_count - 1)].name;
}

TEST(PerformanceCounters, ASquareOfSixtyFourPixels) {
  const PerformanceCounters c = count({square(64, 128, 64)});
  EXPECT_EQ(c[quads_ordinary], 1u);
  EXPECT_EQ(c[blocks_tested], 1u);
  EXPECT_EQ(c[blocks_entered], 1u);
  EXPECT_EQ(c[tiles_tested], 64u);
  EXPECT_EQ(c[tiles_entered], 64u);
  EXPECT_EQ(c[rows_tested], 512u);
  EXPECT_EQ(c[stamps], 512u);
  EXPECT_EQ(c[pixels_lane0], 4096u);
  EXPECT_EQ(c.pixels(), 4096u);
  EXPECT_EQ(c[fragments], 4096u);
  EXPECT_EQ(c[bound_pixels], 4096u + 1);  // and the end entry
  // Six steps of setup and two of each tile, of two dot units with two multipliers each.
  EXPECT_EQ(c[products_vertex_products], 4u * (6 + 2 * 64));
}

// What Yosys made of the multipliers of 18 bits (rtl/MEASUREMENTS.md): a DSP block each.
TEST(PerformanceCounters, ProductsOfAPixelAreTheDspBlocksOfItsUnits) {
  const PerformanceCounters c = count({square(0, 0, 8)});
  EXPECT_EQ(c[products_sqrt], 64u * 8);
  EXPECT_EQ(c[products_mean_value_ratios], 64u * 6);
  EXPECT_EQ(c[products_mean_value_weights], 64u * 23);
  EXPECT_EQ(c[products_interpolate], 64u * 24);
  EXPECT_EQ(c[products_reciprocal], 64u * 4);
  EXPECT_EQ(c[products_fragment_output], 64u * 5);
}

// A pixel on a corner has its weights without roots and ratios, a sum that no fragment needs has no terms.
TEST(PerformanceCounters, OperandsHeldMakeNoProducts) {
  const WindowQuad on_centres = square(0.5, 0.5, 8);  // 64 pixels, that at the top left on a corner
  DrawState state;
  state.attributes = 1;
  state.depth = false;
  const PerformanceCounters held = count({on_centres}, {}, state);
  EXPECT_EQ(held[fragments], 64u);
  EXPECT_EQ(held[products_sqrt], 63u * 8);
  EXPECT_EQ(held[products_mean_value_ratios], 63u * 6);
  EXPECT_EQ(held[products_mean_value_weights], 63u * 15 + 64 * 8);
  EXPECT_EQ(held[products_interpolate], 64u * (4 + 3));  // k, the attribute without corner 0
  EXPECT_EQ(held[products_reciprocal], 64u * 2);         // of k
  EXPECT_EQ(held[products_fragment_output], 64u);
  state.attributes = 0;
  state.depth = true;
  const PerformanceCounters depth = count({on_centres}, {}, state);
  EXPECT_EQ(depth[products_interpolate], 64u * 4 * 2);  // W and Z
  EXPECT_EQ(depth[products_reciprocal], 64u * 2);       // of W
  EXPECT_EQ(depth[products_fragment_output], 64u);
  state.depth = false;
  // The eye in the hull: the sign of W decides what is behind it.
  WindowQuad around = square(16, 16, 64);
  for (const std::size_t i : {0, 2}) {
    WindowVertex& v = around.vertex[i];
    v = {-v.x, -v.y, -v.z, -1};
  }
  const PerformanceCounters hull = count({around}, {}, state);
  EXPECT_GT(hull.pixels(), 0u);
  EXPECT_EQ(hull[products_interpolate], hull.pixels() * 4);
  EXPECT_EQ(hull[products_reciprocal], hull.pixels() * 2);
  EXPECT_EQ(hull[products_fragment_output], 0u);
  state.skip &= ~std::uint32_t{skip_operands};
  const PerformanceCounters all = count({on_centres}, {}, state);
  EXPECT_EQ(all[products_sqrt], 64u * 8);
  EXPECT_EQ(all[products_interpolate], 64u * 24);
  EXPECT_EQ(all[products_reciprocal], 64u * 4);
  EXPECT_EQ(all[products_fragment_output], 64u * 5);
}

// With all in use and no pixel on a corner nothing is held; of coverage alone all from the sums on.
TEST(PerformanceCounters, OperandsAreHeldWhereNothingDependsOnThem) {
  const WindowQuad off_centres = square(0, 0, 8);
  DrawState state;
  const PerformanceCounters held = count({off_centres}, {}, state);
  state.skip &= ~std::uint32_t{skip_operands};
  EXPECT_TRUE(held == count({off_centres}, {}, state));
  state.depth = false;
  state.attributes = 0;
  const PerformanceCounters all = count({off_centres}, {}, state);
  EXPECT_EQ(all.products(), held.products());
  state.skip = skip_default;
  const PerformanceCounters coverage = count({off_centres}, {}, state);
  EXPECT_EQ(coverage[clocks], all[clocks]);
  EXPECT_EQ(coverage[products_mean_value_weights], 64u * 23);
  EXPECT_EQ(coverage[products_interpolate], 0u);
  EXPECT_EQ(coverage[products_reciprocal], 0u);
  EXPECT_EQ(coverage[products_fragment_output], 0u);
}

TEST(PerformanceCounters, WithoutTheSkipEveryTileOfTheBoxIsEntered) {
  // A diamond, no pixel centre on its edges: its box has 9 × 9 tiles, in two blocks by two.
  const double cx = 100.25, cy = 100.125;
  const WindowQuad diamond = quad_of({{{cx, cy - 32}, {cx + 32, cy}, {cx, cy + 32}, {cx - 32, cy}}});
  std::uint64_t stamps_found = 0, pixels_found = 0;
  std::array<bool, std::size_t{64} * 64> in_tile{};
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; x += 8) {
      int covered = 0;
      for (int dx = 0; dx < 8; ++dx) covered += std::fabs(x + dx + 0.5 - cx) + std::fabs(y + 0.5 - cy) < 32 ? 1 : 0;
      pixels_found += static_cast<std::uint64_t>(covered);
      stamps_found += covered > 0 ? 1 : 0;
      if (covered > 0) in_tile[static_cast<std::size_t>(y / 8 * 64 + x / 8)] = true;
    }
  }
  DrawState state;
  for (const std::uint32_t skip : {std::uint32_t{0}, skip_default}) {
    state.skip = skip;
    const PerformanceCounters c = count({diamond}, {}, state);
    EXPECT_EQ(c.pixels(), pixels_found);
    EXPECT_EQ(c[stamps], stamps_found);
    EXPECT_EQ(c[blocks_tested], 4u);
    EXPECT_EQ(c[blocks_entered], skip == 0 ? 4u : 3u);  // the last one is tile (16, 16) alone, |28| + |28| > 32
    EXPECT_EQ(c[tiles_tested], skip == 0 ? 81u : 80u);
    const auto hit = static_cast<std::uint64_t>(std::ranges::count(in_tile, true));
    EXPECT_EQ(c[tiles_entered], skip == 0 ? 81 : hit);
  }
}

TEST(PerformanceCounters, HiddenTiles) {
  Config config;
  config.set("hierarchical_z_bits", 12);
  config.set("hierarchical_z_tiles_log2", 8);
  DrawState state;
  // 8 × 8 tiles before 16 × 16, all of those a tile of the larger one; another one in front is not hidden.
  const auto at = [](double x, double y, double edge, double z) {
    return quad_of({{{x, y + edge}, {x + edge, y + edge}, {x + edge, y}, {x, y}}}, z);
  };
  const std::vector<WindowQuad> quads{at(64, 64, 64, 0.25), at(0, 0, 128, 0.5), at(64, 64, 64, 0.125)};
  const PerformanceCounters all = count(quads, config, state);
  EXPECT_EQ(all[tiles_hidden], 0u);
  EXPECT_EQ(all[tiles_entered], 64u + 256 + 64);
  EXPECT_EQ(all[bound_wipe], 256u);
  state.skip |= skip_hidden;
  const PerformanceCounters c = count(quads, config, state);
  EXPECT_EQ(c[tiles_hidden], 0u);
  EXPECT_EQ(c[blocks_hidden], 1u);
  EXPECT_EQ(c[blocks_tested], all[blocks_tested]);
  EXPECT_EQ(c[blocks_entered], all[blocks_entered] - 1);
  EXPECT_EQ(c[tiles_entered], 64u + 192 + 64);
  EXPECT_EQ(c[tiles_masked], 0u);
  EXPECT_EQ(c[tiles_tested], all[tiles_tested] - 64);
  EXPECT_EQ(c.pixels(), 4096u * 5);
  EXPECT_EQ(c[rows_tested], (64u + 192 + 64) * 8);

  // Two halves of a tile, then something behind both: it is pushed, and one row goes through coverage that is no test.
  const auto half = [](double x, double z) { return quad_of({{{x, 8}, {x + 4, 8}, {x + 4, 0}, {x, 0}}}, z); };
  const PerformanceCounters halves = count({half(0, 0.25), half(4, 0.25), at(0, 0, 8, 0.5)}, config, state);
  EXPECT_EQ(halves[tiles_hidden], 0u);
  EXPECT_EQ(halves[tiles_entered], 3u);
  EXPECT_EQ(halves[tiles_masked], 1u);
  EXPECT_EQ(halves[rows_tested], 16u);
  EXPECT_EQ(halves.pixels(), 64u);
}

/// Blocks of the walk begin at the quad's first tile, those that are held at the viewport's.
TEST(PerformanceCounters, HiddenBlocks) {
  Config config;
  config.set("hierarchical_z_bits", 12);
  config.set("hierarchical_z_tiles_log2", 8);
  DrawState state;
  state.skip |= skip_hidden;
  const auto at = [](double x, double y, double width, double height, double z) {
    return quad_of({{{x, y + height}, {x + width, y + height}, {x + width, y}, {x, y}}}, z);
  };
  struct Case {
    const char* what;
    std::vector<WindowQuad> quads;  ///< the last one is looked at
    std::uint64_t blocks, tiles;    ///< of it that are hidden
  };
  const std::vector<Case> cases{
      {"over four that are covered", {at(0, 0, 128, 128, 0.25), at(40, 40, 32, 32, 0.5)}, 1, 0},
      {"over three, and a tile of the fourth",
       {at(0, 0, 64, 64, 0.25), at(64, 0, 64, 64, 0.25), at(0, 64, 64, 64, 0.25), at(40, 40, 32, 32, 0.5)},
       0,
       15},
      {"nothing but its own tiles counts", {at(64, 64, 64, 64, 0.25), at(64, 64, 60, 60, 0.5)}, 1, 0},
      {"no farther than the farther half",
       {at(0, 0, 64, 32, 0.25), at(0, 32, 64, 32, 0.375), at(0, 0, 64, 64, 0.3)},
       0,
       32},
      {"as far as both halves", {at(0, 0, 64, 32, 0.25), at(0, 32, 64, 32, 0.375), at(0, 0, 64, 64, 0.5)}, 1, 0},
      {"a tile is missing", {at(0, 0, 64, 56, 0.25), at(0, 56, 56, 8, 0.25), at(0, 0, 64, 64, 0.5)}, 0, 63},
      {"what is behind a nearer one that joined a farther mask",
       {at(0, 0, 64, 32, 0.75), at(0, 0, 64, 64, 0.25), at(0, 0, 64, 64, 0.5)},
       0,
       64},
      {"learned from the tiles that were hidden",
       {at(0, 0, 64, 32, 0.75), at(0, 0, 64, 64, 0.25), at(0, 0, 64, 64, 0.5), at(0, 0, 64, 64, 0.625)},
       1,
       0},
      {"but no nearer than those were",
       {at(0, 0, 64, 32, 0.75), at(0, 0, 64, 64, 0.25), at(0, 0, 64, 64, 0.5), at(0, 0, 64, 64, 0.375)},
       0,
       64},
      {"another block at its place", {at(0, 0, 64, 64, 0.25), at(256, 256, 64, 64, 0.25), at(0, 0, 64, 64, 0.5)}, 0, 0},
  };
  for (const Case& c : cases) {
    const PerformanceCounters with = count(c.quads, config, state),
                              before = count({c.quads.begin(), c.quads.end() - 1}, config, state);
    EXPECT_EQ(with[blocks_hidden] - before[blocks_hidden], c.blocks) << c.what;
    EXPECT_EQ(with[tiles_hidden] - before[tiles_hidden], c.tiles) << c.what;
    EXPECT_EQ(with[blocks_tested] - before[blocks_tested], 1u) << c.what;
    EXPECT_EQ(with[tiles_tested] == before[tiles_tested], c.blocks == 1) << c.what;
  }
}

TEST(PerformanceCounters, PlaneQuads) {
  Config config;
  config.set("plane_quads", 1);
  DrawState state;
  WindowQuad bent = square(64, 0, 8);
  bent.attribute[2][1] = 0.5;
  const std::vector<WindowQuad> quads{square(0, 0, 8), bent, square(600, 0, 8), square(32, 0, 16)};
  const PerformanceCounters mean_values = count(quads, config, state);
  EXPECT_EQ(mean_values[quads_plane], 0u);
  EXPECT_EQ(mean_values[pixels_plane], 0u);
  state.skip |= skip_plane;
  const PerformanceCounters c = count(quads, config, state);
  EXPECT_EQ(c[quads_plane], 2u);
  EXPECT_EQ(c[pixels_plane], 64u + 256);
  EXPECT_EQ(c.pixels(), 64u + 64 + 256);
  EXPECT_EQ(c[clocks], mean_values[clocks]);
  EXPECT_EQ(c[products_sqrt], 64u * 8);
  EXPECT_EQ(c[products_mean_value_ratios], 64u * 6);
  EXPECT_EQ(c[products_mean_value_weights], 64u * 23);
}

TEST(PerformanceCounters, PixelsByLane) {
  Config config;
  config.pixels_per_clock = 4;
  // Rows of six pixels: lanes 0 and 1 in two clocks, 2 and 3 in one.
  const PerformanceCounters c = count({quad_of({{{8, 16}, {14, 16}, {14, 8}, {8, 8}}})}, config);
  EXPECT_EQ(c[pixels_lane0], 16u);
  EXPECT_EQ(c[pixels_lane1], 16u);
  EXPECT_EQ(c[pixels_lane2], 8u);
  EXPECT_EQ(c[pixels_lane3], 8u);
  EXPECT_EQ(c[products_sqrt], 48u * 8);
  EXPECT_EQ(c[bound_pixels], 16u + 1);
}

}  // namespace
}  // namespace quadrille
