// quad_setup, tile_walk, tile_context and stamp_coverage against the vertices themselves, in 128-bit integers: every
// form at every kind of pixel, expression (12) over the whole viewport, every pixel once.
#include "model/fast/float_lanes.hpp"
#include "model/front/coverage_test_support.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/stamp_coverage.hpp"
#include "model/support/lane_target.hpp"

#include <gtest/gtest.h>

#include <map>

namespace quadrille {
namespace {

struct Drawn {
  bool covered = false, front = false, tie = false;
};

/// Expression (12) with ties by (+eps, +eps^2), facing, visibility by determinants, cull mode.
Drawn brute_force(const SnappedQuad& q, const Config& c, Cull cull, int px, int py) {
  const Relative at(q, px, py), right(q, px + 1, py), down(q, px, py + 1);
  int s[5];
  Drawn out;
  for (std::size_t k = 0; k < 5; ++k) {
    const Wide e = at.cross(edges[k][0], edges[k][1]);
    s[k] = sign(e);
    if (e == 0) {
      s[k] = sign(right.cross(edges[k][0], edges[k][1]));
      if (s[k] == 0) s[k] = sign(down.cross(edges[k][0], edges[k][1]));
      if (s[k] != 0) out.tie = true;  // an all-zero edge decides nothing
    }
  }
  const bool always = !homogeneous(q, c) || hull_of(q);
  bool drawn[2] = {false, false};
  for (const int o : {1, -1}) {
    const auto is = [&](int k, int wanted) { return s[k] == wanted * o; };
    const bool first = is(4, 1) && is(0, 1) && is(1, 1) && (is(2, 1) || is(3, 1));
    const bool second = is(4, -1) && is(2, 1) && is(3, 1) && (is(0, 1) || is(1, 1));
    const bool seen =
        (first && (always || o * sign(det(q, 0, 1, 2)) > 0)) || (second && (always || o * sign(det(q, 0, 2, 3)) > 0));
    if (o == 1) {
      drawn[0] = seen && cull != Cull::back;
    } else {
      drawn[1] = seen && cull != Cull::front;
    }
  }
  out.covered = drawn[0] || drawn[1];
  out.front = drawn[1];
  return out;
}

Config small_config(int viewport_bits, int tile_log2) {
  Config c;
  c.viewport_bits = viewport_bits;
  c.tile_log2 = tile_log2;
  c.validate();
  return c;
}

struct Seen {
  int count = 0;
  bool front = false, tie = false;
};

/// Draws through the walk; ASSERTs that every ring entry holds the exact values at its tile.
void walk(const SnappedQuad& q, const Config& c, const DrawState& state, std::map<std::pair<int, int>, Seen>& seen,
          int& tiles) {
  const SetupResult setup = quad_setup(q, c, state);
  TileWalk w(c, state);
  ASSERT_EQ(w.state(), TileWalk::State::idle);
  w.take(setup);
  std::map<std::pair<int, int>, int> visited;
  for (int guard = 0; w.state() != TileWalk::State::end; ++guard) {
    ASSERT_LT(guard, 100000) << "the walk does not end";
    if (w.state() == TileWalk::State::tile && w.hit()) {
      const TileEntry e = w.entry();
      ASSERT_FALSE(e.end);
      const int edge = c.tile(), x0 = e.tile_x * edge, y0 = e.tile_y * edge;
      const int number = ++visited[{e.tile_x, e.tile_y}];
      ASSERT_EQ(number, 1) << "tile twice";
      ASSERT_GE(e.tile_x, setup.tile_x0);
      ASSERT_LT(e.tile_x, setup.tile_x0 + setup.tiles_x);
      ASSERT_GE(e.tile_y, setup.tile_y0);
      ASSERT_LT(e.tile_y, setup.tile_y0 + setup.tiles_y);
      const Relative at(q, x0, y0);
      for (std::size_t k = 0; k < 6; ++k) ASSERT_TRUE(e.linear[k] == at.cross(edges[k][0], edges[k][1]));
      for (std::size_t k = 0; k < 10; ++k) {
        const Wide dot = at.dot(k < 6 ? edges[k][0] : k - 6, k < 6 ? edges[k][1] : k - 6);
        ASSERT_TRUE(e.quadratic[k].value == (k < 6 && !setup.homogeneous ? 0 : dot));
      }
      visit(e, c, [&](const FieldType& type, int, auto v) { ASSERT_TRUE(holds(type, v)) << type.name; });
      for (int row = 0; row < edge; ++row) {
        const StampMasks m = stamp_coverage(e, w.constants(), row, c, state);
        ASSERT_EQ(m.front & ~m.mask, 0u);
        ASSERT_EQ(m.tie & ~m.mask, 0u);
        ASSERT_EQ(m.mask >> (edge - 1) >> 1, 0u);
        for (int dx = 0; dx < edge; ++dx)
          if (m.mask >> dx & 1) {
            Seen& s = seen[{x0 + dx, y0 + row}];
            ++s.count;
            s.front = m.front >> dx & 1;
            s.tie = m.tie >> dx & 1;
          }
      }
    }
    w.advance();
  }
  tiles += static_cast<int>(visited.size());
  ASSERT_TRUE(w.entry().end);
  w.advance();
  ASSERT_EQ(w.state(), TileWalk::State::idle);
}

TEST(TileWalk, CoversWhatExpressionTwelveCovers) {
  Prng rng(22);
  std::uint64_t covered = 0, ties = 0, fronts = 0, hulls = 0;
  int tiles_with = 0, tiles_without = 0;
  for (const auto& [vp, tile] : {std::array{6, 2}, {6, 3}, {6, 4}, {7, 2}}) {
    const Config c = small_config(vp, tile);
    const int span = 1 << vp;
    for (int n = 0; n < (vp == 6 ? 400 : 120) && !testing::Test::HasFailure(); ++n) {
      const auto kind = static_cast<Kind>(n % static_cast<int>(Kind::kinds));
      const SnappedQuad q = random_quad(rng, kind, c);
      DrawState state = state_of(c);
      state.cull = static_cast<Cull>(rng.below(3));
      if (rng.chance(0.3)) {
        state.scissor_x0 = static_cast<int>(rng.integer(0, span));
        state.scissor_x1 = static_cast<int>(rng.integer(0, span));
        state.scissor_y0 = static_cast<int>(rng.integer(0, span / 2));
        state.scissor_y1 = static_cast<int>(rng.integer(span / 2, span));
      }
      std::map<std::pair<int, int>, Seen> with, without;
      state.skip = 0;
      walk(q, c, state, without, tiles_without);
      state.skip = skip_tiles;
      walk(q, c, state, with, tiles_with);
      hulls += quad_setup(q, c, state).hull;
      for (int py = 0; py < span; ++py)
        for (int px = 0; px < span; ++px) {
          Drawn expected = brute_force(q, c, state.cull, px, py);
          if (px < state.scissor_x0 || px >= state.scissor_x1 || py < state.scissor_y0 || py >= state.scissor_y1)
            expected = {};
          for (const auto* seen : {&with, &without}) {
            const auto found = seen->find({px, py});
            ASSERT_EQ(found != seen->end(), expected.covered)
                << px << ", " << py << " of quad " << n << " kind " << static_cast<int>(kind);
            if (!expected.covered) continue;
            ASSERT_EQ(found->second.count, 1) << px << ", " << py;
            ASSERT_EQ(found->second.front, expected.front);
            ASSERT_EQ(found->second.tie, expected.tie);
          }
          covered += expected.covered;
          ties += expected.covered && expected.tie;
          fronts += expected.covered && expected.front;
        }
      for (const auto* seen : {&with, &without})
        for (const auto& [p, s] : *seen)
          ASSERT_TRUE(p.first >= 0 && p.first < span && p.second >= 0 && p.second < span);
    }
  }
  EXPECT_GT(covered, 100000u);
  EXPECT_GT(ties, 1000u);
  EXPECT_GT(fronts, 10000u);
  EXPECT_LT(fronts, covered);
  EXPECT_GT(hulls, 10u);
  EXPECT_LT(tiles_with, tiles_without);
}

/// Triangles whose determinant is one unit, the smallest there is: corners at the unit vectors of (X, Y, W), their
/// opposites and twice them.
TEST(TileWalk, TheSmallestTrianglesAreDrawn) {
  const Config c = small_config(6, 2);
  DrawState state = state_of(c);
  state.scissor_x1 = state.scissor_y1 = 6;
  std::uint64_t covered = 0, smallest = 0;
  int tiles = 0;
  std::vector<SnappedVertex> vertices(9);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::int32_t value = i % 3 == 0 ? 1 : i % 3 == 1 ? -1 : 2;
    (i < 3 ? vertices[i].x : i < 6 ? vertices[i].y : vertices[i].w) = value;
  }
  for (std::size_t n = 0; n < 9 * 9 * 9 * 9 && !testing::Test::HasFailure(); ++n) {
    SnappedQuad q;
    q.vertex = {vertices[n % 9], vertices[n / 9 % 9], vertices[n / 81 % 9], vertices[n / 729]};
    std::map<std::pair<int, int>, Seen> seen;
    walk(q, c, state, seen, tiles);
    const std::uint64_t before = covered;
    for (int py = 0; py < state.scissor_y1; ++py)
      for (int px = 0; px < state.scissor_x1; ++px) {
        const Drawn expected = brute_force(q, c, Cull::none, px, py);
        const auto found = seen.find({px, py});
        ASSERT_EQ(found != seen.end(), expected.covered) << px << ", " << py << " of quad " << n;
        if (!expected.covered) continue;
        ASSERT_EQ(found->second.front, expected.front) << px << ", " << py << " of quad " << n;
        ++covered;
      }
    smallest += covered != before;
  }
  EXPECT_GT(smallest, 100u);
}

/// may_cover is never false for a square with a drawn pixel, and stays useful: a square far outside is refused.
TEST(TileWalk, MayCoverIsConservative) {
  Prng rng(23);
  const Config c = small_config(6, 2);
  int refused = 0;
  for (int n = 0; n < 3000; ++n) {
    const SnappedQuad q = random_quad(rng, static_cast<Kind>(n % static_cast<int>(Kind::kinds)), c);
    DrawState state = state_of(c);
    const SetupResult setup = quad_setup(q, c, state);
    const QuadConstants constants(setup);
    WalkState at;
    for (std::size_t k = 0; k < linear_count; ++k) at.linear[k] = setup.linear[k].value;
    const int dx = static_cast<int>(rng.integer(0, 15)), dy = static_cast<int>(rng.integer(0, 15)),
              extent = rng.chance(0.5) ? 4 : 32;
    walk_step(at, constants, dx, dy);
    const auto cull = static_cast<Cull>(rng.below(3));
    if (Squares(constants, extent, cull).may_cover(at)) continue;
    ++refused;
    for (int y = 0; y < extent; ++y)
      for (int x = 0; x < extent; ++x)
        ASSERT_FALSE(brute_force(q, c, cull, setup.tile_x0 * 4 + dx + x, setup.tile_y0 * 4 + dy + y).covered);
  }
  EXPECT_GT(refused, 500);
}

/// All squares of a group at once are what they are one by one, by whatever instructions.
TEST(TileWalk, GroupsOfSquares) {
  Prng rng(24);
  const Config c = small_config(6, 2);
  const DrawState state = state_of(c);
  const LaneTarget before = lane_target();
  int mixed = 0;
  for (int n = 0; n < 1000; ++n) {
    const QuadConstants constants(
        quad_setup(random_quad(rng, static_cast<Kind>(n % static_cast<int>(Kind::kinds)), c), c, state));
    const int extent = rng.chance(0.5) ? 1 : 4, rows = static_cast<int>(rng.integer(1, 8));
    const auto cull = static_cast<Cull>(rng.below(3));
    const Squares squares(constants, extent, cull);
    WalkState first;
    for (std::size_t k = 0; k < linear_count; ++k) first.linear[k] = rng.integer(-40000, 40000);
    std::uint64_t expected = 0;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < 8; ++column) {
        WalkState at = first;
        walk_step(at, constants, column * extent, row * extent);
        expected |= std::uint64_t{squares.may_cover(at)} << (8 * row + column);
      }
    const std::uint64_t within = ~std::uint64_t{0} >> (64 - 8 * rows);
    mixed += expected != 0 && expected != within;
    ASSERT_EQ(squares.may_cover(first, rows) & within, expected);
    for (const LaneTarget target : lane_targets())
      if (can_run(target)) {
        set_lane_target(target);
        ASSERT_EQ(squares.may_cover(first, rows, FloatLanes::place_signs) & within, expected) << name(target);
      }
  }
  set_lane_target(before);
  EXPECT_GT(mixed, 200);
}

}  // namespace
}  // namespace quadrille
