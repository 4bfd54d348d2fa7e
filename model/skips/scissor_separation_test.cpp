// Homogeneous quads that miss the scissor: none that is left out has a pixel in it, by drawing it anyway and by a
// second opinion on coverage, and hardly any is kept.
#include "golden/reference/exact_coverage.hpp"
#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"
#include "model/clocked.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_walk.hpp"
#include "model/port/snap.hpp"
#include "model/skips/both_ways_test_support.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

constexpr auto outside = static_cast<std::size_t>(QuadReject::outside);

bool any_pixel(const SnappedQuad& quad, const DrawState& state) {
  for (int y = state.scissor_y0; y < state.scissor_y1; ++y)
    for (int x = state.scissor_x0; x < state.scissor_x1; ++x) {
      const golden::ExactCoverage at = golden::exact_coverage(quad, x, y);
      if (at.covered && at.visible) return true;
    }
  return false;
}

/// The same points with W = ONE/2 at two of them: as a quad comes whose others are out of the guard band.
void make_homogeneous(SnappedQuad& quad) {
  for (const std::size_t i : {1, 3}) {
    SnappedVertex& v = quad.vertex[i];
    v.x /= 2;
    v.y /= 2;
    v.w /= 2;
    v.z.exp -= 1;
  }
}

/// Rectangles beside the scissor that reach over each of its borders by quarters of a pixel, or not: those that reach a
/// pixel's centre are drawn.
TEST(ScissorSeparation, ReachesTheFirstAndTheLastPixel) {
  const Config c;
  DrawState state;
  state.width = state.height = 64;
  state.scissor_x0 = 9;
  state.scissor_x1 = 41;
  state.scissor_y0 = 6;
  state.scissor_y1 = 38;
  state.attributes = 0;
  BothWays both(c, state, skip_walk);
  for (const bool along_y : {false, true})
    for (const bool far : {false, true})
      for (int quarters = -6; quarters <= 6; ++quarters) {
        // From the centre of the first or last pixel, outward where negative.
        const double low = along_y ? state.scissor_y0 : state.scissor_x0, high = low + 32, reach = quarters * 0.25;
        const double from = far ? high - 0.5 - reach : low - 20, to = far ? high + 20 : low + 0.5 + reach;
        WindowQuad quad;
        for (std::size_t i = 0; i < 4; ++i) {
          WindowVertex& v = quad.vertex[i];
          v = {i == 1 || i == 2 ? to : from, i >= 2 ? 60.0 : 1.0, 0.5, 1};
          if (along_y) std::swap(v.x, v.y);
        }
        SnappedQuad snapped = snap_quad(quad, c, state);
        make_homogeneous(snapped);
        const std::size_t fragments = both.draw(snapped);
        const double pixels = far ? std::floor(reach) + 1 : std::ceil(reach);  // left and top edges belong to a quad
        EXPECT_EQ(fragments, static_cast<std::size_t>(32 * std::max(0.0, pixels)))
            << (along_y ? "y" : "x") << (far ? ", far, " : ", near, ") << reach;
      }
  EXPECT_EQ(both.rejected()[outside], 2u * (6 + 3));  // beyond the far border a pixel more counts as inside
}

/// One in `stride` of the quads of a small grid, with scissors whose borders lie on the grid's points and between them.
void grid(std::uint64_t stride) {
  const Config c = tiny();
  const std::vector<SnappedVertex> vertices = grid_vertices(c);
  const std::uint64_t n = vertices.size();
  RejectCounts total{};
  std::uint64_t missing = 0, kept = 0;
  constexpr std::array<std::array<int, 4>, 5> scissors{
      {{0, 0, 6, 6}, {1, 1, 4, 3}, {2, 0, 3, 2}, {4, 3, 6, 6}, {5, 5, 6, 6}}};
  for (std::size_t s = 0; s < scissors.size(); ++s) {
    DrawState state;
    state.width = state.height = 6;
    state.scissor_x0 = scissors[s][0];
    state.scissor_y0 = scissors[s][1];
    state.scissor_x1 = scissors[s][2];
    state.scissor_y1 = scissors[s][3];
    state.attributes = 0;
    state.cull = static_cast<Cull>(s % 3);
    state.skip = skip_tiles;
    BothWays both(c, state, skip_walk);
    state.skip |= skip_walk;
    for (std::uint64_t i = s; i < n * n * n * n && !testing::Test::HasFailure(); i += stride) {
      const SnappedQuad q = grid_quad(vertices, i);
      const std::size_t fragments = both.draw(q);
      const bool left_out = quad_reject(q, c, state) == QuadReject::outside;
      if (left_out && state.cull == Cull::none) {
        EXPECT_FALSE(any_pixel(q, state)) << "quad " << i << " of scissor " << s;
      }
      if (is_ordinary(q, c) || quad_setup(q, c, state).hull) continue;
      missing += fragments == 0;
      kept += fragments == 0 && !left_out;
    }
    add(total, both.rejected());
  }
  print("grid", total);
  std::printf("%llu homogeneous quads have no fragment, of these %llu are kept\n",
              static_cast<unsigned long long>(missing), static_cast<unsigned long long>(kept));
  EXPECT_GT(total[outside], 1000u);
  EXPECT_GT(total[0], 1000u);
}

TEST(ScissorSeparation, SomeOfASmallGrid) { grid(203); }
TEST(ScissorSeparation, AllOfASmallGrid) { grid(1); }

/// Families in draw states at random, in two sizes of the viewport.
TEST(ScissorSeparation, FamiliesKeepTheirFragments) {
  RejectCounts total{};
  std::uint64_t fragments = 0;
  for (const golden::StressFamilyInfo& info : golden::stress_families())
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      Config c;
      c.set("viewport_bits", 8);
      const int size = seed % 2 == 0 ? 64 : 90;
      const std::vector<WindowQuad> quads = golden::make_stress(info.family, 40, seed, 1.0, size, size, 4);
      DrawState state = golden::random_draw_state(c, size, size, quads, seed);
      // A corner of the screen, so that many quads miss it.
      state.scissor_x0 = static_cast<int>(seed) * 12;
      state.scissor_x1 = state.scissor_x0 + 9;
      BothWays both(c, state, skip_walk);
      for (const WindowQuad& q : quads) fragments += both.draw(snap_quad(q, c, state));
      add(total, both.rejected());
    }
  print("families", total);
  EXPECT_GT(fragments, 20'000u);
  EXPECT_GT(total[outside], 100u);
}

/// Scissors of which the quad's pixels, found by the second opinion, are in the first or last column or row alone; and
/// beside each one that has none of them, a pixel further or, since x1 and y1 count as inside, two.
TEST(ScissorSeparation, PixelsInTheOutermostColumnOrRowAlone) {
  constexpr int size = 16;
  constexpr std::array<const char*, 4> sides{"first column", "last column", "first row", "last row"};
  const Config c = tiny();
  const int one = 1 << c.frac();
  DrawState screen;
  screen.width = screen.height = screen.scissor_x1 = screen.scissor_y1 = size;
  screen.attributes = 0;
  screen.depth = false;  // so that no pixel is discarded
  screen.skip = skip_tiles;
  Prng rng(3);
  std::array<int, 4> touching{}, left_out_beyond{};
  for (int n = 0; n < 400 && !HasFailure(); ++n) {
    SnappedQuad q;
    for (SnappedVertex& v : q.vertex) {
      const double w = rng.uniform(0.5, 2) * (rng.chance(0.25) ? -1 : 1);
      v.x = static_cast<std::int32_t>(rng.uniform(-4, size + 4) * w * one);
      v.y = static_cast<std::int32_t>(rng.uniform(-4, size + 4) * w * one);
      v.w = static_cast<std::int32_t>(w * one);
      v.k = {false, 0, 1u << (c.significand_bits - 1)};
      v.z = {false, -1, 1u << (c.significand_bits - 1)};  // Z = 1/2
    }
    if (is_ordinary(q, c) || quad_setup(q, c, screen).hull) continue;
    int x0 = size, x1 = 0, y0 = size, y1 = 0;  // half-open
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const golden::ExactCoverage at = golden::exact_coverage(q, x, y);
        if (!at.covered || !at.visible) continue;
        x0 = std::min(x0, x), x1 = std::max(x1, x + 1), y0 = std::min(y0, y), y1 = std::max(y1, y + 1);
      }
    if (x0 >= x1) continue;
    const auto draw = [&](std::size_t side, int border) {
      DrawState state = screen;
      (side == 0   ? state.scissor_x0
       : side == 1 ? state.scissor_x1
       : side == 2 ? state.scissor_y0
                   : state.scissor_y1) = border;
      BothWays both(c, state, skip_walk);
      const std::size_t fragments = both.draw(q);
      state.skip |= skip_walk;
      return std::pair(fragments, quad_reject(q, c, state) == QuadReject::outside);
    };
    const std::array<int, 4> border{x1 - 1, x0 + 1, y1 - 1, y0 + 1};
    for (std::size_t side = 0; side < 4; ++side) {
      const bool low = side % 2 == 0;
      const int beyond = border[side] + (low ? 1 : -2);
      if (beyond == (low ? size : -1)) continue;  // the screen's last: the quad may go on behind it
      const auto [fragments, left_out] = draw(side, border[side]);
      EXPECT_GT(fragments, 0u) << sides[side] << " of quad " << n;
      EXPECT_FALSE(left_out) << sides[side] << " of quad " << n;
      ++touching[side];
      const auto [fragments_beyond, left_out_of_it] = draw(side, beyond);
      EXPECT_EQ(fragments_beyond, 0u) << "beyond the " << sides[side] << " of quad " << n;
      left_out_beyond[side] += left_out_of_it;
    }
  }
  for (std::size_t side = 0; side < 4; ++side) {
    std::printf("%s: %d quads drawn; further on %d of them left out\n", sides[side], touching[side],
                left_out_beyond[side]);
    EXPECT_GT(touching[side], 100) << sides[side];
    EXPECT_GT(left_out_beyond[side], 50) << sides[side];
  }
}

}  // namespace
}  // namespace quadrille
