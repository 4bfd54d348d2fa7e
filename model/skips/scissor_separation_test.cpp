// Homogeneous quads that miss the scissor: none that is left out has a pixel in it, by drawing it anyway and by a
// second opinion on coverage, and hardly any is kept.
#include "model/skips/scissor_separation.hpp"
#include "model/clocked.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/inside_expression.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_walk.hpp"
#include "model/port/snap.hpp"

#include "golden/reference/exact_coverage.hpp"
#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"
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

// ---- How much is left out ----------------------------------------------------------------------------------------

struct Point {
  double x, y, w;
};

/// The polygon's part in front of the eye meets the rectangle, in window coordinates: it is cut by the five planes.
bool meets(std::vector<Point> polygon, const DrawState& state) {
  const auto cut = [&](auto side) {
    std::vector<Point> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double at_a = side(a), at_b = side(b);
      if (at_a >= 0) kept.push_back(a);
      if ((at_a >= 0) == (at_b >= 0)) continue;
      const double t = at_a / (at_a - at_b);
      kept.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w)});
    }
    polygon = kept;
  };
  cut([](const Point& p) { return p.w; });
  cut([&](const Point& p) { return p.x - state.scissor_x0 * p.w; });
  cut([&](const Point& p) { return state.scissor_x1 * p.w - p.x; });
  cut([&](const Point& p) { return p.y - state.scissor_y0 * p.w; });
  cut([&](const Point& p) { return state.scissor_y1 * p.w - p.y; });
  return !polygon.empty();
}

double determinant(const Point& a, const Point& b, const Point& c) {
  return a.x * (b.y * c.w - b.w * c.y) - a.y * (b.x * c.w - b.w * c.x) + a.w * (b.x * c.y - b.y * c.x);
}

bool holds_eye(const std::array<Point, 4>& v) {
  const std::array<double, 4> d{determinant(v[1], v[2], v[3]), -determinant(v[0], v[2], v[3]),
                                determinant(v[0], v[1], v[3]), -determinant(v[0], v[1], v[2])};
  return std::ranges::all_of(d, [](double x) { return x > 0; }) ||
         std::ranges::all_of(d, [](double x) { return x < 0; });
}

/// Four points near the screen, some behind the eye.
std::array<Point, 4> near_the_screen(Prng& rng, double size) {
  std::array<Point, 4> v;
  const std::uint64_t behind = 1 + rng.below(14);
  const double reach = rng.chance(0.5) ? 0.3 : 3;
  for (std::size_t i = 0; i < 4; ++i) {
    const double w = rng.log2_spread(-2, 2) * ((behind >> i & 1) != 0 ? -1 : 1);
    v[i] = {rng.uniform(-reach, 1 + reach) * size * w, rng.uniform(-reach, 1 + reach) * size * w, w};
  }
  return v;
}

/// A plane quad around the eye, seen with a field of view of 90 degrees.
std::array<Point, 4> around_the_eye(Prng& rng, double size) {
  std::array<Point, 4> v;
  std::array<double, 3> centre, u, t;
  for (double& d : centre) d = rng.uniform(-2, 2);
  for (double& d : u) d = rng.uniform(-3, 3);
  for (double& d : t) d = rng.uniform(-3, 3);
  for (std::size_t i = 0; i < 4; ++i) {
    const double scale = rng.uniform(0.3, 1), along = i == 1 || i == 2 ? scale : -scale,
                 across = i >= 2 ? scale : -scale;
    std::array<double, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = centre[k] + along * u[k] + across * t[k];
    v[i] = {(p[0] + p[2]) * size / 2, (p[1] + p[2]) * size / 2, p[2]};
  }
  return v;
}

/// Clocks of the machine from a quad's last beat until it is idle.
int clocks_of(ClockedModel& machine, const SnappedQuad& quad) {
  ClockedInputs in;
  in.vertex_valid = in.fragment_ready = true;
  for (std::size_t i = 0; i < 4; ++i) {
    in.vertex = beat_of(quad, i);
    machine.clock(in);
  }
  in.vertex_valid = false;
  int clocks = 0;
  for (; machine.comb().busy; ++clocks) machine.clock(in);
  return clocks;
}

/// Eye-crossing quads at 4096 x 4096 that miss the scissor, half of them with the whole screen, half with a part of it.
void missing_quads(int count) {
  constexpr int size = 4096, most_clocks = 64;
  constexpr int setup_clocks = 31;  // of a homogeneous quad, from the last beat until the walk
  const Config c;
  Prng rng(1, 12);
  std::vector<int> beyond;
  int left_out = 0, most_left_out = 0;
  while (static_cast<int>(beyond.size()) < count) {
    const std::array<Point, 4> v = rng.chance(0.5) ? near_the_screen(rng, size) : around_the_eye(rng, size);
    DrawState state;
    state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
    state.attributes = 0;
    if (rng.chance(0.5)) {
      const auto range = [&](int& lo, int& hi) {
        const auto a = static_cast<int>(rng.below(size)), b = static_cast<int>(rng.below(size));
        lo = std::min(a, b);
        hi = std::max(a, b) + 1;
      };
      range(state.scissor_x0, state.scissor_x1);
      range(state.scissor_y0, state.scissor_y1);
    }
    const auto behind = std::ranges::count_if(v, [](const Point& p) { return p.w <= 0; });
    if (behind == 0 || behind == 4 || holds_eye(v)) continue;
    if (meets({v[0], v[1], v[2]}, state) || meets({v[0], v[2], v[3]}, state)) continue;
    WindowQuad quad;
    for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {v[i].x, v[i].y, 0, v[i].w};
    const SnappedQuad snapped = snap_quad(quad, c, state);
    ClockedModel machine(c, state);
    const int clocks = clocks_of(machine, snapped) - setup_clocks;
    beyond.push_back(clocks);
    if (quad_reject(snapped, c, state) == QuadReject::outside) {
      ++left_out;
      most_left_out = std::max(most_left_out, clocks);
    }
  }
  std::ranges::sort(beyond);
  const auto within = std::ranges::upper_bound(beyond, most_clocks) - beyond.begin();
  std::printf(
      "%d quads, %d left out; clocks beyond %d of setup: median %d, 99 %% %d, worst %d; within %d: %.2f %%; "
      "left out: %d at most\n",
      count, left_out, setup_clocks, beyond[beyond.size() / 2], beyond[beyond.size() * 99 / 100 - 1], beyond.back(),
      most_clocks, 100.0 * static_cast<double>(within) / count, most_left_out);
  EXPECT_GE(within * 100, 99 * count);
  EXPECT_LE(most_left_out, most_clocks);
}

TEST(ScissorSeparation, ThousandThatMiss) { missing_quads(1000); }
TEST(ScissorSeparation, TenThousandThatMiss) { missing_quads(10'000); }

/// A bent quad around the eye, which is often in its hull.
WindowQuad bent_around_the_eye(Prng& rng, double size) {
  std::array<std::array<double, 3>, 4> way;  // to the centre, along, across, the bend
  for (std::size_t n = 0; n < 4; ++n)
    for (double& d : way[n]) d = rng.uniform(-3, 3) / (n == 0 ? 3 : 1);
  WindowQuad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const double scale = rng.uniform(0.3, 1), along = i == 1 || i == 2 ? scale : -scale,
                 across = i >= 2 ? scale : -scale, bend = i % 2 != 0 ? 1 : -1;
    std::array<double, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = way[0][k] + along * way[1][k] + across * way[2][k] + bend * way[3][k];
    quad.vertex[i] = {(p[0] + p[2]) * size / 2, (p[1] + p[2]) * size / 2, 0, p[2]};
  }
  return quad;
}

/// What expression (12) can be over the whole scissor, by the signs that each edge function has at its corners.
bool signs_allow_a_pixel(const SetupResult& setup, const DrawState& state) {
  SignWords<std::uint32_t> signs[5];
  for (std::size_t k = 0; k < 5; ++k)
    for (const int x : {state.scissor_x0, state.scissor_x1 - 1})
      for (const int y : {state.scissor_y0, state.scissor_y1 - 1}) {
        const LinearForm& edge = setup.linear[k];
        const __int128 value =
            static_cast<__int128>(edge.value) + static_cast<__int128>(edge.gx) * x + static_cast<__int128>(edge.gy) * y;
        signs[k].positive |= value >= 0;
        signs[k].negative |= value <= 0;
      }
  const PlaceWords<std::uint32_t> inside = inside_expression(signs, setup.visible, state.cull);
  return (inside.back | inside.front) != 0;
}

/// Quads with the eye in their hull are walked in full. How many cover nothing, and how many of these the signs at the
/// scissor's corners would leave out; they never would one that covers a pixel. rtl/REJECTED.md has the
/// figures.
void quads_around_the_eye(int count) {
  constexpr int size = 4096;
  const Config c;
  Prng rng(1, 13);
  for (const bool stress : {true, false})
    for (const bool part : {false, true}) {
      const std::vector<WindowQuad> family =
          stress ? golden::make_stress(golden::StressFamily::eye_in_hull, static_cast<std::size_t>(count), part ? 2 : 1,
                                       1.0, size, size, 0)
                 : std::vector<WindowQuad>{};
      int quads = 0, nothing = 0, left_out = 0;
      for (std::size_t n = 0; stress ? n < family.size() : quads < count; ++n) {
        DrawState state;
        state.width = state.height = state.scissor_x1 = state.scissor_y1 = size;
        state.attributes = 0;
        const auto range = [&](int& lo, int& hi) {
          const auto a = static_cast<int>(rng.below(size)), b = static_cast<int>(rng.below(size));
          lo = std::min(a, b);
          hi = std::max(a, b) + 1;
        };
        if (part) {
          range(state.scissor_x0, state.scissor_x1);
          range(state.scissor_y0, state.scissor_y1);
        }
        const SnappedQuad quad = snap_quad(stress ? family[n] : bent_around_the_eye(rng, size), c, state);
        const SetupResult setup = quad_setup(quad, c, state);
        if (!setup.hull) continue;
        ++quads;
        struct Found {};
        bool covers = false;
        TileWalk walk(c, state);
        try {
          walk_tiles(walk, setup, [&](const TileEntry& tile) {
            for_each_covered_pixel(tile, walk.constants(), c, state, [](const CoveredPixel&) { throw Found{}; });
          });
        } catch (const Found&) {
          covers = true;
        }
        const bool allowed = signs_allow_a_pixel(setup, state);
        ASSERT_TRUE(allowed || !covers) << "quad " << n;
        nothing += !covers;
        left_out += !allowed;
      }
      std::printf("%s, %s: of %d quads with the eye in their hull %d cover nothing, %d would be left out\n",
                  stress ? "stress family" : "bent around the eye", part ? "a part of the screen" : "the whole screen",
                  quads, nothing, left_out);
      EXPECT_GE(quads, count * 9 / 10);
      EXPECT_TRUE(!part || left_out > 0);
    }
}

TEST(ScissorSeparation, AThousandAroundTheEye) { quads_around_the_eye(250); }
TEST(ScissorSeparation, TenThousandAroundTheEye) { quads_around_the_eye(2'500); }

}  // namespace
}  // namespace quadrille
