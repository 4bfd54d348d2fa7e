#include "golden/scenes/stress.hpp"
#include "model/clocked.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/inside_expression.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_walk.hpp"
#include "model/port/snap.hpp"
#include "model/skips/both_ways_test_support.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

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
