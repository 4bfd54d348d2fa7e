// quad_setup, tile_walk, tile_context and stamp_coverage against the vertices themselves, in 128-bit integers: every
// form at every kind of pixel, expression (12) over the whole viewport, every pixel once.
#include "model/front/quad_setup.hpp"
#include "model/front/stamp_coverage.hpp"
#include "model/front/tile_context.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/port/boundaries.hpp"

#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace quadrille {
namespace {

using golden::Prng;
using Wide = __int128;

constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}, {1, 3}};

/// S_i = V_i - W_i p.
struct Relative {
  Wide x[4], y[4];
  Relative(const SnappedQuad& q, int px, int py) {
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = q.vertex[i].x - static_cast<Wide>(q.vertex[i].w) * px;
      y[i] = q.vertex[i].y - static_cast<Wide>(q.vertex[i].w) * py;
    }
  }
  Wide cross(std::size_t i, std::size_t j) const { return x[i] * y[j] - y[i] * x[j]; }
  Wide dot(std::size_t i, std::size_t j) const { return x[i] * x[j] + y[i] * y[j]; }
};

int sign(Wide v) { return (v > 0) - (v < 0); }

Wide det(const SnappedQuad& q, std::size_t a, std::size_t b, std::size_t c) {
  const auto& A = q.vertex[a];
  const auto& B = q.vertex[b];
  const auto& C = q.vertex[c];
  return static_cast<Wide>(A.x) * (static_cast<Wide>(B.y) * C.w - static_cast<Wide>(B.w) * C.y) +
         static_cast<Wide>(A.y) * (static_cast<Wide>(B.w) * C.x - static_cast<Wide>(B.x) * C.w) +
         static_cast<Wide>(A.w) * (static_cast<Wide>(B.x) * C.y - static_cast<Wide>(B.y) * C.x);
}

bool hull_of(const SnappedQuad& q) {
  const int s[4] = {sign(det(q, 1, 2, 3)), -sign(det(q, 0, 2, 3)), sign(det(q, 0, 1, 3)), -sign(det(q, 0, 1, 2))};
  return !(std::ranges::count(s, 1) > 0 && std::ranges::count(s, -1) > 0);
}

bool homogeneous(const SnappedQuad& q, const Config& c) {
  return std::ranges::any_of(q.vertex, [&](const SnappedVertex& v) { return v.w != 1 << c.frac(); });
}

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

enum class Kind { ordinary, grid, collapsed, sliver, homogeneous, small_integers, antipodal, mixed, kinds };

SnappedQuad random_quad(Prng& rng, Kind kind, const Config& c) {
  SnappedQuad q;
  const int one = 1 << c.frac(), span = 1 << c.viewport_bits;
  const std::int64_t limit = std::int64_t{1} << (c.pos_int() + c.frac());
  const auto px = [&](double v) {
    return static_cast<std::int32_t>(std::floor(v * (1 << c.subpixel_bits))) * (1 << c.homogeneous_frac_bits);
  };
  const auto ordinary = [&](SnappedVertex& v, double reach) {
    v = {px(rng.uniform(-reach, span + reach)), px(rng.uniform(-reach, span + reach)), one, {}, {}, {}};
  };
  const auto full = [&](SnappedVertex& v) {
    do {
      // Mostly a point near the viewport scaled by W, sometimes anything.
      v.w = static_cast<std::int32_t>(rng.chance(0.15) ? 0 : rng.integer(-one, one));
      if (rng.chance(0.5)) {
        v.x = static_cast<std::int32_t>(rng.integer(-span, 2 * span) * v.w + rng.integer(-one, one));
        v.y = static_cast<std::int32_t>(rng.integer(-span, 2 * span) * v.w + rng.integer(-one, one));
      } else {
        v.x = static_cast<std::int32_t>(rng.integer(-limit, limit) >> rng.below(12));
        v.y = static_cast<std::int32_t>(rng.integer(-limit, limit) >> rng.below(12));
      }
      if (rng.chance(0.05)) v.x = static_cast<std::int32_t>(rng.chance(0.5) ? limit : -limit);
      if (rng.chance(0.05)) v.y = static_cast<std::int32_t>(rng.chance(0.5) ? limit : -limit);
      v.x = static_cast<std::int32_t>(std::clamp<std::int64_t>(v.x, -limit, limit));
      v.y = static_cast<std::int32_t>(std::clamp<std::int64_t>(v.y, -limit, limit));
    } while (v.x == 0 && v.y == 0 && v.w == 0);
  };
  for (SnappedVertex& v : q.vertex) {
    switch (kind) {
      case Kind::ordinary:
      case Kind::collapsed:
      case Kind::sliver:
        ordinary(v, rng.chance(0.2) ? ((1 << c.guard_bits) - 1.0) * span : span / 4.0);
        break;
      case Kind::grid:
        v = {static_cast<std::int32_t>(rng.integer(-4, span + 4)) * one,
             static_cast<std::int32_t>(rng.integer(-4, span + 4)) * one,
             one,
             {},
             {},
             {}};
        break;
      case Kind::small_integers:
        do {
          v.w = static_cast<std::int32_t>(rng.integer(-1, 1)) * one;
          v.x = static_cast<std::int32_t>(rng.integer(-8, 8)) * one;
          v.y = static_cast<std::int32_t>(rng.integer(-8, 8)) * one;
        } while (v.x == 0 && v.y == 0 && v.w == 0);
        break;
      case Kind::mixed:
        if (rng.chance(0.7)) {
          ordinary(v, span / 2.0);
          break;
        }
        full(v);
        break;
      default:
        full(v);
    }
  }
  if (kind == Kind::collapsed) q.vertex[rng.below(4)] = q.vertex[rng.below(4)];
  if (kind == Kind::sliver) {
    const std::size_t i = rng.below(4);
    q.vertex[i] = q.vertex[(i + 1) & 3];
    q.vertex[i].y += 1 << c.homogeneous_frac_bits;
  }
  if (kind == Kind::antipodal) {
    const std::size_t i = rng.below(4);
    q.vertex[i] = q.vertex[(i + 1) & 3];
    q.vertex[i].x = -q.vertex[i].x, q.vertex[i].y = -q.vertex[i].y, q.vertex[i].w = -q.vertex[i].w;
  }
  return q;
}

Config small_config(int viewport_bits, int tile_log2) {
  Config c;
  c.viewport_bits = viewport_bits;
  c.tile_log2 = tile_log2;
  c.validate();
  return c;
}

DrawState state_of(const Config& c) {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = 1 << c.viewport_bits;
  return s;
}

/// A value of `width` bits, signed.
bool fits(std::int64_t v, int width) {
  return width >= 64 || (v >= -(std::int64_t{1} << (width - 1)) && v < std::int64_t{1} << (width - 1));
}

/// A field of a boundary holds the value.
template <class T>
bool holds(const FieldType& type, T value) {
  const auto v = static_cast<std::int64_t>(value);
  if (type.is_signed) return fits(v, type.width);
  return type.width == 64 || static_cast<std::uint64_t>(v) >> type.width == 0;
}

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
  std::uint64_t covered = 0, ties = 0, checked = 0, fronts = 0, hulls = 0;
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
          ++checked;
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
    if (may_cover(at, constants, extent, cull)) continue;
    ++refused;
    for (int y = 0; y < extent; ++y)
      for (int x = 0; x < extent; ++x)
        ASSERT_FALSE(brute_force(q, c, cull, setup.tile_x0 * 4 + dx + x, setup.tile_y0 * 4 + dy + y).covered);
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace quadrille
