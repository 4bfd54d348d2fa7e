#include "model/front/coverage_test_support.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/pixel/pixel_pipeline.hpp"

#include <gtest/gtest.h>

namespace quadrille {
namespace {

/// Wide and narrow, with all bits of the quadratic functions, some, as few as ordinary quads can spare (2
/// homogeneous_frac_bits dropped), none.
std::vector<Config> front_configs() {
  std::vector<Config> configs;
  for (const auto& [vp, guard, sub, hom, qfrac, tile] : {std::array{12, 3, 8, 7, -1, 3},
                                                         {6, 3, 8, 7, -1, 2},
                                                         {6, 3, 8, 7, 0, 4},
                                                         {12, 3, 8, 7, 16, 3},
                                                         {14, 1, 8, 7, -1, 4},
                                                         {6, 4, 2, 10, 5, 3}}) {
    Config c;
    c.viewport_bits = vp;
    c.guard_bits = guard;
    c.subpixel_bits = sub;
    c.homogeneous_frac_bits = hom;
    c.quadratic_frac_bits = qfrac;
    c.tile_log2 = tile;
    c.validate();
    configs.push_back(c);
  }
  return configs;
}

TEST(QuadSetup, FormsEqualDirectEvaluation) {
  Prng rng(21);
  for (const Config& c : front_configs()) {
    const int vp = c.viewport_bits, tile = c.tile_log2;
    DrawState state = state_of(c);
    const int span = 1 << vp, drop = c.qdrop();
    for (int n = 0; n < 4000 && !testing::Test::HasFailure(); ++n) {
      const auto kind = static_cast<Kind>(n % static_cast<int>(Kind::kinds));
      const SnappedQuad q = random_quad(rng, kind, c);
      if (rng.chance(0.3)) {
        state.scissor_x0 = static_cast<int>(rng.below(static_cast<std::uint64_t>(span)));
        state.scissor_y0 = static_cast<int>(rng.below(static_cast<std::uint64_t>(span)));
      } else {
        state.scissor_x0 = state.scissor_y0 = 0;
      }
      const SetupResult r = quad_setup(q, c, state);
      ASSERT_EQ(r.homogeneous, homogeneous(q, c));

      const int ox = r.tile_x0 << tile, oy = r.tile_y0 << tile;
      for (int m = 0; m < 6; ++m) {
        const int px = m == 0 ? ox : static_cast<int>(rng.integer(0, span - 1)),
                  py = m == 0 ? oy : static_cast<int>(rng.integer(0, span - 1));
        const Relative at(q, px, py);
        const Wide dx = px - ox, dy = py - oy;
        for (std::size_t k = 0; k < 6; ++k) {
          const LinearForm& f = r.linear[k];
          ASSERT_TRUE(f.value + dx * f.gx + dy * f.gy == at.cross(edges[k][0], edges[k][1])) << "edge " << k;
        }
      }
      // Squared distances of the vertices, wherever the origin is; the vertices as the origin pixel sees them.
      for (std::size_t k = 0; k < 6; ++k) {
        const SnappedVertex &a = q.vertex[edges[k][0]], &b = q.vertex[edges[k][1]];
        const Wide x = Wide{a.x} - b.x, y = Wide{a.y} - b.y;
        ASSERT_TRUE(r.length2[k] == (x * x + y * y) >> drop) << "pair " << k;
      }
      const Relative o(q, ox, oy);
      for (std::size_t i = 0; i < 4; ++i)
        ASSERT_TRUE(r.vertex[i].x == o.x[i] && r.vertex[i].y == o.y[i] && r.vertex[i].w == q.vertex[i].w) << i;
      // Everything fits its field of the probe.
      visit(r, c, [&](const FieldType& type, int, auto v) {
        ASSERT_TRUE(holds(type, v)) << type.name << " " << +v << " in " << +type.width;
      });

      if (!r.homogeneous) {
        ASSERT_EQ(r.visible, 15);
        ASSERT_FALSE(r.hull);
      } else {
        ASSERT_EQ(r.hull, hull_of(q));
        const Wide d012 = det(q, 0, 1, 2), d023 = det(q, 0, 2, 3);
        const int expected =
            r.hull ? 15 : (d012 > 0 ? 1 : 0) | (d023 > 0 ? 2 : 0) | (d012 < 0 ? 4 : 0) | (d023 < 0 ? 8 : 0);
        ASSERT_EQ(r.visible, expected);
      }
      // The box of tiles, from the text of rtl/SPEC.md.
      int lo[2] = {0, 0}, hi[2] = {state.scissor_x1 - 1, state.scissor_y1 - 1};
      const int scissor[2] = {state.scissor_x0, state.scissor_y0};
      bool empty = false;
      for (int axis = 0; axis < 2; ++axis) {
        if (!r.homogeneous) {
          std::int64_t low = INT64_MAX, high = INT64_MIN;
          for (const SnappedVertex& v : q.vertex) {
            low = std::min<std::int64_t>(low, axis == 0 ? v.x : v.y);
            high = std::max<std::int64_t>(high, axis == 0 ? v.x : v.y);
          }
          const double unit = std::ldexp(1.0, -c.frac());
          lo[axis] = std::max(static_cast<int>(std::ceil(static_cast<double>(low) * unit)), scissor[axis]);
          hi[axis] = std::min(static_cast<int>(std::floor(static_cast<double>(high) * unit)), hi[axis]);
        }
        empty = empty || lo[axis] > hi[axis];
      }
      const int edge = 1 << tile;
      ASSERT_EQ(r.tiles_x, empty ? 0 : hi[0] / edge - lo[0] / edge + 1);
      ASSERT_EQ(r.tiles_y, empty ? 0 : hi[1] / edge - lo[1] / edge + 1);
      ASSERT_EQ(r.tile_x0, empty ? 0 : lo[0] / edge);
      ASSERT_EQ(r.tile_y0, empty ? 0 : lo[1] / edge);
    }
  }
}

/// The quadratic functions of a tile, one by one the floor of what its vertices give, and what a pixel makes of them.
TEST(TileContext, FormsEqualDirectEvaluation) {
  Prng rng(24);
  int whole = 0, halves = 0, homogeneous_pixels = 0;
  for (const Config& c : front_configs()) {
    const DrawState state = state_of(c);
    const int span = 1 << c.viewport_bits, drop = c.qdrop(), size = c.tile();
    for (int n = 0; n < 4000 && !testing::Test::HasFailure(); ++n) {
      const auto kind = static_cast<Kind>(n % static_cast<int>(Kind::kinds));
      const SnappedQuad q = random_quad(rng, kind, c);
      const SetupResult r = quad_setup(q, c, state);
      const QuadConstants constants(r);
      TileEntry tile;
      tile.tile_x = static_cast<int>(rng.below(static_cast<std::uint64_t>(span / size)));
      tile.tile_y = static_cast<int>(rng.below(static_cast<std::uint64_t>(span / size)));
      tile.quadratic =
          tile_context(constants, (tile.tile_x - r.tile_x0) * size, (tile.tile_y - r.tile_y0) * size, drop);
      const Relative o(q, tile.tile_x * size, tile.tile_y * size);
      const auto coefficient = [&](std::size_t k, int which) -> Wide {
        if (k < 6 && !r.homogeneous) return 0;
        const std::size_t i = k < 6 ? edges[k][0] : k - 6, j = k < 6 ? edges[k][1] : k - 6;
        const Wide wi = q.vertex[i].w, wj = q.vertex[j].w;
        const Wide exact = which == 0   ? o.dot(i, j)
                           : which == 1 ? -(o.x[i] * wj + wi * o.x[j])
                           : which == 2 ? -(o.y[i] * wj + wi * o.y[j])
                                        : wi * wj;
        return exact >> drop;
      };
      for (std::size_t k = 0; k < 10; ++k) {
        const QuadraticForm& f = tile.quadratic[k];
        ASSERT_TRUE(f.value == coefficient(k, 0) && f.gx == coefficient(k, 1) && f.gy == coefficient(k, 2) &&
                    f.q == coefficient(k, 3))
            << "quadratic " << k;
      }
      visit(tile, c, [&](const FieldType& type, int, auto v) {
        ASSERT_TRUE(holds(type, v)) << type.name << " " << +v << " in " << +type.width;
      });

      // Ordinary vertices lie on a grid of 2^homogeneous_frac_bits, and nothing is lost while products do not.
      const bool exact = drop == 0 || (!r.homogeneous && drop <= 2 * c.homogeneous_frac_bits);
      const int dx = static_cast<int>(rng.below(static_cast<std::uint64_t>(size))),
                dy = static_cast<int>(rng.below(static_cast<std::uint64_t>(size)));
      const Relative at(q, tile.tile_x * size + dx, tile.tile_y * size + dy);
      PixelTrace p;
      forward_difference(p, tile, constants, dx, dy);
      const auto form = [&](std::size_t k) {
        return coefficient(k, 0) + dx * coefficient(k, 1) + dy * coefficient(k, 2) +
               (dx * dx + dy * dy) * coefficient(k, 3);
      };
      for (std::size_t k = 0; k < 10; ++k) {
        const std::size_t i = k < 6 ? edges[k][0] : k - 6, j = k < 6 ? edges[k][1] : k - 6;
        const std::int64_t value = k < 6 ? p.d[k] : p.r2[k - 6];
        ASSERT_TRUE(fits(value, c.qval_bits())) << k;
        if (exact) {
          ASSERT_TRUE(Wide{value} * (Wide{1} << drop) == at.dot(i, j)) << "quadratic " << k << " at a pixel";
        } else if (k >= 6 || r.homogeneous) {
          ASSERT_TRUE(value == form(k)) << "quadratic " << k << " at a pixel";
        } else {
          const Wide x = Wide{q.vertex[i].x} - q.vertex[j].x, y = Wide{q.vertex[i].y} - q.vertex[j].y;
          ASSERT_TRUE(value == (form(6 + i) + form(6 + j) - ((x * x + y * y) >> drop)) >> 1) << "D " << k;
          ++halves;
        }
      }
      whole += exact && drop > 0;
      homogeneous_pixels += r.homogeneous;
    }
  }
  EXPECT_GT(whole, 1000);
  EXPECT_GT(halves, 1000);
  EXPECT_GT(homogeneous_pixels, 1000);
}

}  // namespace
}  // namespace quadrille
