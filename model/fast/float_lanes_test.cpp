// The single-precision lanes against the plain pipeline, where they fit and at the edges of where they do.
#include "model/fast/float_lanes.hpp"
#include "model/fast/each_lane_target.hpp"
#include "model/front/quad_setup.hpp"
#include "model/port/snap.hpp"
#include "model/skips/plane_quad.hpp"
#include "model/untimed.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cfenv>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

constexpr int size = 40;

DrawState square() {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = size;
  return s;
}

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

/// Codes that differences of 2^exponent codes and more are added to: 0, about a power of two, or at the end of the
/// range but for some.
std::int64_t random_base(Prng& rng, std::int64_t limit) {
  const auto some = static_cast<std::int64_t>(rng.log2_spread(0, 30));
  const std::int64_t magnitude = rng.chance(0.3) ? 0 : rng.chance(0.5) ? some : rng.chance(0.2) ? limit : limit - some;
  return (rng.chance(0.5) ? -1 : 1) * std::clamp<std::int64_t>(magnitude, 0, limit);
}

/// Bases and depth limits: one code, a few, about the whole range, or all of it.
QuadBase random_bases(Prng& rng, const Config& c) {
  QuadBase base;
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.attribute_slots); ++j)
    base.attribute[j] = random_base(rng, c.attribute_limit());
  const std::int32_t one = 1 << c.depth_bits;
  base.depth = rng.chance(0.2) ? 0 : rng.chance(0.2) ? one : static_cast<std::uint32_t>(rng.integer(0, one));
  base.depth_high = one + 1;
  if (rng.chance(0.5)) return base;
  const auto reach = static_cast<std::int32_t>(rng.chance(0.3) ? rng.below(3) : rng.below(static_cast<unsigned>(one)));
  const auto at = static_cast<std::int32_t>(base.depth);
  base.depth_low = std::max(-1, at - reach);
  base.depth_high = rng.chance(0.2) ? base.depth_low : std::min(one - at, reach) + at + (rng.chance(0.2) ? 1 : 0);
  return base;
}

/// Corners on pixel centres, on a coarse grid, or anywhere, some far outside; numbers of the port of either sign with
/// exponents up to `exponents`, so that sums cancel, saturate, and are 0. Of vertex 0 the attributes are not looked at.
SnappedQuad random_quad(Prng& rng, const Config& c, int exponents) {
  const int s = c.significand_bits;
  const auto number = [&](bool sign) {
    const std::uint32_t low = 1u << (s - 1), ones = 2 * low - 1;
    const std::uint32_t sig = rng.chance(0.3)   ? ones
                              : rng.chance(0.2) ? low
                                                : static_cast<std::uint32_t>(low + rng.below(low));
    return PortNumber{sign && rng.chance(0.5), static_cast<int>(rng.integer(-exponents, exponents)), sig};
  };
  const double grid = rng.chance(0.3) ? 1 : rng.chance(0.3) ? 4 : 256;
  const bool far = rng.chance(0.1), same_k = rng.chance(0.2);
  const PortNumber k = number(false);
  SnappedQuad q;
  q.id = static_cast<std::uint32_t>(rng.below(1u << c.quad_id_bits));
  q.base = random_bases(rng, c);
  std::array<int, max_attribute_slots> signs{};  // 0 one, 1 the other, 2 mixed; 3: a constant
  for (int& sign : signs) sign = static_cast<int>(rng.below(4));
  const int less = rng.chance(0.3) ? static_cast<int>(rng.below(120)) : 0;  // differences may be far below k
  const auto difference = [&](int sign) {
    if (sign == 3 || rng.chance(0.1)) return PortNumber{};
    PortNumber n = number(true);
    if (sign < 2) n.neg = sign != 0;
    n.exp -= less;
    return n;
  };
  const int depth_sign = static_cast<int>(rng.below(4));
  for (SnappedVertex& v : q.vertex) {
    const auto position = [&] {
      const double at = far ? rng.uniform(-20000, 20000) : rng.uniform(-4, size + 4);
      const double step = std::ldexp(1.0, -c.subpixel_bits);
      return static_cast<std::int32_t>(std::floor(at / std::max(step, 1 / grid)) *
                                       std::ldexp(std::max(step, 1 / grid), c.frac()));
    };
    v.x = position();
    v.y = position();
    v.w = 1 << c.frac();
    v.k = same_k ? k : number(false);
    v.z = difference(depth_sign);
    for (std::size_t j = 0; j < static_cast<std::size_t>(c.attribute_slots); ++j)
      v.attribute[j] = &v == q.vertex.data() ? number(true) : difference(signs[j]);
  }
  if (rng.chance(0.1)) {  // a bow tie that crosses at a pixel centre
    const auto x = static_cast<std::int32_t>(rng.below(20)) << c.frac(), edge = std::int32_t{16} << c.frac();
    for (std::size_t i = 0; i < 4; ++i) {
      q.vertex[i].x = x + (i == 1 || i == 2 ? edge : 0);
      q.vertex[i].y = i % 2 == 0 ? 0 : edge;
    }
  }
  return q;
}

std::vector<Fragment> draw(UntimedModel& model, const SnappedQuad& quad) {
  std::vector<Fragment> out;
  model.draw(quad, [&](std::span<const Fragment> some) { out.insert(out.end(), some.begin(), some.end()); });
  return out;
}

/// Beyond what a double holds of it on the finest grid.
bool has_far_corner(const SnappedQuad& quad, const Config& c) {
  for (const SnappedVertex& v : quad.vertex)
    if (std::max(std::abs(v.x), std::abs(v.y)) > 2 * size << c.frac()) return true;
  return false;
}

bool taken(const SnappedQuad& quad, const Config& c, const DrawState& s) {
  const PipelineContext context(c, s);
  const FloatLanes lanes(context);
  const SetupResult setup = quad_setup(quad, c, s);
  const QuadData data = quad_data(quad, setup, c, s);
  FloatQuad out;
  return lanes.usable() && lanes.take(setup, data, QuadLanes(data, context), out);
}

std::vector<std::uint64_t> counts(const DrawStats& d) {
  std::vector<std::uint64_t> all{d.blocks_tested, d.tiles_tested,  d.tiles_entered, d.stamps_covered,
                                 d.pixels,        d.fragments,     d.on_edge,       d.on_vertex,
                                 d.two_corner,    d.two_edge,      d.tie,           d.notch,
                                 d.saturated,     d.blocks_hidden, d.tiles_hidden,  d.tiles_masked};
  all.insert(all.end(), d.rejected.begin(), d.rejected.end());
  return all;
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

bool can_run_here() { return lane_target() != LaneTarget::baseline; }

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
  if (can_run_here()) {
    EXPECT_GT(quads, 1000u);
  }
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
    if (bits == 18 && can_run_here()) {
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
  EXPECT_GT(tiles_masked, 10u);
  EXPECT_GT(on_edge, 100u);
  EXPECT_GT(corners, 100u);
}

/// What they take, and each reason to refuse.
TEST(FloatLanes, TakeWhatFits) {
  if (!can_run_here()) GTEST_SKIP() << "no lanes for this processor";
  Prng rng(401);
  const Config c;
  DrawState s = square();
  const auto quad = [&] {
    SnappedQuad q;
    do q = random_quad(rng, c, 8);
    while (draw(*std::make_unique<UntimedModel>(c, s), q).empty());
    return q;
  };
  SnappedQuad good = quad();
  good.vertex[1].x |= 1 << c.homogeneous_frac_bits;  // the finest position of an ordinary vertex
  for (const std::size_t i : {1, 2}) good.vertex[i].attribute[0] = {i == 1, 1, (1u << c.significand_bits) - 1};
  good.base.attribute[0] = 0;
  EXPECT_TRUE(taken(good, c, s));
  SnappedQuad bad = good;
  bad.vertex[1].k.exp = 30;
  EXPECT_TRUE(taken(bad, c, s));
  bad.vertex[1].k.exp = 31;
  EXPECT_FALSE(taken(bad, c, s)) << "exponents go to 30";
  bad = good;
  bad.vertex[2].attribute[0].exp = 31;
  EXPECT_FALSE(taken(bad, c, s));
  bad.vertex[2].attribute[0].exp = -256;
  EXPECT_TRUE(taken(bad, c, s)) << "differences may be as small as they like";
  bad.vertex[0].attribute[0] = {false, 31, 1u << (c.significand_bits - 1)};
  EXPECT_TRUE(taken(bad, c, s)) << "of vertex 0 there is none";
  {
    const PipelineContext context(c, s);
    FloatQuad out;
    SmallQuad small;
    EXPECT_EQ(FloatLanes(context).take_small(bad, out, small), QuadReject::none) << "nor in what small quads read";
  }
  for (const std::int64_t beyond : {0, 1}) {  // a code that no attribute has
    bad = good;
    bad.base.attribute[0] = -c.attribute_limit() - beyond;
    EXPECT_EQ(taken(bad, c, s), beyond == 0);
    bad = good;
    bad.base.depth_low = static_cast<std::int32_t>(-1 - beyond);
    EXPECT_EQ(taken(bad, c, s), beyond == 0);
    bad.base.depth_low = -1;
    bad.base.depth_high = static_cast<std::int32_t>(c.depth_above() + beyond);
    EXPECT_EQ(taken(bad, c, s), beyond == 0);
    bad.base.depth_high = c.depth_above();
    bad.base.depth = static_cast<std::uint32_t>(c.depth_above() - 1 + beyond);
    EXPECT_EQ(taken(bad, c, s), beyond == 0);
  }
  bad = good;
  bad.vertex[0].w -= 1;
  EXPECT_FALSE(taken(bad, c, s)) << "not ordinary";
  // A, D and r² are 63 bits wide here: with 5 low bits of a position 0 a double holds them.
  bad = good;
  bad.vertex[3].x = (bad.vertex[3].x & ~0xff) | 1 << 5;
  EXPECT_TRUE(taken(bad, c, s));
  bad.vertex[3].x = (bad.vertex[3].x & ~0xff) | 1 << 4;
  EXPECT_FALSE(taken(bad, c, s));
  for (const int guard : {2, 3}) {
    Config wide = c;
    wide.align_guard_bits = guard;
    EXPECT_EQ(taken(good, wide, s), guard == 2) << "S + align_guard_bits = " << 18 + guard;
  }
  Config odd = c;
  odd.quadratic_frac_bits = 15;
  EXPECT_FALSE(taken(good, odd, s)) << "exponents would be odd where they are even";
  odd.quadratic_frac_bits = 14;
  EXPECT_FALSE(taken(good, odd, s)) << "a bit of the products is dropped";
  odd.quadratic_frac_bits = 16;
  EXPECT_TRUE(taken(good, odd, s));
  set_lane_target(LaneTarget::baseline);
  EXPECT_FALSE(taken(good, c, s));
  set_lane_target(can_run(LaneTarget::v4) ? LaneTarget::v4 : LaneTarget::v3);
}

/// A configuration, or the numbers of a quad, at a limit of what is taken, or a step beyond it.
struct Limit {
  std::string what;
  bool taken;
  Config config;
  std::function<void(SnappedQuad&)> edit = [](SnappedQuad&) {};
};

std::vector<Limit> limits() {
  std::vector<Limit> list;
  const Config standard;
  const auto with = [&](const std::string& what, bool taken, auto&& change) {
    Config c = standard;
    change(c);
    c.validate();
    list.push_back({what, taken, c});
  };
  for (int s = 14; s <= 21; ++s)
    for (int g = 0; g <= 6; ++g) {
      if (s + g != 20 && s + g != 21) continue;
      // Of S = 20 a place of the reciprocal's table is 2^23.
      with("S " + std::to_string(s) + " + " + std::to_string(g), s + g == 20 && s < 20, [&](Config& c) {
        c.significand_bits = s;
        c.align_guard_bits = g;
      });
    }
  for (const int frac : {23, 24})
    with("attributes of 8 + " + std::to_string(frac) + " bits", frac == 23, [&](Config& c) {
      c.attribute_int_bits = 8;
      c.attribute_frac_bits = frac;
    });
  for (const int segments : {4, 6, 7, 9})  // tables that a register or two hold, and longer ones
    with("2^" + std::to_string(segments) + " segments", true, [&](Config& c) {
      c.sqrt_segments_log2 = segments - 1;
      c.recip_segments_log2 = segments;
    });
  for (const int exponent : {-256, -127, -126, -91, -90, -64, -31, -30, -29, 29, 30, 31}) {
    const auto number = [&](const std::string& what, bool difference, auto&& of) {
      const bool fits = exponent <= 30 && (difference || exponent >= -30);
      for (std::size_t first = 0; first < 5; ++first)  // one vertex, or all
        list.push_back({what + " 2^" + std::to_string(exponent) + (first == 4 ? " everywhere" : ""), fits, standard,
                        [=](SnappedQuad& q) {
                          for (std::size_t i = 0; i < 4; ++i)
                            if (first == 4 || (difference && first == 0 ? 1 : first) == i) {
                              PortNumber& n = of(q.vertex[i]);
                              if (n.sig == 0) n.sig = 1u << 17;
                              n.exp = exponent;
                            }
                        }});
    };
    number("k", false, [](SnappedVertex& v) -> PortNumber& { return v.k; });
    number("depth", true, [](SnappedVertex& v) -> PortNumber& { return v.z; });
    number("an attribute", true, [](SnappedVertex& v) -> PortNumber& { return v.attribute[1]; });
  }
  // The sum of M k is near what the lanes leave to the plain pipeline, on either side of it.
  for (int exponent = -29; exponent <= -20; ++exponent)
    list.push_back({"sums about 2^" + std::to_string(exponent), true, standard, [=](SnappedQuad& q) {
                      for (SnappedVertex& v : q.vertex) {
                        v.k.exp = exponent;
                        for (PortNumber& b : v.attribute)
                          if (b.sig != 0) b.exp = exponent;
                      }
                    }});
  return list;
}

/// At each limit the lanes draw the plain pipeline's bits; a step beyond it they leave the quad to others, and so does
/// the model.
TEST(FloatLanes, LimitsOfTheRange) {
  if (!can_run_here()) GTEST_SKIP() << "no lanes for this processor";
  Prng rng(403);
  DrawState s = square();
  s.attributes = 2;
  s.skip &= ~skip_quads;  // one outside of every depth is drawn, too
  int inside = 0, outside = 0;
  for (const Limit& limit : limits()) {
    SCOPED_TRACE(limit.what);
    UntimedModel plain(limit.config, s, PixelEngine::plain);
    std::uint64_t fragments = 0;
    for (int n = 0; n < 12; ++n) {
      SnappedQuad quad;
      do quad = random_quad(rng, limit.config, 8);
      while (has_far_corner(quad, limit.config));
      // No constants, of which nothing would be looked at.
      quad.base.depth_low = -1;
      quad.base.depth_high = limit.config.depth_above();
      quad.vertex[3].attribute[0] = {false, 0, 1u << (limit.config.significand_bits - 1)};
      limit.edit(quad);
      ASSERT_EQ(taken(quad, limit.config, s), limit.taken);
      const std::vector<Fragment> expected = draw(plain, quad);
      fragments += expected.size();
      on_each_lane_target([&] {
        UntimedModel quick(limit.config, s);
        ASSERT_EQ(expected, draw(quick, quad));
      });
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(plain.stats().pixels, 100u);
    (limit.taken ? inside : outside) += fragments != 0;
  }
  EXPECT_GE(inside, 60);
  EXPECT_GE(outside, 20);
}

/// As large as a small quad may be, and a unit larger, anywhere to the scissor and to the tiles: the front in 32 bits
/// is that in 64.
TEST(FloatLanes, SmallQuadsAtTheirLimit) {
  if (!can_run_here()) GTEST_SKIP() << "no lanes for this processor";
  Prng rng(404);
  const Config c;
  const int pixel = 1 << c.subpixel_bits, largest = SmallQuad::largest * pixel;
  std::array<std::uint64_t, quad_reject_count> rejected{};
  int small = 0, larger = 0, more_tiles = 0;
  std::uint64_t fragments = 0, ties = 0;
  for (int n = 0; n < 200; ++n) {
    DrawState s;
    s.width = s.height = s.scissor_x1 = s.scissor_y1 = 160;
    s.attributes = 1;
    s.cull = static_cast<Cull>(rng.chance(0.7) ? 0 : rng.below(3));
    if (rng.chance(0.3)) s.zfar = 0.5;
    if (rng.chance(0.5)) {
      s.scissor_x0 = static_cast<int>(rng.below(90));
      s.scissor_x1 = s.scissor_x0 + 1 + static_cast<int>(rng.below(70));
    }
    const PipelineContext context(c, s);
    const FloatLanes lanes(context);
    EXPECT_TRUE(lanes.small());
    UntimedModel plain(c, s, PixelEngine::plain);
    std::vector<SnappedQuad> list;
    std::vector<std::vector<Fragment>> expected;
    for (int i = 0; i < 12; ++i) {
      SnappedQuad q = random_quad(rng, c, 4);
      const int extent = largest + (rng.chance(0.2) ? 1 : 0);
      const int grid = rng.chance(0.5) ? pixel : 1;  // on pixel centres, or anywhere
      const int x0 = static_cast<int>(rng.integer(-40 * pixel, 150 * pixel)) / grid * grid;
      const int y0 = static_cast<int>(rng.integer(-40 * pixel, 150 * pixel)) / grid * grid;
      for (std::size_t v = 0; v < 4; ++v) {
        const auto at = [&](bool far, int from) {
          const int inside = static_cast<int>(rng.below(static_cast<std::uint64_t>(largest))) / grid * grid;
          return (from + (rng.chance(0.2) ? inside : far ? extent : 0)) * (1 << c.homogeneous_frac_bits);
        };
        q.vertex[v].x = at(v == 1 || v == 2, x0);
        q.vertex[v].y = at(v >= 2, y0);
      }
      if (rng.chance(0.3)) std::swap(q.vertex[1], q.vertex[3]);  // the other face
      if (rng.chance(0.2)) std::swap(q.vertex[1], q.vertex[2]);  // a bow tie
      if (rng.chance(0.1)) q.vertex[1] = q.vertex[3] = q.vertex[2];
      list.push_back(q);
      expected.push_back(draw(plain, q));
      FloatQuad out;
      SmallQuad as_small;
      const auto [least, most] = std::minmax({q.vertex[0].x, q.vertex[1].x, q.vertex[2].x, q.vertex[3].x});
      const auto [low, high] = std::minmax({q.vertex[0].y, q.vertex[1].y, q.vertex[2].y, q.vertex[3].y});
      const bool too_large = std::max(most - least, high - low) > largest << c.homogeneous_frac_bits;
      if (const auto taken = lanes.take_small(q, out, as_small)) {
        EXPECT_TRUE(!too_large || *taken == QuadReject::empty);
        small += *taken == QuadReject::none;
      } else {
        (too_large ? larger : more_tiles) += 1;
      }
    }
    on_each_lane_target([&] {
      UntimedModel quick(c, s);
      for (std::size_t i = 0; i < list.size(); ++i) ASSERT_EQ(expected[i], draw(quick, list[i])) << "quad " << i;
      ASSERT_EQ(counts(plain.stats()), counts(quick.stats()));
    });
    if (HasFatalFailure()) FAIL() << "round " << n;
    for (std::size_t i = 0; i < rejected.size(); ++i) rejected[i] += plain.stats().rejected[i];
    fragments += plain.stats().fragments;
    ties += plain.stats().tie;
  }
  EXPECT_GT(small, 300);
  EXPECT_GT(larger, 50);
  EXPECT_GT(more_tiles, 5);
  EXPECT_GT(fragments, 200'000u);
  EXPECT_GT(ties, 1000u);
  for (const QuadReject reason : {QuadReject::none, QuadReject::empty, QuadReject::line, QuadReject::culled})
    EXPECT_GT(rejected[static_cast<std::size_t>(reason)], 5u) << static_cast<int>(reason);
}

/// How the unit rounds, seen from its results: fegetround() asks another unit.
std::array<double, 3> rounding() {
  const volatile double one = 1, minus_one = -1, three = 3, least = 0x1p-1022, half = 0.5;
  return {one / three, minus_one / three, least * half};
}

/// The caller's rounding mode neither changes nor is changed.
TEST(FloatLanes, RoundingModeIsTheCallers) {
  Prng rng(402);
  const Config c;
  const DrawState s = square();
  UntimedModel plain(c, s, PixelEngine::plain);
  std::uint64_t fragments = 0;
  for (int n = 0; n < 100; ++n) {
    const SnappedQuad quad = random_quad(rng, c, 8);
    const std::vector<Fragment> expected = draw(plain, quad);
    for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
      on_each_lane_target([&] {
        UntimedModel quick(c, s);
        std::vector<Fragment> got;
        std::array<double, 3> in_sink{};
        std::fesetround(mode);
        const std::array<double, 3> before = rounding();
        in_sink = before;
        std::feclearexcept(FE_ALL_EXCEPT);
        quick.draw(quad, [&](std::span<const Fragment> some) {
          in_sink = rounding();
          got.insert(got.end(), some.begin(), some.end());
        });
        const std::array<double, 3> after = rounding();
        std::fesetround(FE_TONEAREST);
        EXPECT_EQ(before, in_sink);
        EXPECT_EQ(before, after);
        ASSERT_EQ(expected, got);
      });
    if (HasFailure()) return;
    fragments += expected.size();
  }
  EXPECT_GT(fragments, 2000u);
}

}  // namespace
}  // namespace quadrille
