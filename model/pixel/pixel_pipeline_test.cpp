// The pixel pipeline: both engines give the same bits, the clocked shell the same stream as the untimed model, the ends
// of the pipeline (exact front, fixed-point back) what their definitions say, and tiny widths exhaustively.
#include "model/pixel/pixel_pipeline.hpp"
#include "model/fast/lane_quad.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/pixel/pixel_pipeline_test_support.hpp"

#include <cmath>

namespace quadrille {
namespace {

/// Two corners at one pixel share it evenly whatever their k.
TEST(PixelPipeline, TwoCornersGiveHalves) {
  const Config c;
  DrawState s = square(16);
  s.depth = false;
  std::uint64_t seen = 0;
  // Two neighbouring corners (a collapsed edge) at the centre of pixel (4, 4), which the tie rule gives to some of the
  // turns; two opposite ones leave nothing to cover.
  const double w[4] = {1, 4, 0.125, 2};
  for (int turn = 0; turn < 256; ++turn) {
    const double p[4][2] = {{4.5, 4.5},
                            {4.5, 4.5},
                            {1.5 + turn % 4 * 2, 1.5 + turn / 4 % 4 * 2},
                            {1.5 + turn / 16 % 4 * 2, 1.5 + turn / 64 * 2}};
    for (std::size_t first = 0; first < 4; ++first) {
      WindowQuad q;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = (i + first) & 3;
        q.vertex[at] = {p[i][0] * w[at], p[i][1] * w[at], 0, w[at]};
        q.attribute[at].assign(4, 0);
        q.attribute[at][at] = 1;
      }
      for (const PixelEngine engine : {PixelEngine::plain, PixelEngine::lanes})
        for (const Fragment& f : draw_all({snap_quad(q, c, s)}, c, s, engine).fragments) {
          if (!(f.flags & flag_two_corner)) continue;
          ASSERT_TRUE(f.x == 4 && f.y == 4);
          ++seen;
          for (std::size_t i = 0; i < 4; ++i) {
            const double half = i == first || i == ((first + 1) & 3) ? 0.5 : 0;
            ASSERT_NEAR(std::ldexp(static_cast<double>(f.attribute[i]), -c.attribute_frac()), half, 0x1p-15);
          }
        }
    }
  }
  EXPECT_GT(seen, 20u);
}

TEST(Clocked, StreamIsTheUntimedOneForEveryStallPattern) {
  Prng rng(200);
  std::uint64_t fragments = 0;
  for (const auto& info : golden::stress_families())
    for (int n = 0; n < 4; ++n) {
      Config c = random_config(rng);
      c.quad_slots_log2 = static_cast<int>(rng.integer(1, 4));
      c.tile_slots_log2 = static_cast<int>(rng.integer(1, 4));
      c.stamp_fifo_log2 = static_cast<int>(rng.integer(1, 5));
      DrawState s = square(40);
      s.depth = rng.chance(0.6);
      s.attributes = static_cast<int>(rng.integer(0, c.attribute_slots));
      if (rng.chance(0.2)) s.skip = 0;
      const auto quads =
          snapped_stress(info.family, 6, static_cast<std::uint64_t>(n) + 50, 40, std::max(4, c.attribute_slots), c, s);
      const auto expected = draw_all(quads, c, s, PixelEngine::lanes).fragments;
      SCOPED_TRACE(std::string(info.name) + ", round " + std::to_string(n));
      const double gap[] = {0, 0.1, 0.5, 0.9}, stall[] = {0, 0.5, 0.9, 0.1};
      expect_same(expected, clocked_stream(quads, c, s, rng.next(), gap[n], stall[n]));
      if (HasFailure()) return;
      fragments += expected.size();
    }
  EXPECT_GT(fragments, 20'000u);
}

/// What has no pixel must still pass: empty scissor, everything culled, quads off screen.
TEST(Clocked, QuadsWithoutFragmentsComeAndGo) {
  const Config c;
  DrawState s = square(64);
  auto quads = snapped_stress(golden::StressFamily::general, 20, 3, 64, 4, c, s);
  s.scissor_x1 = 0;
  EXPECT_TRUE(clocked_stream(quads, c, s, 1, 0, 0).empty());
  s = square(64);
  for (SnappedQuad& q : quads)
    for (SnappedVertex& v : q.vertex) v.x -= 1000 << 15;
  EXPECT_TRUE(clocked_stream(quads, c, s, 1, 0.3, 0.3).empty());
  EXPECT_TRUE(clocked_stream({}, c, s, 1, 0, 0).empty());
}

/// Makes something of the quad constant, by the generator: attributes without differences or with equal ones, a depth
/// that is its base, or W times a power of two above it, or between equal limits; k = W, equal k.
void make_constant(SnappedQuad& quad, Prng& rng, const Config& c) {
  const int fill = c.significand_bits - 1;
  const bool k_is_w = rng.chance(0.4), equal_k = rng.chance(0.3), flat = rng.chance(0.5), none = rng.chance(0.3);
  if (rng.chance(0.3)) quad.base.depth_high = quad.base.depth_low = static_cast<std::int32_t>(quad.base.depth);
  const int z_exp = -static_cast<int>(rng.integer(1, 4));
  std::vector<int> kind, exp;
  for (std::size_t j = 0; j < max_attribute_slots; ++j) {
    kind.push_back(static_cast<int>(rng.below(5)));
    exp.push_back(-static_cast<int>(rng.below(4)));
  }
  const PortNumber k0 = quad.vertex[0].k;
  for (SnappedVertex& v : quad.vertex) {
    const PipelineFloat w = fp_from_signed(v.w, -c.frac(), {c.significand_bits, c.align_guard_bits});
    if (equal_k) v.k = k0;
    if (k_is_w && v.w > 0) v.k = {false, w.exp, w.sig};
    if (flat) v.z = none ? PortNumber{} : PortNumber{w.neg, w.exp + z_exp, w.sig};
    for (std::size_t j = 0; j < max_attribute_slots; ++j) {
      if (kind[j] == 0) v.attribute[j] = {};
      if (kind[j] == 1) v.attribute[j] = {exp[j] % 2 != 0, v.k.exp + exp[j], v.k.sig};
      if (kind[j] == 2) v.attribute[j] = {false, exp[j], (1u << fill) + 3};
    }
  }
}

/// The same fragments with skip_operands in either engine as without in the plain one.
TEST(PixelPipeline, LeavesNothingOutThatAFragmentNeeds) {
  Prng rng(900);
  std::uint64_t fragments = 0, corners = 0, nothing = 0, shared = 0;
  for (const auto& info : golden::stress_families())
    for (int n = 0; n < 24; ++n) {
      const Config c = random_config(rng);
      DrawState s = square(40);
      s.perspective = rng.chance(0.6);
      s.depth = rng.chance(0.6);
      s.attributes = static_cast<int>(rng.integer(0, c.attribute_slots));
      if (rng.chance(0.3)) s.znear = rng.uniform(0, 0.6), s.zfar = rng.uniform(0.4, 1);
      auto quads = snapped_stress(info.family, 5, rng.next(), 40, std::max(4, c.attribute_slots), c, s);
      for (SnappedQuad& quad : quads)
        if (rng.chance(0.6)) make_constant(quad, rng, c);
      DrawState all = s;
      all.skip &= ~std::uint32_t{skip_operands};
      const Result expected = draw_all(quads, c, all, PixelEngine::plain);
      SCOPED_TRACE(std::string(info.name) + ", round " + std::to_string(n));
      for (const PixelEngine engine : {PixelEngine::plain, PixelEngine::lanes}) {
        const Result left_out = draw_all(quads, c, s, engine);
        expect_same(expected.fragments, left_out.fragments);
        expect_same_stats(expected.stats, left_out.stats);
        if (HasFailure()) return;
      }
      fragments += expected.fragments.size();
      corners += expected.stats.on_vertex + expected.stats.two_corner;
      nothing += s.attributes == 0 && !s.depth;
      const PipelineContext context(c, s);
      for (const SnappedQuad& quad : quads) {
        const QuadLanes values(quad_data(quad, quad_setup(quad, c, s), c, s), context);
        shared += values.w_of_k.has_value() + (s.attributes > 0 && !values.sum_b[0]) + (s.depth && !values.sum_z);
      }
    }
  EXPECT_GT(fragments, 20'000u);
  EXPECT_GT(corners, 100u);
  EXPECT_GT(nothing, 0u);
  EXPECT_GT(shared, 100u);
}

Wide cross(const SnappedQuad& q, std::size_t i, std::size_t j, int x, int y) {
  const auto sx = [&](std::size_t k) { return q.vertex[k].x - static_cast<Wide>(q.vertex[k].w) * x; };
  const auto sy = [&](std::size_t k) { return q.vertex[k].y - static_cast<Wide>(q.vertex[k].w) * y; };
  return sx(i) * sy(j) - sy(i) * sx(j);
}
Wide dot(const SnappedQuad& q, std::size_t i, std::size_t j, int x, int y) {
  const auto sx = [&](std::size_t k) { return q.vertex[k].x - static_cast<Wide>(q.vertex[k].w) * x; };
  const auto sy = [&](std::size_t k) { return q.vertex[k].y - static_cast<Wide>(q.vertex[k].w) * y; };
  return sx(i) * sx(j) + sy(i) * sy(j);
}

/// Stages 1 to 6 and 25 of single pixels: exact values, normalised significands, singular classes in their priority,
/// |r/R - 1| small, fixed-point conversion and discard by definition.
TEST(PixelPipeline, EndsFollowTheirDefinitions) {
  constexpr std::size_t pairs[6][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}, {1, 3}};
  Prng rng(300);
  int classes[5] = {}, discarded = 0, saturated = 0, exact_with_drop = 0;
  for (const auto& info : golden::stress_families())
    for (int n = 0; n < 12; ++n) {
      Config c = random_config(rng);
      if (n % 3 != 0) c.quadratic_frac_bits = -1;
      DrawState s = square(40);
      s.skip = 0;  // every stage of every pixel
      s.attributes = static_cast<int>(rng.integer(0, c.attribute_slots));
      s.depth = rng.chance(0.8);
      s.perspective = rng.chance(0.7);
      if (rng.chance(0.4)) s.znear = rng.uniform(0, 0.6), s.zfar = rng.uniform(0.4, 1);
      const PipelineContext context(c, s);
      const int S = c.significand_bits;
      for (const SnappedQuad& q :
           snapped_stress(info.family, 4, rng.next(), 40, std::max(4, c.attribute_slots), c, s)) {
        const SetupResult setup = quad_setup(q, c, s);
        const QuadConstants constants(setup);
        const QuadData data = quad_data(q, setup, c, s);
        TileEntry tile;
        tile.tile_x = setup.tile_x0;
        tile.tile_y = setup.tile_y0;
        for (std::size_t k = 0; k < 6; ++k) tile.linear[k] = setup.linear[k].value;
        tile.quadratic = tile_context(constants, 0, 0, c.qdrop());
        // Nothing is lost of vertices on the subpixel grid while products of two positions keep their bits.
        bool exact = c.qdrop() <= 2 * c.homogeneous_frac_bits;
        for (const SnappedVertex& v : q.vertex)
          exact = exact && v.w == 1 << c.frac() && (v.x | v.y) % (1 << c.homogeneous_frac_bits) == 0;
        exact = exact || c.qdrop() == 0;
        exact_with_drop += exact && c.qdrop() > 0;
        const Wide unit = Wide{1} << c.qdrop();
        for (int row = 0; row < c.tile(); ++row)
          for (int dx = 0; dx < c.tile(); ++dx) {
            PixelTrace p;
            pixel_pipeline(p, tile, constants, data, dx, row, context);
            const int x = setup.tile_x0 * c.tile() + dx, y = setup.tile_y0 * c.tile() + row;
            ASSERT_EQ(p.x, x);
            ASSERT_EQ(p.y, y);
            for (std::size_t k = 0; k < 6; ++k) {
              ASSERT_TRUE(p.a[k] == cross(q, pairs[k][0], pairs[k][1], x, y));
              if (exact) {
                ASSERT_TRUE(p.d[k] * unit == dot(q, pairs[k][0], pairs[k][1], x, y));
              }
              const auto a = static_cast<std::uint64_t>(p.a[k] < 0 ? -p.a[k] : p.a[k]);
              PipelineFloat expected = fp_from_magnitude(a, -c.qdrop(), context.format);
              expected.neg = p.a[k] < 0;
              ASSERT_EQ(p.a_fp[k], expected);
            }
            if (exact) {
              for (std::size_t k = 0; k < 4; ++k) ASSERT_TRUE(p.r2[k] * unit == dot(q, k, k, x, y));
            }
            // Singular class: two corners, one, two edges, one edge, in this priority.
            int corners = 0, on = 0;
            for (std::size_t k = 0; k < 4; ++k) {
              corners += p.r2[k] <= 0;
              on += p.a[k] == 0 && p.d[k] < 0;
            }
            const int expected_class = corners >= 2 ? 4 : corners == 1 ? 3 : on >= 2 ? 2 : on == 1 ? 1 : 0;
            const int got = p.two_corner ? 4 : p.on_vertex ? 3 : p.two_edge ? 2 : p.on_edge ? 1 : 0;
            ASSERT_EQ(got, expected_class);
            ASSERT_EQ(p.two_corner + p.on_vertex + p.two_edge + p.on_edge, expected_class != 0);
            ++classes[expected_class];
            for (std::size_t k = 0; k < 4; ++k) {
              if (p.r2[k] <= 0) {
                ASSERT_EQ(p.root[k], PipelineFloat{});
                continue;
              }
              const double root = std::ldexp(p.root[k].sig, p.root[k].exp - (S - 1)), r2 = static_cast<double>(p.r2[k]);
              // Truncation of r² can take half a relative 2^-(S-1), the faithful table one.
              ASSERT_NEAR(root / std::sqrt(r2), 1, std::ldexp(1.6, -(S - 1)));
            }
            // u and v are magnitudes, v at most u and a truncation; dropped bits of D and r² may make u smaller.
            for (std::size_t k = 0; k < 6; ++k) {
              ASSERT_FALSE(p.u[k].neg || p.v[k].neg);
              if (!exact || p.v[k].sig == 0) continue;
              const auto value = [&](const PipelineFloat& v) { return std::ldexp(v.sig, v.exp - (S - 1)); };
              ASSERT_LE(value(p.v[k]), value(p.u[k]) * (1 + std::ldexp(4, -(S - 1))));
            }
            // Stage 25.
            const PipelineFloat rk = reciprocal(p.den_k, context.recip_table, context.format);
            const PipelineFloat rw = reciprocal(p.den_w, context.recip_table, context.format);
            // base + a b in codes, the product to nearest, halves away from 0; beyond every code from 2^int_bits on.
            const auto in_codes = [&](const PipelineFloat& a, const PipelineFloat& b, std::int64_t base, int int_bits,
                                      int frac) -> std::int64_t {
              const double size = std::ldexp(static_cast<double>(std::uint64_t{a.sig} * b.sig),
                                             a.exp + b.exp - 2 * (S - 1) + frac);  // exact: 52 bits
              double code = size >= std::ldexp(1.0, int_bits + frac) ? 0x1p60 : std::floor(size);
              if (size - code >= 0.5) ++code;
              return base + static_cast<std::int64_t>(a.neg != b.neg ? -code : code);
            };
            const std::int64_t limit = (std::int64_t{1} << (c.attribute_int_bits + c.attribute_frac())) - 1;
            bool any = false;
            for (std::size_t j = 0; j < max_attribute_slots; ++j) {
              if (static_cast<int>(j) >= s.attributes) {
                ASSERT_EQ(p.fragment.attribute[j], 0);
                continue;
              }
              const std::int64_t sum =
                  in_codes(p.num_a[j], rk, data.base.attribute[j], c.attribute_int_bits + 1, c.attribute_frac());
              any = any || std::abs(sum) > limit;
              ASSERT_EQ(p.fragment.attribute[j], sum > limit ? limit : sum < -limit ? -limit : sum);
            }
            ASSERT_EQ((p.fragment.flags & flag_saturated) != 0, any);
            saturated += any;
            bool drop = setup.hull && (p.den_w.sig == 0 || p.den_w.neg);
            if (s.depth) {
              std::int64_t z = in_codes(p.num_z, rw, data.base.depth, 1, c.depth_bits);
              if (p.den_w.sig == 0 || z > data.base.depth_high) z = data.base.depth_high;
              if (z < data.base.depth_low) z = data.base.depth_low;
              ASSERT_EQ(p.fragment.depth, z < 0 ? 0 : z);
              const double scale = std::ldexp(1.0, c.depth_bits);
              drop = drop || static_cast<double>(z) < std::nearbyint(s.znear * scale) ||
                     static_cast<double>(z) > std::nearbyint(s.zfar * scale);
            } else {
              ASSERT_EQ(p.fragment.depth, 0u);
            }
            ASSERT_EQ(p.drawn, !drop);
            discarded += drop;
          }
      }
    }
  for (const int n : classes) EXPECT_GT(n, 0);
  EXPECT_GT(exact_with_drop, 30);  // quads
  EXPECT_GT(discarded, 100);
  EXPECT_GT(saturated, 10);
}

}  // namespace
}  // namespace quadrille
