#include "model/fast/float_lanes.hpp"
#include "model/fast/wide_lanes.hpp"
#include "model/front/tile_context.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/pixel/pixel_pipeline_test_support.hpp"

#include <cmath>

namespace quadrille {
namespace {

class Engines : public testing::TestWithParam<int> {};

TEST_P(Engines, PlainAndLanesAreOne) {
  const auto& info = golden::stress_families()[static_cast<std::size_t>(GetParam())];
  Prng rng(100 + static_cast<std::uint64_t>(GetParam()));
  std::uint64_t fragments = 0;
  for (int n = 0; n < 70; ++n) {
    Config c = random_config(rng);
    if (n < 38) {  // every width with the flag on and off
      c.significand_bits = 8 + n / 2;
      c.notch_exact = n % 2;
      c.attribute_frac_bits = -1;
    }
    DrawState s = square(48);
    s.perspective = rng.chance(0.7);
    s.depth = rng.chance(0.6);
    s.attributes = static_cast<int>(rng.integer(0, c.attribute_slots));
    s.cull = static_cast<Cull>(rng.chance(0.7) ? 0 : rng.below(3));
    if (rng.chance(0.3)) s.znear = rng.uniform(0, 0.5), s.zfar = rng.uniform(0.5, 1);
    if (rng.chance(0.2)) s.scissor_x0 = 5, s.scissor_y0 = 11, s.scissor_x1 = 41;
    const auto quads = snapped_stress(info.family, info.family == golden::StressFamily::tiny ? 40 : 5,
                                      static_cast<std::uint64_t>(n) + 1, 48, std::max(4, c.attribute_slots), c, s);
    const Result plain = draw_all(quads, c, s, PixelEngine::plain);
    SCOPED_TRACE(std::string(info.name) + ", round " + std::to_string(n) + ", S " + std::to_string(c.significand_bits));
    on_each_lane_target([&] {
      const Result quick = draw_all(quads, c, s, PixelEngine::lanes);
      expect_same(plain.fragments, quick.fragments);
      expect_same_stats(plain.stats, quick.stats);
    });
    if (HasFailure()) return;
    ASSERT_EQ(plain.stats.fragments, plain.fragments.size());
    fragments += plain.fragments.size();
  }
  EXPECT_GT(fragments, 500u) << info.name << " draws too little to test anything";
}
INSTANTIATE_TEST_SUITE_P(EveryFamily, Engines, testing::Range(0, static_cast<int>(golden::stress_families().size())),
                         [](const auto& p) {
                           return std::string(golden::stress_families()[static_cast<std::size_t>(p.param)].name);
                         });

TEST(CornerQuads, PlainAndLanesAreOne) {
  Prng rng(180);
  std::uint64_t fragments = 0;
  for (std::uint64_t n = 0; n < 6; ++n) {
    const Config c = random_config(rng);
    for (const golden::CornerDraw& draw : golden::corner_draws(c, n)) {
      const Result plain = draw_all(draw.quads, c, draw.state, PixelEngine::plain);
      SCOPED_TRACE(std::string(draw.group) + ", round " + std::to_string(n));
      on_each_lane_target([&] {
        const Result quick = draw_all(draw.quads, c, draw.state, PixelEngine::lanes);
        expect_same(plain.fragments, quick.fragments);
        expect_same_stats(plain.stats, quick.stats);
      });
      if (HasFailure()) return;
      fragments += plain.fragments.size();
    }
  }
  EXPECT_GT(fragments, 20'000u);
}

/// Bases of attributes anywhere, also at the end of the range, and depths between limits far and near, or equal ones.
QuadBase random_base(Prng& rng, const Config& c) {
  QuadBase base;
  for (std::int64_t& a : base.attribute)
    a = rng.chance(0.3)   ? 0
        : rng.chance(0.2) ? static_cast<std::int64_t>(rng.sign()) * c.attribute_limit()
                          : rng.integer(-c.attribute_limit(), c.attribute_limit());
  base.depth = static_cast<std::uint32_t>(rng.integer(0, std::int64_t{1} << c.depth_bits));
  base.depth_high = c.depth_above();
  if (rng.chance(0.5)) {
    base.depth_low = static_cast<std::int32_t>(rng.integer(-1, c.depth_above()));
    base.depth_high =
        static_cast<std::int32_t>(rng.chance(0.3) ? base.depth_low : rng.integer(base.depth_low, c.depth_above()));
  }
  return base;
}

/// Bit patterns that rounding anywhere would betray: long runs of ones and single bits, up to 2^62, straight into the
/// pipeline's front. A, D <= r² as in a real quad; everything else random. An ordinary quad's D comes of the law of
/// cosines: its squared lengths are those that give D, or one less than twice that.
TEST(WideLanes, HardBitPatterns) {
  Prng rng(150);
  const auto pattern = [&](int top) {
    const int n = static_cast<int>(rng.integer(0, top));
    const std::int64_t ones = (std::int64_t{1} << n) - 1;
    switch (rng.below(4)) {
      case 0:
        return ones;
      case 1:
        return ones + 1;
      case 2:  // a run of ones, a gap far below
        return ones - (n > 20 ? std::int64_t{1} << rng.below(static_cast<std::uint64_t>(n - 1)) : 0);
      default:
        return static_cast<std::int64_t>(rng.next() >> (63 - n) >> 1);
    }
  };
  std::uint64_t compared = 0;
  for (int n = 0; n < 4000; ++n) {
    Config c = random_config(rng);
    c.attribute_slots = 4;
    DrawState s = square(64);
    s.depth = rng.chance(0.7);
    const PipelineContext context(c, s);
    const WideLanes lanes(context);
    const int S = c.significand_bits;
    const auto number = [&](bool sign) {
      const std::uint32_t low = 1u << (S - 1), ones = static_cast<std::uint32_t>((std::uint64_t{1} << S) - 1);
      const std::uint32_t sig = rng.chance(0.3)   ? ones
                                : rng.chance(0.2) ? low
                                                  : static_cast<std::uint32_t>(low + rng.below(low));
      return PipelineFloat{sign && rng.chance(0.5), static_cast<int>(rng.integer(-20, 20)), sig};
    };
    QuadData data;
    data.base = random_base(rng, c);
    for (std::size_t i = 0; i < 4; ++i) {
      data.k[i] = number(false);
      data.w[i] = number(true);
      data.z[i] = number(true);
      for (std::size_t j = 0; j < 4 && i != 0; ++j) data.b[i][j] = rng.chance(0.2) ? PipelineFloat{} : number(true);
    }
    if (rng.chance(0.2)) data.z = {};
    const QuadLanes values(data, context);
    for (int m = 0; m < 20; ++m) {
      TileEntry tile;
      for (std::int64_t& a : tile.linear) a = pattern(60) * (rng.chance(0.5) ? 1 : -1);
      for (std::size_t k = 0; k < 6; ++k) tile.quadratic[k].value = pattern(60) * (rng.chance(0.5) ? 1 : -1);
      for (std::size_t k = 6; k < 10; ++k) tile.quadratic[k].value = (std::int64_t{1} << 60) + pattern(62) / 2;
      QuadConstants constants;
      constants.homogeneous = m % 2 == 0;
      for (std::size_t k = 0; k < linear_count; ++k) {
        std::int64_t& d = tile.quadratic[k].value;
        const auto r2 = [&](std::size_t i) { return static_cast<std::uint64_t>(tile.quadratic[6 + i].value); };
        constants.length2[k] =
            r2(vertex_pair[k][0]) + r2(vertex_pair[k][1]) - 2 * static_cast<std::uint64_t>(d) - rng.below(2);
        if (!constants.homogeneous) d = pattern(60);  // nobody's
      }
      data.homogeneous = constants.homogeneous;
      SetupResult setup;
      setup.homogeneous = constants.homogeneous;
      setup.length2 = constants.length2;
      WideQuad wide;
      lanes.take(setup, data, values, wide);
      lanes.move_to(tile, wide);
      PixelList list;
      while (list.count < 9) list.add(0, 0, false, false);  // a vector and one more
      PixelTrace p;
      pixel_pipeline(p, tile, constants, data, 0, 0, context);
      on_each_lane_target([&] {
        LaneResults quick(s.attributes);
        lanes.draw(wide, list, list.count, quick);
        const bool singular = p.two_corner || p.on_vertex || p.two_edge;
        const FragmentArrays fragments = quick.fragments.view(0, 9);
        for (std::size_t l = 0; l < 9; ++l) {
          ASSERT_EQ(LaneResults::has(quick.plain, l), singular);
          if (singular) continue;
          ASSERT_EQ(LaneResults::has(quick.drawn, l), p.drawn);
          ASSERT_EQ(fragments[l], p.fragment);
        }
        ++compared;
      });
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(compared, 50'000u);
}

/// Areas of a few units of the last place beside distances of the whole guard band, whatever the corners say: sums of
/// weights down to where single precision loses terms. What floats keep has the bits, the rest is for wide lanes.
TEST(FloatLanes, TinySums) {
  Prng rng(151);
  std::uint64_t kept = 0, tiny = 0, left = 0;
  for (int n = 0; n < 6000; ++n) {
    Config c;
    c.significand_bits = static_cast<int>(rng.integer(8, 18));
    DrawState s = square(64);
    s.depth = false;
    s.attributes = 1;
    const PipelineContext context(c, s);
    const int S = c.significand_bits;
    QuadData data;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto sig =
          static_cast<std::uint32_t>((std::uint64_t{1} << (S - 1)) + rng.below(std::uint64_t{1} << (S - 1)));
      data.k[i] = {false, static_cast<int>(rng.integer(-8, 8)), sig};
      data.w[i] = {false, 0, 1u << (S - 1)};
      if (i != 0) data.b[i][0] = {rng.chance(0.5), static_cast<int>(rng.integer(-2, 6)), sig};
    }
    SetupResult setup;
    for (RelativeVertex& v : setup.vertex)
      v = {rng.integer(-(1 << 15), 1 << 15) << c.frac(), rng.integer(-(1 << 15), 1 << 15) << c.frac(), 1 << c.frac()};
    TileEntry tile;
    for (std::size_t k = 0; k < linear_count; ++k)
      tile.linear[k] = setup.linear[k].value =
          (std::int64_t{1} + static_cast<std::int64_t>(rng.log2_spread(0, 40))) * (rng.chance(0.5) ? 1 : -1);
    const auto r2 = [&](std::size_t i) {
      return setup.vertex[i].x * setup.vertex[i].x + setup.vertex[i].y * setup.vertex[i].y;
    };
    for (std::size_t k = 0; k < linear_count; ++k) {
      const auto [i, j] = vertex_pair[k];
      const auto shared = static_cast<std::int64_t>(rng.uniform(-1, 1) * std::sqrt(static_cast<double>(r2(i))) *
                                                    std::sqrt(static_cast<double>(r2(j))));
      setup.length2[k] = static_cast<std::uint64_t>(r2(i) + r2(j) - 2 * (shared >> 20 << 20));
    }
    const QuadConstants constants(setup);
    tile.quadratic = tile_context(constants, 0, 0, 0);
    PixelTrace p;
    pixel_pipeline(p, tile, constants, data, 0, 0, context);
    const FloatLanes lanes(context);
    const QuadLanes values(data, context);
    on_each_lane_target([&] {
      FloatQuad quad;
      ASSERT_TRUE(lanes.take(setup, data, values, quad));
      PixelList list;
      list.add(0, 0, false, false);
      LaneResults quick(1);
      lanes.draw(quad, list, 1, quick);
      if (LaneResults::has(quick.small, 0)) return void(++left);
      ++kept;
      // The sum of M k with r of the quad's size, as floats have it.
      tiny += std::ldexp(to_double(p.den_k, S), -3 * 62) < 0x1p-40;
      ASSERT_EQ(quick.fragments.view(0, 1)[0].attribute[0], p.fragment.attribute[0]) << "round " << n;
    });
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(kept, 1'000u);
  EXPECT_GT(tiny, 100u);
  EXPECT_GT(left, 100u);
}

/// All quads with corners on a small grid at tiny widths: no crash, weights in [0, 1], their sum 1 within the bound.
void exhaustive(int side, bool homogeneous, std::uint64_t stride, const Config& c, std::uint64_t& fragments) {
  DrawState s = square(8);
  s.depth = false;
  const double one = std::ldexp(1.0, c.attribute_frac()), bound = std::ldexp(1.0, -(c.significand_bits - 3));
  std::vector<SnappedVertex> points;
  for (int w = homogeneous ? -1 : 1; w <= 1; ++w)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        // Homogeneous points lie around the eye.
        const int shift = homogeneous ? side / 2 : 0;
        SnappedVertex v{(x - shift) << c.frac(),
                        (y - shift) << c.frac(),
                        w * (1 << c.frac()),
                        {false, 0, 1u << (c.significand_bits - 1)},
                        {},
                        {}};
        if (v.x != 0 || v.y != 0 || v.w != 0) points.push_back(v);
      }
  const std::uint64_t n = points.size();
  UntimedModel plain(c, s, PixelEngine::plain), quick(c, s, PixelEngine::lanes);
  for (std::uint64_t code = 0; code < n * n * n * n; code += stride) {
    SnappedQuad q;
    std::uint64_t rest = code;
    // Attribute i is 1 at vertex i: of vertex 0 as a base that the others are 1 below.
    q.base.attribute[0] = std::int64_t{1} << c.attribute_frac();
    for (std::size_t i = 0; i < 4; ++i) {
      SnappedVertex& v = q.vertex[i];
      v = points[rest % n];
      if (i == 0)
        v.attribute[0] = {};
      else
        v.attribute[0] = {true, v.k.exp, v.k.sig}, v.attribute[i] = v.k;
      rest /= n;
    }
    std::vector<Fragment> a, b;
    plain.draw(q, [&](std::span<const Fragment> f) { a.insert(a.end(), f.begin(), f.end()); });
    quick.draw(q, [&](std::span<const Fragment> f) { b.insert(b.end(), f.begin(), f.end()); });
    ASSERT_EQ(a, b) << "quad " << code;
    for (const Fragment& f : a) {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const double lambda = static_cast<double>(f.attribute[i]) / one;
        ASSERT_GE(lambda, i == 0 ? -bound : 0) << "quad " << code << ": " << text(f);
        ASSERT_LE(lambda, 1 + bound) << "quad " << code << ": " << text(f);
        sum += lambda;
      }
      ASSERT_NEAR(sum, 1, bound) << "quad " << code << ": " << text(f);
      ASSERT_FALSE(f.flags & flag_saturated);
    }
    fragments += a.size();
  }
}

TEST(TinyWidths, AllQuadsOfASmallGrid) {
  std::uint64_t fragments = 0;
  for (const int s : {8, 9, 12})
    for (const int notch : {0, 1}) {
      Config c;
      c.viewport_bits = 6;
      c.subpixel_bits = 2;
      c.homogeneous_frac_bits = 4;
      c.significand_bits = s;
      c.notch_exact = notch;
      c.align_guard_bits = s == 9 ? 0 : 2;
      c.validate();
      exhaustive(4, false, s == 8 ? 1 : 7, c, fragments);
      if (HasFailure()) return;
    }
  EXPECT_GT(fragments, 100'000u);
}

TEST(TinyWidths, HomogeneousQuadsOfASmallGrid) {
  std::uint64_t fragments = 0;
  Config c;
  c.viewport_bits = 6;
  c.subpixel_bits = 2;
  c.homogeneous_frac_bits = 4;
  c.significand_bits = 8;
  c.validate();
  exhaustive(3, true, 5, c, fragments);
  EXPECT_GT(fragments, 10'000u);
}

}  // namespace
}  // namespace quadrille
