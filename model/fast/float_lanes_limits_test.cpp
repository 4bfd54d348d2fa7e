#include "model/fast/float_lanes_test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <functional>
#include <string>

namespace quadrille {
namespace {

/// Beyond what a double holds of it on the finest grid.
bool has_far_corner(const SnappedQuad& quad, const Config& c) {
  for (const SnappedVertex& v : quad.vertex)
    if (std::max(std::abs(v.x), std::abs(v.y)) > 2 * size << c.frac()) return true;
  return false;
}

/// What they take, and each reason to refuse.
TEST(FloatLanes, TakeWhatFits) {
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
    const FloatLanes lanes(context);
    if (lanes.small()) {
      EXPECT_EQ(lanes.take_small(bad, out, small), QuadReject::none) << "nor in what small quads read";
    }
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

/// A quotient near half a code hangs on a term below 2^-126, which no product by itself has in single precision.
TEST(FloatLanes, TermsBelowTheLeastProduct) {
  Config c;
  c.attribute_int_bits = 1;
  c.attribute_frac_bits = 30;
  c.validate();
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = 4096;
  s.attributes = 1;
  s.depth = false;
  SnappedQuad quad;
  constexpr std::int32_t position[4][2]{
      {6345984, 73847040}, {127417856, 56870144}, {10696576, 73251968}, {114771584, 58649984}};
  constexpr std::uint32_t k[4]{156515, 143160, 139378, 141667};
  constexpr PortNumber attribute[4]{{}, {false, -75, 189784}, {false, -59, 217558}, {false, -79, 241555}};
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i].x = position[i][0];
    quad.vertex[i].y = position[i][1];
    quad.vertex[i].w = 1 << c.frac();
    quad.vertex[i].k = {false, -30, k[i]};
    quad.vertex[i].attribute[0] = attribute[i];
  }
  ASSERT_TRUE(taken(quad, c, s));
  UntimedModel plain(c, s, PixelEngine::plain);
  const std::vector<Fragment> expected = draw(plain, quad);
  EXPECT_TRUE(std::ranges::any_of(expected,
                                  [](const Fragment& f) { return f.x == 1976 && f.y == 2004 && f.attribute[0] == 2; }));
  on_each_lane_target([&] {
    UntimedModel quick(c, s);
    EXPECT_EQ(expected, draw(quick, quad));
  });
}

/// As large as a small quad may be, and a unit larger, anywhere to the scissor and to the tiles: the front in 32 bits
/// is that in 64.
TEST(FloatLanes, SmallQuadsAtTheirLimit) {
  if (lane_target() < LaneTarget::v3) GTEST_SKIP() << "small quads have a way of their own from AVX2 on";
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
