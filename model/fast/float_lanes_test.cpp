// The single-precision lanes against the plain pipeline, where they fit and at the edges of where they do.
#include "model/fast/float_lanes_test_support.hpp"
#include "model/port/snap.hpp"
#include "model/skips/plane_quad.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace quadrille {
namespace {

/// S + align_guard_bits at most 20.
Config fitting_config(Prng& rng) {
  Config c;
  c.significand_bits = static_cast<int>(rng.integer(8, 19));
  c.align_guard_bits = static_cast<int>(rng.integer(0, std::min(6, 20 - c.significand_bits)));
  if (rng.chance(0.5)) c.align_guard_bits = std::min(6, 20 - c.significand_bits);  // the largest sums
  c.notch_exact = static_cast<int>(rng.below(2));
  c.attribute_slots = static_cast<int>(rng.integer(1, 8));
  c.attribute_int_bits = static_cast<int>(rng.integer(1, std::min(15, 31 - c.significand_bits)));
  c.attribute_frac_bits = static_cast<int>(rng.integer(c.significand_bits, std::min(30, 31 - c.attribute_int_bits)));
  c.depth_bits = static_cast<int>(rng.integer(8, 30));
  c.tile_log2 = static_cast<int>(rng.integer(2, 4));
  if (rng.chance(0.3)) c.sqrt_degree = c.recip_degree = 1;
  if (rng.chance(0.3)) c.quadratic_frac_bits = 2 * static_cast<int>(rng.integer(8, 15));
  if (c.quadratic_frac_bits < 0 && rng.chance(0.4)) {
    c.subpixel_bits = static_cast<int>(rng.integer(2, 8));
    c.homogeneous_frac_bits = static_cast<int>(rng.integer(4, 7));
  }
  c.validate();
  return c;
}

DrawState random_state(Prng& rng, const Config& c) {
  DrawState s = square();
  s.perspective = rng.chance(0.7);
  s.depth = rng.chance(0.7);
  s.attributes = static_cast<int>(rng.integer(0, c.attribute_slots));
  s.cull = static_cast<Cull>(rng.chance(0.7) ? 0 : rng.below(3));
  if (rng.chance(0.3)) s.znear = rng.uniform(0, 0.5), s.zfar = rng.uniform(0.5, 1);
  if (rng.chance(0.2)) s.scissor_x0 = 5, s.scissor_y0 = 11, s.scissor_x1 = 33, s.scissor_y1 = 29;
  if (rng.chance(0.2)) s.skip &= ~skip_operands;
  return s;
}

/// Every count, also one that is added to the struct some day.
TEST(DrawStats, AddUp) {
  using Words = std::array<std::uint64_t, sizeof(DrawStats) / sizeof(std::uint64_t)>;
  Words a, b, sum;
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = i + 1;
    b[i] = 1000 * (i + 1);
    sum[i] = a[i] + b[i];
  }
  DrawStats stats = std::bit_cast<DrawStats>(a);
  EXPECT_EQ(std::bit_cast<Words>(stats += std::bit_cast<DrawStats>(b)), sum);
}

TEST(FloatLanes, PlainAndLanesAreOne) {
  Prng rng(400);
  std::uint64_t fragments = 0, quads = 0, on_edge = 0, on_vertex = 0, two_edge = 0, notch = 0, saturated = 0,
                discarded = 0;
  for (int n = 0; n < 270; ++n) {
    const Config c = fitting_config(rng);
    const DrawState s = random_state(rng, c);
    std::vector<SnappedQuad> list;
    // Beyond 30 the quad is not taken; near it sums go below what the lanes keep.
    constexpr int exponents[] = {0, 3, 8, 20, 30, 40};
    for (int i = 0; i < 12; ++i) list.push_back(random_quad(rng, c, exponents[rng.below(6)]));
    for (const SnappedQuad& quad : list) quads += taken(quad, c, s);
    UntimedModel plain(c, s, PixelEngine::plain);
    std::vector<std::vector<Fragment>> expected;
    for (const SnappedQuad& quad : list) expected.push_back(draw(plain, quad));
    on_each_lane_target([&] {
      UntimedModel quick(c, s);
      for (std::size_t i = 0; i < list.size(); ++i) ASSERT_EQ(expected[i], draw(quick, list[i])) << "quad " << i;
      const DrawStats& a = plain.stats();
      const DrawStats& b = quick.stats();
      ASSERT_EQ(counts(a), counts(b));
    });
    if (HasFatalFailure()) FAIL() << "round " << n << ", S " << c.significand_bits << " + " << c.align_guard_bits;
    fragments += plain.stats().fragments;
    on_edge += plain.stats().on_edge;
    on_vertex += plain.stats().on_vertex;
    two_edge += plain.stats().two_edge;
    notch += plain.stats().notch;
    saturated += plain.stats().saturated;
    discarded += plain.stats().pixels - plain.stats().fragments;
  }
  EXPECT_GT(fragments, 200'000u);
  EXPECT_GT(on_edge, 20u);
  EXPECT_GT(on_vertex, 20u);
  EXPECT_GT(two_edge, 20u);
  EXPECT_GT(notch, 20u);
  EXPECT_GT(saturated, 20u);
  EXPECT_GT(discarded, 20u);
  EXPECT_GT(quads, 1000u);
}

/// Arrays hold what records hold, and batches of either engine the same in the same order; also behind a change of the
/// draw state, to fewer attributes and without depth.
TEST(FloatLanes, ArraysAndRecordsAreOne) {
  Prng rng(409);
  std::uint64_t fragments = 0;
  for (int n = 0; n < 60; ++n) {
    const Config c = fitting_config(rng);
    std::array<DrawState, 3> states;
    for (DrawState& s : states) s = random_state(rng, c);
    std::vector<SnappedQuad> list;
    for (int i = 0; i < 6; ++i) list.push_back(random_quad(rng, c, 3));
    on_each_lane_target([&] {
      UntimedModel by_records(c, states[0]), by_arrays(c, states[0]), plain(c, states[0], PixelEngine::plain);
      for (const DrawState& s : states) {
        for (UntimedModel* model : {&by_records, &by_arrays, &plain}) model->set_state(s);
        for (const SnappedQuad& quad : list) {
          const std::vector<Fragment> records = draw(by_records, quad);
          for (UntimedModel* model : {&by_arrays, &plain}) {
            std::size_t next = 0;
            model->draw_arrays(quad, [&](const FragmentArrays& arrays) {
              ASSERT_GT(arrays.size, 0u);
              ASSERT_LE(next + arrays.size, records.size());
              ASSERT_EQ(arrays.attributes, s.attributes);
              for (std::size_t j = 0; j < max_attribute_slots; ++j)
                ASSERT_EQ(arrays.attribute[j] != nullptr, j < static_cast<std::size_t>(s.attributes));
              for (std::size_t i = 0; i < arrays.size; ++i, ++next) {
                const Fragment& f = records[next];
                ASSERT_EQ(arrays.quad, f.quad);
                ASSERT_EQ(arrays.place[i].x, f.x);
                ASSERT_EQ(arrays.place[i].y, f.y);
                ASSERT_EQ(arrays.marks[i].front, f.front);
                ASSERT_EQ(arrays.marks[i].flags, f.flags);
                ASSERT_EQ(arrays.depth[i], f.depth);
                for (std::size_t j = 0; j < max_attribute_slots; ++j)
                  ASSERT_EQ(arrays.attribute[j] == nullptr ? 0 : arrays.attribute[j][i], f.attribute[j]);
                ASSERT_EQ(arrays[i], f);
              }
            });
            ASSERT_EQ(next, records.size());
          }
          fragments += records.size();
        }
      }
    });
    if (HasFatalFailure()) FAIL() << "round " << n;
  }
  EXPECT_GT(fragments, 50'000u);
}

/// Small quads over whole blocks of tiles, and over parts of several, front to back and back again: blocks that become
/// known are left out, by the quads' own setup and walk as by the others'.
TEST(FloatLanes, HiddenBlocksOfSmallQuads) {
  Prng rng(411);
  Config c;
  c.hierarchical_z_bits = 12;
  c.hierarchical_z_tiles_log2 = 10;
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = 192;
  s.attributes = 1;
  s.skip |= skip_hidden;
  std::vector<SnappedQuad> list;
  for (int n = 0; n < 300; ++n) {
    const bool aligned = rng.chance(0.6);
    const auto place = [&] { return aligned ? 64 * static_cast<int>(rng.below(3)) : static_cast<int>(rng.below(128)); };
    const int x = place(), y = place(), edge = aligned ? 64 : static_cast<int>(rng.integer(1, 64));
    const double z = rng.chance(0.8) ? 0.1 + 0.8 * n / 300 : rng.uniform();
    // A square, or the triangles that it is cut into, which share the tiles along the cut.
    const bool cut = rng.chance(0.5);
    for (int half = 0; half < (cut ? 2 : 1); ++half) {
      WindowQuad q;
      q.id = static_cast<std::uint32_t>(list.size());
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t corner = !cut ? i : half == 0 ? std::min<std::size_t>(i, 2) : i < 2 ? 0 : i;
        q.vertex[i] = {static_cast<double>(x + (corner == 1 || corner == 2 ? edge : 0)),
                       static_cast<double>(y + (corner >= 2 ? edge : 0)), z, 1};
        q.attribute[i] = {static_cast<double>(corner) / 4};
      }
      list.push_back(snap_quad(q, c, s));
    }
  }
  UntimedModel plain(c, s, PixelEngine::plain);
  std::vector<std::vector<Fragment>> expected;
  for (const SnappedQuad& quad : list) expected.push_back(draw(plain, quad));
  EXPECT_GT(plain.stats().blocks_hidden, 50u);
  EXPECT_GT(plain.stats().tiles_hidden, 50u);
  EXPECT_GT(plain.stats().tiles_masked, 50u);
  on_each_lane_target([&] {
    UntimedModel quick(c, s);
    for (std::size_t i = 0; i < list.size(); ++i) ASSERT_EQ(expected[i], draw(quick, list[i])) << "quad " << i;
    ASSERT_EQ(counts(plain.stats()), counts(quick.stats()));
  });
}

/// Each pixel is computed in one kind of lanes: single precision alone where it fits, none of it where it does not.
TEST(FloatLanes, PixelsByLane) {
  Prng rng(410);
  Config c;
  for (const int bits : {18, 24}) {
    c.significand_bits = bits;
    c.validate();
    UntimedModel model(c, square());
    for (int i = 0; i < 40; ++i) draw(model, random_quad(rng, c, 3));
    const LanePixels& lanes = model.lane_pixels();
    EXPECT_EQ(lanes.single + lanes.wide + lanes.plain, model.stats().pixels);
    EXPECT_GT(lanes.single + lanes.wide, 10 * lanes.plain);
    if (bits == 18) {
      EXPECT_GT(lanes.single, 1000u);
    } else {
      EXPECT_EQ(lanes.single, 0u);
      EXPECT_GT(lanes.wide, 1000u);
    }
  }
  UntimedModel plain(c, square(), PixelEngine::plain);
  draw(plain, random_quad(rng, c, 0));
  EXPECT_EQ(plain.lane_pixels().plain, plain.stats().pixels);
}

/// A parallelogram whose values are the same along a pair of its sides, its depths within a small interval.
SnappedQuad plane_one(Prng& rng, const Config& c, SnappedQuad q) {
  const int depth = static_cast<int>(rng.integer(-12, -4));
  const auto reach = static_cast<std::int32_t>(rng.below(1u << (c.depth_bits - 6)));
  q.base.depth = static_cast<std::uint32_t>(rng.integer(reach, (1 << c.depth_bits) - reach));
  q.base.depth_low = static_cast<std::int32_t>(q.base.depth) - reach;
  q.base.depth_high = static_cast<std::int32_t>(q.base.depth) + reach;
  const auto step = [&] { return static_cast<std::int32_t>(rng.integer(-12, 80)) << (c.frac() - 1); };
  const std::int32_t ax = step(), ay = rng.chance(0.5) ? 0 : step(), bx = rng.chance(0.5) ? 0 : step(), by = step();
  for (std::size_t i = 0; i < 4; ++i) {
    SnappedVertex& v = q.vertex[i];
    v.z = q.vertex[0].z;
    if (v.z.sig != 0) v.z.exp = depth;
    v.x = q.vertex[0].x + (i == 1 || i == 2 ? ax : 0) + (i >= 2 ? bx : 0);
    v.y = q.vertex[0].y + (i == 1 || i == 2 ? ay : 0) + (i >= 2 ? by : 0);
    v.k = q.vertex[0].k;
  }
  const std::size_t next = rng.chance(0.5) ? 1 : 3;  // along 01 and 32, or along 03 and 12
  q.vertex[next].attribute = {};                     // that of vertex 0
  q.vertex[next == 1 ? 3 : 1].attribute = q.vertex[2].attribute;
  return q;
}

/// Areas for weights, and tiles and pixels of which nothing can be seen.
TEST(FloatLanes, PlainAndLanesLeaveOutTheSame) {
  Prng rng(404);
  std::uint64_t plane = 0, pixels = 0, tiles_hidden = 0, blocks_hidden = 0, tiles_masked = 0, on_edge = 0, corners = 0;
  for (int n = 0; n < 160; ++n) {
    Config c = fitting_config(rng);
    c.plane_quads = rng.chance(0.8) ? 1 : 0;
    if (rng.chance(0.6)) c.hierarchical_z_bits = static_cast<int>(rng.integer(6, std::min(12, c.depth_bits)));
    c.hierarchical_z_tiles_log2 = static_cast<int>(rng.integer(7, 9));
    c.validate();
    DrawState s = random_state(rng, c);
    s.skip |= skip_plane;
    if (rng.chance(0.8)) s.skip |= skip_hidden;
    s = with_possible_skips(s, c);
    std::vector<SnappedQuad> list;
    for (int i = 0; i < 40; ++i) {
      const SnappedQuad quad = random_quad(rng, c, 3);
      list.push_back(rng.chance(0.7) ? plane_one(rng, c, quad) : quad);
      plane += plane_quad(list.back(), c, s);
    }
    UntimedModel plain(c, s, PixelEngine::plain);
    std::vector<std::vector<Fragment>> expected;
    for (const SnappedQuad& quad : list) expected.push_back(draw(plain, quad));
    on_each_lane_target([&] {
      UntimedModel quick(c, s);
      for (std::size_t i = 0; i < list.size(); ++i) ASSERT_EQ(expected[i], draw(quick, list[i])) << "quad " << i;
      ASSERT_EQ(counts(plain.stats()), counts(quick.stats()));
    });
    if (HasFatalFailure()) FAIL() << "round " << n << ", S " << c.significand_bits << " + " << c.align_guard_bits;
    pixels += plain.stats().pixels;
    tiles_hidden += plain.stats().tiles_hidden;
    blocks_hidden += plain.stats().blocks_hidden;
    tiles_masked += plain.stats().tiles_masked;
    on_edge += plain.stats().on_edge;
    corners += plain.stats().on_vertex + plain.stats().two_corner;
  }
  EXPECT_GT(plane, 1000u);
  EXPECT_GT(pixels, 100'000u);
  EXPECT_GT(tiles_hidden, 500u);
  EXPECT_GT(blocks_hidden, 0u);
  EXPECT_GT(tiles_masked, 10u);
  EXPECT_GT(on_edge, 100u);
  EXPECT_GT(corners, 100u);
}

}  // namespace
}  // namespace quadrille
