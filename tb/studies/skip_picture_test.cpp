// Which tiles the picture of the skips counts, of squares whose boxes are known.
#include "tb/studies/skip_picture.hpp"

#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <array>

namespace quadrille::tb {
namespace {

SnappedQuad quad(const std::array<std::array<double, 2>, 4>& points, const DrawState& state) {
  WindowQuad q;
  for (std::size_t i = 0; i < 4; ++i) {
    q.vertex[i] = {points[i][0], points[i][1], 0.5, 1};
    q.attribute[i].assign(4, 0);
  }
  return snap_quad(q, Config{}, state);
}

TEST(SkipPicture, EveryTileOfABoxHasAFate) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 256;
  state.cull = Cull::back;
  const std::vector<SnappedQuad> quads{
      quad({{{64, 128}, {128, 128}, {128, 64}, {64, 64}}}, state),      // 8 × 8 tiles, all covered
      quad({{{0, 128}, {128, 256}, {129, 256}, {1, 128}}}, state),      // a strip: 17 × 16 tiles, three blocks
      quad({{{8, 8}, {24, 8}, {24, 24}, {8, 24}}}, state),              // a back face: 2 × 2 tiles
      quad({{{0, 0}, {8, 8}, {16, 16}, {24, 24}}}, state),              // a line: 3 × 3 tiles
      quad({{{10.6, 11}, {11, 11}, {11, 10.6}, {10.6, 10.6}}}, state),  // no pixel centre
  };
  const TileFates fates = tile_fates(quads, Config{}, state);
  EXPECT_EQ(fates.columns, 32);
  EXPECT_EQ(fates.rows, 32);
  EXPECT_EQ(fates.total(TileFate::culled), 4u);
  EXPECT_EQ(fates.total(TileFate::line), 9u);
  EXPECT_EQ(fates.total(TileFate::entered) + fates.total(TileFate::tile) + fates.total(TileFate::block), 64u + 17 * 16);
  EXPECT_EQ(fates.total(TileFate::entered), 64u + 16);  // of the strip a pixel in each row, x = y - 128
  EXPECT_GE(fates.total(TileFate::block), 64u + 64);    // the two blocks beside the diagonal
  EXPECT_EQ(fates.count[static_cast<std::size_t>(TileFate::entered)][8 * 32 + 8], 1u);

  DrawState all = state;
  all.skip = 0;
  const TileFates nothing = tile_fates(quads, Config{}, all);
  EXPECT_EQ(nothing.total(TileFate::entered), 64u + 17 * 16 + 4 + 9);
  EXPECT_EQ(nothing.total(TileFate::tile) + nothing.total(TileFate::block) + nothing.total(TileFate::culled), 0u);

  const golden::FrameImage image = skip_picture(fates, Config{}, state);
  ASSERT_EQ(image.layer.size(), tile_fate_count);
  EXPECT_EQ(image.layer.at("skip.culled")[image.index(23, 23)], 1);
  EXPECT_EQ(image.layer.at("skip.culled")[image.index(24, 23)], 0);
  EXPECT_EQ(image.layer.at("skip.entered")[image.index(127, 127)], 1);
  EXPECT_GT(image.b[image.index(100, 140)], image.g[image.index(100, 140)]);  // a block beside the strip is blue
  EXPECT_EQ(image.r[image.index(255, 0)], 0);                                 // no quad there

  // A picture of all and one of each fate that there is; a legend of all.
  const golden::Image8 sheet = skip_sheet(fates, Config{}, state, "five"),
                       bare = skip_sheet(nothing, Config{}, all, "");
  EXPECT_GE(sheet.width, 6 * 256);  // all, entered, tile, block, line, culled
  EXPECT_LT(bare.width, 3 * 256 + 256);
  const std::array<std::array<int, 3>, 2> legend{{{153, 64, 204}, {217, 38, 51}}};  // hidden, culled
  for (const auto& colour : legend) {
    int found = 0;
    for (std::size_t i = 0; i < sheet.rgba.size(); i += 4)
      found += sheet.rgba[i] == colour[0] && sheet.rgba[i + 1] == colour[1] && sheet.rgba[i + 2] == colour[2] ? 1 : 0;
    EXPECT_GE(found, 50);
  }
}

TEST(SkipPicture, HiddenTiles) {
  Config config;
  config.set("hierarchical_z_bits", 12);
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 128;
  state.skip |= skip_hidden;
  std::vector<SnappedQuad> quads;
  for (const double z : {0.25, 0.5}) {  // 4 × 4 tiles before 8 × 8
    WindowQuad q;
    const double edge = z == 0.25 ? 32 : 64;
    q.vertex = {{{0, 0, z, 1}, {0, edge, z, 1}, {edge, edge, z, 1}, {edge, 0, z, 1}}};
    for (auto& attribute : q.attribute) attribute.assign(4, 0);
    quads.push_back(snap_quad(q, config, state));
  }
  const TileFates fates = tile_fates(quads, config, state);
  EXPECT_EQ(fates.total(TileFate::hidden), 16u);
  EXPECT_EQ(fates.total(TileFate::entered), 16u + 48);
  EXPECT_EQ(fates.count[static_cast<std::size_t>(TileFate::hidden)][3 * 16 + 3], 1u);
  EXPECT_EQ(fates.count[static_cast<std::size_t>(TileFate::hidden)][3 * 16 + 4], 0u);
}

TEST(SkipPicture, TilesHiddenByTwoHalves) {
  Config config;
  config.set("hierarchical_z_bits", 12);
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 64;
  state.skip |= skip_hidden;
  const auto rectangle = [&](double x0, double x1, double z) {
    WindowQuad q;
    q.vertex = {{{x0, 0, z, 1}, {x0, 8, z, 1}, {x1, 8, z, 1}, {x1, 0, z, 1}}};
    for (auto& attribute : q.attribute) attribute.assign(4, 0);
    return snap_quad(q, config, state);
  };
  // Two tiles, of which the first is covered by two quads, the second by half.
  const std::vector<SnappedQuad> quads{rectangle(0, 4, 0.25), rectangle(4, 12, 0.25), rectangle(0, 16, 0.5)};
  const TileFates fates = tile_fates(quads, config, state);
  EXPECT_EQ(fates.total(TileFate::entered), 1u + 2 + 1);
  EXPECT_EQ(fates.total(TileFate::hidden), 1u);
  EXPECT_EQ(fates.count[static_cast<std::size_t>(TileFate::hidden)][0], 1u);
}

}  // namespace
}  // namespace quadrille::tb
