// The groups about exact boundaries hold their cases, by the snapped integers and by the pixels of the plain pipeline.
#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/corner_test_support.hpp"
#include "model/port/snap.hpp"
#include "model/port/stages.hpp"
#include "model/skips/plane_quad.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace quadrille::golden {
namespace {

/// Sides of ordinary boxes at a pixel centre and a unit beside it, at the last and first column of a tile, too.
TEST(CornerBoundaries, SidesOfBoxesAtPixelCentres) {
  const Config config;
  const std::int64_t one = std::int64_t{1} << config.frac(), unit = std::int64_t{1} << config.homogeneous_frac_bits;
  std::map<std::int64_t, int> apart, at_tile;
  int empty = 0, homogeneous = 0;
  const CornerDraw draw = draw_of(config, CornerGroup::box);
  std::set<std::uint32_t> covered;
  for_each_pixel(draw, config,
                 [&](const SnappedQuad& q, const TileEntry&, const PixelTrace&) { covered.insert(q.id); });
  for (const SnappedQuad& quad : draw.quads) {
    if (!is_ordinary(quad, config)) {
      ++homogeneous;
      continue;
    }
    empty += covered.contains(quad.id) ? 0 : 1;
    for (const SnappedVertex& v : quad.vertex)
      for (const std::int64_t c : {v.x, v.y}) {
        const std::int64_t pixel = (c + one / 2) >> config.frac(), off = c - pixel * one;
        if (off % unit != 0) continue;
        ++apart[off / unit];
        if (pixel % config.tile() == 0 || pixel % config.tile() == config.tile() - 1) ++at_tile[off / unit];
      }
  }
  for (const std::int64_t side : {-1, 0, 1}) {
    EXPECT_GT(apart[side], 60) << side;
    EXPECT_GT(at_tile[side], 25) << side;
  }
  EXPECT_GT(empty, 10) << "no pixel centre in the box, or on its far side";
  EXPECT_GT(covered.size(), 40u);
  EXPECT_GT(homogeneous, 20);
}

/// Plane quads, and those that lack one bit of it.
TEST(CornerBoundaries, PlaneButForOneBit) {
  Config config;
  config.set("plane_quads", 1);
  config.set("attribute_slots", 2);
  int plane = 0, sign = 0, exponent = 0, code = 0, position = 0, other_k = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const CornerDraw draw = draw_of(config, CornerGroup::plane, seed);
    DrawState state = draw.state;
    state.attributes = 0;
    for (const SnappedQuad& quad : draw.quads) {
      if (plane_quad(quad, config, state)) {
        ++plane;
        continue;
      }
      const auto& v = quad.vertex;
      SnappedQuad changed = quad;
      for (std::size_t i = 1; i < 4; ++i) changed.vertex[i].z.neg = v[1].z.neg;
      sign += plane_quad(changed, config, state);
      for (const SnappedVertex& w : v)
        exponent += w.z.sig != 0 && std::ranges::any_of(v, [&](const SnappedVertex& u) {
                      return u.z.sig == w.z.sig && u.z.neg == w.z.neg && u.z.exp == w.z.exp + 1;
                    });
      code += std::ranges::count_if(
                  v, [&](const SnappedVertex& w) { return w.z.sig != 0 && w.z.exp == -config.depth_bits; }) == 1;
      position += std::abs(v[0].x + v[2].x - v[1].x - v[3].x) + std::abs(v[0].y + v[2].y - v[1].y - v[3].y) ==
                  1 << config.homogeneous_frac_bits;
      other_k += std::ranges::any_of(v, [&](const SnappedVertex& w) { return w.k.exp != v[0].k.exp; });
    }
  }
  EXPECT_GT(plane, 40);
  EXPECT_GT(sign, 20);
  EXPECT_GT(exponent, 20);
  EXPECT_GT(code, 20);
  EXPECT_GT(position, 20);
  EXPECT_GT(other_k, 20);
}

/// Corners' codes at a coarse code and one beside it, the first and the last of them too; layers hide one another, and
/// just do not.
TEST(CornerBoundaries, CoarseDepthCodes) {
  Config config = narrow_config();
  for (const int bits : {9, 12}) {
    config.set("hierarchical_z_bits", bits);
    const CornerDraw draw = draw_of(config, CornerGroup::coarse_depth);
    const std::int64_t coarse = std::int64_t{1} << (config.depth_bits - bits),
                       last = std::int64_t{1} << config.depth_bits;
    std::map<std::int64_t, int> apart;
    std::set<std::int64_t> ends;
    for (const SnappedQuad& quad : draw.quads)
      for (const std::int64_t code : {quad.base.depth_low, quad.base.depth_high}) {
        ++apart[((code + 1) % coarse + coarse) % coarse - 1];
        if (code <= 1 || code >= last - coarse - 1) ends.insert(code);
      }
    for (const std::int64_t beside : {-1, 0, 1}) EXPECT_GT(apart[beside], 60) << beside;
    for (const std::int64_t end : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}, last - coarse, last - 1, last})
      EXPECT_TRUE(ends.contains(end)) << end;
    UntimedModel model(config, draw.state);
    for (const SnappedQuad& quad : draw.quads) model.draw(quad, [](std::span<const Fragment>) {});
    EXPECT_GT(model.stats().tiles_hidden, 40u);
    EXPECT_GT(model.stats().tiles_masked, 0u);
    EXPECT_GT(model.stats().fragments, 4000u);
  }
}

/// Quads with a corner beyond the guard band: wholly before a limit by one code, at it, and on both sides of it.
TEST(CornerBoundaries, DepthLimitsBeyondTheGuardBand) {
  const Config config;
  std::map<std::int64_t, int> high_before, low_behind;
  int homogeneous = 0, rejected = 0, anywhere = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const CornerDraw draw = draw_of(config, CornerGroup::far_depth, seed);
    const std::int64_t znear = depth_code(draw.state.znear, config), zfar = depth_code(draw.state.zfar, config);
    for (const SnappedQuad& quad : draw.quads) {
      homogeneous += is_ordinary(quad, config) ? 0 : 1;
      anywhere += quad.base.depth_low == -1 && quad.base.depth_high == config.depth_above();
      ++high_before[quad.base.depth_high - znear];
      ++low_behind[quad.base.depth_low - zfar];
      rejected += quad.base.depth_high < znear || quad.base.depth_low > zfar;
    }
  }
  EXPECT_GT(homogeneous, 200);
  EXPECT_GT(anywhere, 30) << "behind the eye";
  EXPECT_GT(rejected, 30);
  for (const std::int64_t apart : {-1, 0}) EXPECT_GT(high_before[apart], 3) << apart;
  for (const std::int64_t apart : {0, 1}) EXPECT_GT(low_behind[apart], 3) << apart;
}

}  // namespace
}  // namespace quadrille::golden
