#include "golden/analysis/range_proof.hpp"
#include "golden/scenes/stress.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <gtest/gtest.h>

#include <span>
#include <vector>

namespace quadrille {
namespace {

/// Floor of D or r² of a quad at a pixel, exactly: the oracle of the dropped bits.
__int128 dot_at(const SnappedQuad& q, std::size_t i, std::size_t j, int x, int y) {
  const auto sx = [&](std::size_t k) { return q.vertex[k].x - static_cast<__int128>(q.vertex[k].w) * x; };
  const auto sy = [&](std::size_t k) { return q.vertex[k].y - static_cast<__int128>(q.vertex[k].w) * y; };
  return sx(i) * sx(j) + sy(i) * sy(j);
}

/// A random pixel of a random tile right of and below the quad's origin, as the machine has it.
struct TilePixel {
  int x = 0, y = 0, dx = 0, row = 0;
  PixelTrace trace;

  TilePixel(const SetupResult& setup, const Config& c, golden::Prng& rng) {
    const QuadConstants constants(setup);
    const std::int64_t last = (1 << (c.viewport_bits - c.tile_log2)) - 1;
    TileEntry tile;
    tile.tile_x = static_cast<int>(rng.integer(setup.tile_x0, last));
    tile.tile_y = static_cast<int>(rng.integer(setup.tile_y0, last));
    tile.quadratic = tile_context(constants, (tile.tile_x - setup.tile_x0) * c.tile(),
                                  (tile.tile_y - setup.tile_y0) * c.tile(), c.qdrop());
    dx = static_cast<int>(rng.below(static_cast<std::uint64_t>(c.tile())));
    row = static_cast<int>(rng.below(static_cast<std::uint64_t>(c.tile())));
    x = tile.tile_x * c.tile() + dx;
    y = tile.tile_y * c.tile() + row;
    forward_difference(trace, tile, constants, dx, row);
  }
};

DrawState whole_viewport(const Config& c) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 1 << c.viewport_bits;
  return state;
}

/// Ordinary vertices lose nothing up to 2 homogeneous_frac_bits dropped bits, for every pair of grids, and something
/// with one bit more.
TEST(DroppedBits, OrdinaryQuadsLoseNoneUpToTheRule) {
  golden::Prng rng(11);
  for (int sub = 2; sub <= 8; ++sub)
    for (int hom = 4; hom <= 10; ++hom)
      for (const int more : {0, 1}) {
        Config c;
        c.viewport_bits = 8;
        c.subpixel_bits = sub;
        c.homogeneous_frac_bits = hom;
        c.tile_log2 = static_cast<int>(rng.integer(2, 4));
        c.quadratic_frac_bits = 2 * sub - more;
        c.validate();
        EXPECT_EQ(keeps_ordinary_products(c), more == 0);
        const DrawState state = whole_viewport(c);
        const int drop = c.qdrop();
        int lost = 0;
        for (int n = 0; n < 200; ++n) {
          WindowQuad given;
          const double reach = n % 2 == 0 ? 300 : 1900;  // the guard band is 2^11 wide
          for (WindowVertex& v : given.vertex) {
            const double w = rng.log2_spread(-3, 3);
            v = {rng.uniform(-reach, reach) * w, rng.uniform(-reach, reach) * w, 0, w};
          }
          const SnappedQuad q = snap_quad(given, c, state);
          const SetupResult setup = quad_setup(q, c, state);
          ASSERT_FALSE(setup.homogeneous);
          const TilePixel at(setup, c, rng);
          const auto check = [&](__int128 kept, __int128 exact, const char* what) {
            const bool same = kept * (__int128{1} << drop) == exact;
            lost += !same;
            EXPECT_TRUE(same || more == 1)
                << what << " with subpixel_bits " << sub << ", homogeneous_frac_bits " << hom;
          };
          for (std::size_t k = 0; k < linear_count; ++k) {
            const auto [i, j] = vertex_pair[k];
            const __int128 x = __int128{q.vertex[i].x} - q.vertex[j].x, y = __int128{q.vertex[i].y} - q.vertex[j].y;
            check(setup.length2[k], x * x + y * y, "length2");
            check(at.trace.d[k], dot_at(q, i, j, at.x, at.y), "D");
          }
          for (std::size_t i = 0; i < 4; ++i) check(at.trace.r2[i], dot_at(q, i, i, at.x, at.y), "r²");
        }
        EXPECT_EQ(lost > 0, more == 1);
      }
}

/// The rule as a user sees it: the fragments of ordinary quads are the same bits with all of the bits of D and r² and
/// with those of products on the ordinary grid alone, and with one bit less they are not.
TEST(DroppedBits, OrdinaryFragmentsAreTheSameUpToTheRule) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 64;
  std::size_t compared = 0;
  for (const int sub : {4, 8}) {
    Config all;
    all.subpixel_bits = sub;
    all.significand_bits = 24;
    all.validate();
    Config least = all, below = all;
    least.quadratic_frac_bits = 2 * sub;
    below.quadratic_frac_bits = 2 * sub - 1;
    std::size_t lost = 0;
    for (const auto& info : golden::stress_families()) {
      std::vector<SnappedQuad> quads;
      for (const WindowQuad& given : golden::make_stress(info.family, 40, 9, 1.0, 64, 64, 4))
        if (const SnappedQuad q = snap_quad(given, all, state); has_ordinary_vertices(q, all)) quads.push_back(q);
      const auto fragments = [&](const Config& c) {
        std::vector<Fragment> out;
        UntimedModel model(c, state, PixelEngine::lanes);
        for (const SnappedQuad& q : quads)
          model.draw(q, [&](std::span<const Fragment> f) { out.insert(out.end(), f.begin(), f.end()); });
        return out;
      };
      const std::vector<Fragment> drawn = fragments(all);
      EXPECT_EQ(fragments(least), drawn) << info.name << ", subpixel_bits " << sub;
      const std::vector<Fragment> other = fragments(below);
      for (std::size_t n = 0; n < std::min(drawn.size(), other.size()); ++n) lost += !(drawn[n] == other[n]);
      compared += drawn.size();
    }
    EXPECT_GT(lost, 100u) << "subpixel_bits " << sub;
  }
  EXPECT_GT(compared, 20'000u);
}

/// What is dropped counts from the tile's origin: never more than the way inside a tile, however far the quad's is.
TEST(DroppedBits, LossIsThatOfTheWayInsideATile) {
  golden::Prng rng(12);
  int homogeneous = 0, ordinary = 0, most = 0;
  for (const int quadratic : {20, 15, 8, 0}) {
    Config c;
    c.quadratic_frac_bits = quadratic;
    c.validate();
    const DrawState state = whole_viewport(c);
    const int drop = c.qdrop();
    const __int128 unit = __int128{1} << drop;
    const std::int64_t edge = std::int64_t{1} << (c.pos_int() + c.frac()), one = std::int64_t{1} << c.frac();
    for (int n = 0; n < 2000; ++n) {
      SnappedQuad q;
      for (SnappedVertex& v : q.vertex)  // ordinary by their w alone: beside the subpixel grid
        v = {static_cast<std::int32_t>(rng.integer(-edge, edge)),
             static_cast<std::int32_t>(rng.integer(-edge, edge)),
             static_cast<std::int32_t>(n % 2 == 0 ? one : rng.integer(-one, one)),
             {},
             {},
             {}};
      const SetupResult setup = quad_setup(q, c, state);
      const TilePixel at(setup, c, rng);
      const __int128 way = (unit - 1) * (1 + at.dx + at.row + at.dx * at.dx + at.row * at.row);
      ++(setup.homogeneous ? homogeneous : ordinary);
      const auto loss = [&](std::int64_t kept, std::size_t i, std::size_t j) {
        const __int128 lost = dot_at(q, i, j, at.x, at.y) - kept * unit;
        most = std::max(most, static_cast<int>(lost >> drop));
        return lost;
      };
      for (std::size_t i = 0; i < 4; ++i) {
        const __int128 lost = loss(at.trace.r2[i], i, i);
        ASSERT_TRUE(0 <= lost && lost <= way) << "r² " << i;
      }
      for (std::size_t k = 0; k < linear_count; ++k) {
        const __int128 lost = loss(at.trace.d[k], vertex_pair[k][0], vertex_pair[k][1]);
        if (setup.homogeneous)
          ASSERT_TRUE(0 <= lost && lost <= way) << "D " << k;
        else  // half of what two r² are low and a length is high, and of the sum's last bit
          ASSERT_TRUE(-(unit - 1) <= 2 * lost && 2 * lost <= 2 * way + unit) << "D " << k;
      }
    }
  }
  EXPECT_GT(homogeneous, 1'000);
  EXPECT_GT(ordinary, 1'000);
  EXPECT_GT(most, 20) << "the bound of 113 is not touched at all";
}

}  // namespace
}  // namespace quadrille
