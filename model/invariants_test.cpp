// Invariants of the untimed model as properties: RapidCheck draws the cases and shrinks what fails, and a failing case
// prints as one command line that draws it. For each invariant the comment above it says whether it holds bit by bit or
// within a bound, and why.
//
// RC_PARAMS (RapidCheck's own variable) sets the number of cases and the seed: "max_success=100000 seed=7".
#include "model/invariants_test_support.hpp"

namespace quadrille {
namespace {

/// Without RC_PARAMS: what --full runs. RapidCheck would take its seed from the clock.
const int usual_parameters = setenv("RC_PARAMS", "seed=14 max_success=3000", 0);

/// Each weight from 0, exactly (M and k have no sign; vertex 0's is 1 less the others' sum), to 1 within the bound.
/// Their sum is 1 within one bound, not four: M, denominator and reciprocal are the same in all of them. What is left
/// in units of 2^-s: the truncation of three numerators (-2, 0], of vertex 0's [0, 2) and of its aligned terms [0, 1)
/// (G = 2).
TEST(Invariants, WeightsSumToOne) {
  std::uint64_t seen = 0;
  check("weights sum to one and are none of them negative", 10'000, seen, [&] {
    const Case c = *any_cases();
    for (const Fragment& f : draw(c.machine, c.quad(), draw_state())) {
      ++seen;
      double sum = 0;
      for (std::size_t i = 0; i < weight_slots; ++i) {
        const double weight = value(f, i, c.machine);
        RC_ASSERT(weight >= (i == 0 ? -bound(c.machine) : 0));
        RC_ASSERT(weight <= 1 + bound(c.machine));
        sum += weight;
      }
      RC_ASSERT(std::fabs(sum - 1) <= bound(c.machine));
    }
  });
}

/// sum(lambda' x~_i) / sum(lambda' w_i) is the pixel's own x, and so with y: the attributes x~, y~ and w, relative to
/// the pixel's centre. Within the bound of the three attributes (2^-(s-3) sum |a_i|, and half an output code), for
/// snapping moves none of these corners and rounds none of these attributes. w = 0 and w < 0 are no exception.
TEST(Invariants, LinearPrecision) {
  std::uint64_t seen = 0;
  check("positions are reproduced", 10'000, seen, [&] {
    const Case c = *exact_cases();
    WindowQuad quad = c.quad();
    constexpr double scale = 0x1p-5;  // |x~| up to 36 px times w up to 4, below the format's 8
    double sum_x = 0, sum_y = 0, sum_w = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex& v = quad.vertex[i];
      const double x = scale * (v.x - v.w / 2), y = scale * (v.y - v.w / 2), w = v.w;
      quad.attribute[i][4] = x, quad.attribute[i][5] = y, quad.attribute[i][6] = w;
      sum_x += std::fabs(x), sum_y += std::fabs(y), sum_w += std::fabs(w);
    }
    DrawState state = draw_state();
    state.depth = false;
    for (const Fragment& f : draw(c.machine, quad, state)) {
      if ((f.flags & flag_two_corner) != 0) continue;  // 1/2 each by definition: not on the surface if their w differ
      ++seen;
      const double x = value(f, 4, c.machine), y = value(f, 5, c.machine), w = value(f, 6, c.machine);
      const auto tolerance = [&](double sum) { return bound(c.machine) * sum + unit(c.machine); };
      RC_ASSERT(std::fabs(x - scale * f.x * w) <= tolerance(sum_x) + scale * f.x * tolerance(sum_w));
      RC_ASSERT(std::fabs(y - scale * f.y * w) <= tolerance(sum_y) + scale * f.y * tolerance(sum_w));
    }
  });
}

/// At a corner its weight is 1 and the others are 0, the attribute and window z are the corner's: bits, since M is 1
/// and 0 there and the reciprocal of a power of two is exact. Of two corners at a pixel: 1/2 each, bits too (their k
/// are powers of two).
TEST(Invariants, LagrangeProperty) {
  std::uint64_t seen = 0;
  check("a corner's own values at a corner", 100, seen, [&] {
    Case c = *exact_cases();
    for (Corner& v : c.corner)
      if (v.side != 0) v.x = v.x / subpixels * subpixels, v.y = v.y / subpixels * subpixels;
    const auto one = std::int64_t{1} << c.machine.config().attribute_frac();
    for (const Fragment& f : draw(c.machine, c.quad(), draw_state())) {
      if ((f.flags & (flag_on_vertex | flag_two_corner)) == 0) continue;
      ++seen;
      std::vector<std::size_t> corners;
      for (std::size_t i = 0; i < 4; ++i)
        if (c.corner[i].side != 0 && c.corner[i].x == f.x * subpixels && c.corner[i].y == f.y * subpixels)
          corners.push_back(i);
      RC_ASSERT(corners.size() >= 1u);
      RC_ASSERT((corners.size() == 1) == ((f.flags & flag_on_vertex) != 0));
      corners.resize(std::min<std::size_t>(corners.size(), 2));
      for (std::size_t i = 0; i < 4; ++i) {
        const bool own = std::ranges::find(corners, i) != corners.end();
        RC_ASSERT(f.attribute[i] == (own ? one / static_cast<std::int64_t>(corners.size()) : 0));
      }
      if (corners.size() != 1) continue;
      const Corner& at = c.corner[corners[0]];
      RC_ASSERT(f.attribute[4] == at.a * (one / 64));
      RC_ASSERT(f.depth == static_cast<std::uint32_t>(at.z) << (c.machine.config().depth_bits - 4));
    }
  });
}

/// Edge functions, dot products and squared distances of one edge's pixels.
struct EdgeValues {
  std::int64_t area, dot, first, second;
};

std::map<std::pair<int, int>, EdgeValues> edge_values(const SnappedQuad& quad, std::size_t edge, bool turned,
                                                      const Config& config, DrawState state) {
  state.skip = 0;  // every tile of the bounding box
  std::map<std::pair<int, int>, EdgeValues> values;
  TileWalk walk(config, state);
  walk_tiles(walk, quad_setup(quad, config, state), [&](const TileEntry& tile) {
    for (int row = 0; row < config.tile(); ++row)
      for (int dx = 0; dx < config.tile(); ++dx) {
        PixelTrace p;
        forward_difference(p, tile, walk.constants(), dx, row);
        const std::size_t next = (edge + 1) & 3;
        values[{tile.tile_x * config.tile() + dx, tile.tile_y * config.tile() + row}] =
            turned ? EdgeValues{-p.a[edge], p.d[edge], p.r2[next], p.r2[edge]}
                   : EdgeValues{p.a[edge], p.d[edge], p.r2[edge], p.r2[next]};
      }
  });
  return values;
}

/// Two quads with a common edge, the corners in either order and at any place among the four: A (with its sign turned
/// where the order is), D and both r² of the edge are the same integers at every pixel that both look at, whatever the
/// other corners, the tiles' origins and the way to them are. Bits: sums of exact integers.
TEST(Invariants, EdgesAreTheSameFromBothSides) {
  std::uint64_t seen = 0;
  check("A, D and r² from both sides", 200, seen, [&] {
    const Case c = *any_cases(), other = *any_cases();
    const auto edge = static_cast<std::size_t>(pick(0, 3)), place = static_cast<std::size_t>(pick(0, 3));
    const bool turned = chance(50);
    RC_LOG() << "edge " << edge << " of the first quad is edge " << place << " of the second"
             << (turned ? ", turned\n" : "\n");
    const WindowQuad quad = c.quad();
    WindowQuad beside = other.quad();
    beside.vertex[place] = quad.vertex[turned ? (edge + 1) & 3 : edge];
    beside.vertex[(place + 1) & 3] = quad.vertex[turned ? edge : (edge + 1) & 3];
    const Config config = c.machine.config();
    const DrawState state = draw_state();
    const auto here = edge_values(snap_quad(quad, config, state), edge, false, config, state);
    const auto there = edge_values(snap_quad(beside, config, state), place, turned, config, state);
    bool common = false;
    for (const auto& [at, v] : here) {
      const auto found = there.find(at);
      if (found == there.end()) continue;
      common = true;
      const EdgeValues& w = found->second;
      RC_ASSERT(v.area == w.area);
      RC_ASSERT(v.dot == w.dot);
      RC_ASSERT(v.first == w.first);
      RC_ASSERT(v.second == w.second);
    }
    seen += common;
  });
}

/// On an edge an attribute is the perspective-correct interpolation between the edge's two corners, which depends on
/// nothing else: the weights of the other two are 0, bits (a factor of theirs is A; but vertex 0's, which is 1 less the
/// others' sum), and the attribute is within the bound of a value that is computed from the two corners alone. So the
/// two quads at the edge differ by two bounds at most, whichever of them draws the pixel. On two edges at once: the
/// mean.
TEST(Invariants, LinearOnEdges) {
  std::uint64_t seen = 0;
  check("linear interpolation on edges", 1000, seen, [&] {
    Case c{pick_corners(Kind::lattice), pick_machine()};
    if (chance(50))
      for (Corner& v : c.corner) v.side = chance(70) ? 1 : -1;
    Case other = c;  // beyond edge 0
    std::swap(other.corner[0], other.corner[1]);
    other.corner[2] = pick_corner(Kind::lattice), other.corner[3] = pick_corner(Kind::lattice);
    for (const Case& side : {c, other}) {
      RC_LOG() << side << "\n";
      for (const Fragment& f : draw(side.machine, side.quad(), draw_state())) {
        if ((f.flags & (flag_on_edge | flag_two_edge)) == 0) continue;
        ++seen;
        std::array<double, 4> expected{};
        int edges = 0;
        for (std::size_t e = 0; e < 4 && edges < 2; ++e) {
          const std::size_t next = (e + 1) & 3;
          const Corner &from = side.corner[e], &to = side.corner[next];
          const auto relative = [&](const Corner& v) {  // homogeneous, of a vertex of W = +-1
            return std::array<std::int64_t, 2>{v.side * (v.x - f.x * subpixels), v.side * (v.y - f.y * subpixels)};
          };
          const auto [ax, ay] = relative(from);
          const auto [bx, by] = relative(to);
          if (ax * by != ay * bx || ax * bx + ay * by >= 0) continue;
          ++edges;
          const double k_from = std::ldexp(1.0, -from.octave), k_to = std::ldexp(1.0, -to.octave);
          const double m_from = std::hypot(bx, by) * k_from, m_to = std::hypot(ax, ay) * k_to;
          expected[e] += m_from / (m_from + m_to);
          expected[next] += m_to / (m_from + m_to);
        }
        RC_ASSERT(edges == ((f.flags & flag_on_edge) != 0 ? 1 : 2));
        double attribute = 0, sum = 0;
        for (std::size_t i = 0; i < 4; ++i) {
          expected[i] /= edges;
          if (expected[i] == 0 && i != 0) RC_ASSERT(f.attribute[i] == 0);
          RC_ASSERT(std::fabs(value(f, i, side.machine) - expected[i]) <= bound(side.machine) + unit(side.machine));
          attribute += expected[i] * side.corner[i].a / 64.0;
          sum += std::abs(side.corner[i].a) / 64.0;
        }
        RC_ASSERT(std::fabs(value(f, 4, side.machine) - attribute) <= bound(side.machine) * sum + unit(side.machine));
      }
    }
  });
}

/// The corners from another first one, or in the opposite order: the same pixels with the same (opposite) facing and
/// the same flags, bits: the front is exact. Weights and attributes go with their corners, within two bounds, one of
/// either draw: which pair of a ratio's root is the near one changes with the order, and so do roundings. Exceptions:
/// the tie flag speaks of the diagonal too, which is another one after an odd shift; with the eye in the hull of the
/// corners, or on an edge or a diagonal (a corner opposite another as seen from it), the diagonal decides what is
/// covered, so only pixels of both are compared, and not their facing; on more than two edges at once (all corners on
/// one line) the two first ones count, so values depend on the first corner. Depth is off: its limits cut at values.
TEST(Invariants, AnyFirstCornerAndOrder) {
  std::uint64_t seen = 0;
  check("cyclic shifts and mirrored orders", 10'000, seen, [&] {
    const Case c = *any_cases();
    const auto shift = static_cast<std::size_t>(pick(0, 3));
    const bool mirrored = chance(50);
    RC_LOG() << "from corner " << shift << (mirrored ? ", mirrored\n" : "\n");
    const WindowQuad quad = c.quad();
    WindowQuad turned = quad;
    const auto source = [&](std::size_t i) { return ((mirrored ? 4 - i : i) + shift) & 3; };
    for (std::size_t i = 0; i < 4; ++i) {
      turned.vertex[i] = quad.vertex[source(i)];
      turned.attribute[i] = quad.attribute[source(i)];
    }
    DrawState state = draw_state();
    state.depth = false;
    const Config config = c.machine.config();
    const SnappedQuad snapped = snap_quad(quad, config, state);
    const auto opposite = [&](std::size_t i, std::size_t j) {
      using Wide = __int128;
      const SnappedVertex &a = snapped.vertex[i], &b = snapped.vertex[j];
      const Wide ax = a.x, ay = a.y, aw = a.w;
      return ax * b.y == ay * b.x && ax * b.w == aw * b.x && ay * b.w == aw * b.y && ax * b.x + ay * b.y + aw * b.w < 0;
    };
    bool diagonal_decides = quad_setup(snapped, config, state).hull;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) diagonal_decides = diagonal_decides || opposite(i, j);

    /// Edges with the pixel between their ends.
    const auto edges_at = [&](int x, int y) {
      int edges = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        using Wide = __int128;
        const SnappedVertex &a = snapped.vertex[i], &b = snapped.vertex[(i + 1) & 3];
        const Wide ax = a.x - Wide{a.w} * x, ay = a.y - Wide{a.w} * y, bx = b.x - Wide{b.w} * x,
                   by = b.y - Wide{b.w} * y;
        edges += ax * by == ay * bx && ax * bx + ay * by < 0;
      }
      return edges;
    };

    const std::vector<Fragment> before = draw(c.machine, quad, state), after = draw(c.machine, turned, state);
    if (!diagonal_decides) RC_ASSERT(before.size() == after.size());
    std::array<double, weight_slots + extra_slots> sum{};  // of attributes' magnitudes; 1 of a weight
    for (std::size_t slot = 0; slot < sum.size(); ++slot)
      for (const std::vector<double>& attribute : quad.attribute) sum[slot] += std::fabs(attribute[slot]);
    for (std::size_t m = 0, n = 0; m < before.size() && n < after.size();) {
      const Fragment &f = before[m], &g = after[n];
      if (const auto at = std::pair(f.y, f.x), other = std::pair(g.y, g.x); at != other) {
        RC_ASSERT(diagonal_decides);
        ++(at < other ? m : n);
        continue;
      }
      ++m, ++n, ++seen;
      if (!diagonal_decides) RC_ASSERT((f.front != g.front) == mirrored);
      RC_ASSERT(((f.flags ^ g.flags) & ~flag_tie) == 0);
      if ((f.flags & flag_two_edge) != 0 && edges_at(f.x, f.y) > 2) continue;
      for (std::size_t slot = 0; slot < sum.size(); ++slot) {
        const double error = std::fabs(value(f, slot, c.machine) - value(g, slot, c.machine));
        if (error > 2 * bound(c.machine) * sum[slot] + unit(c.machine))
          RC_FAIL("slot " + std::to_string(slot) + " differs by " + std::to_string(error / bound(c.machine)) +
                  " bounds at " + std::to_string(f.x) + ", " + std::to_string(f.y));
      }
    }
  });
}

/// Moved by whole pixels, the scissor with it: the same fragments at the moved places, bits. The front is exact, and
/// differences from a tile's origin are the same integers wherever the tiles begin. Of corners that are not ordinary
/// too, while X + W·dx is on the grid as it is here.
TEST(Invariants, TranslationByWholePixels) {
  std::uint64_t seen = 0;
  check("whole pixels aside", 10'000, seen, [&] {
    const Case c = *exact_cases();
    const int dx = pick(0, 60), dy = pick(0, 60);
    RC_LOG() << "by " << dx << ", " << dy << "\n";
    Corners moved = c.corner;
    for (Corner& v : moved)
      if (v.side != 0) v.x += dx * subpixels, v.y += dy * subpixels;
    DrawState state = draw_state(128);
    state.scissor_x1 = state.scissor_y1 = size;
    const std::vector<Fragment> before = draw(c.machine, c.quad(), state);
    state.scissor_x0 += dx, state.scissor_x1 += dx, state.scissor_y0 += dy, state.scissor_y1 += dy;
    std::vector<Fragment> after = draw(c.machine, quad_of(moved), state);
    for (Fragment& f : after) {
      f.x = static_cast<std::uint16_t>(f.x - dx);
      f.y = static_cast<std::uint16_t>(f.y - dy);
    }
    RC_ASSERT(difference(before, after) == "");
    seen += before.size();
  });
}

/// All homogeneous coordinates times a power of two: the same points, and the same fragments, bits; k and with it every
/// sum has another exponent, no other bit.
TEST(Invariants, HomogeneousScaling) {
  std::uint64_t seen = 0;
  check("coordinates times a power of two", 10'000, seen, [&] {
    const Case c = *any_cases();
    const int octaves = pick(-30, 30);
    RC_LOG() << "times 2^" << octaves << "\n";
    WindowQuad scaled = c.quad();
    for (WindowVertex& v : scaled.vertex)
      for (double* number : {&v.x, &v.y, &v.z, &v.w}) *number = std::ldexp(*number, octaves);
    const std::vector<Fragment> before = draw(c.machine, c.quad(), draw_state());
    RC_ASSERT(difference(before, draw(c.machine, scaled, draw_state())) == "");
    seen += before.size();
  });
}

/// Larger about the centre of pixel (0, 0): what (x, y) was is at the multiples, bits: all of A, D, r² and u take on
/// the same power of two, and every later number has another exponent alone. Twice as large makes that power even where
/// it meets a root, but not with a corner at infinity, whose coordinates at the port stay (k takes the factor): then
/// four times.
TEST(Invariants, ScreenScaling) {
  std::uint64_t seen = 0;
  check("twice or four times the size", 10'000, seen, [&] {
    const Case c = *exact_cases();
    const int factor = std::ranges::any_of(c.corner, [](const Corner& v) { return v.side == 0; }) ? 4 : 2;
    Corners larger = c.corner;
    for (Corner& v : larger) v.x *= factor, v.y *= factor;
    const std::vector<Fragment> before = draw(c.machine, c.quad(), draw_state());
    std::vector<Fragment> multiples;
    for (Fragment f : draw(c.machine, quad_of(larger), draw_state(factor * size))) {
      if (f.x % factor != 0 || f.y % factor != 0) continue;
      f.x = static_cast<std::uint16_t>(f.x / factor);
      f.y = static_cast<std::uint16_t>(f.y / factor);
      multiples.push_back(f);
    }
    RC_ASSERT(difference(before, multiples) == "");
    seen += before.size();
  });
}

/// The scissor cut in two, anywhere: the fragments of the parts are those of the whole, bits. Bounding box, first tile
/// and the walk's way differ, no pixel does.
TEST(Invariants, ScissorSplitting) {
  std::uint64_t seen = 0;
  check("a scissor cut in two", 5'000, seen, [&] {
    const Case c = *any_cases();
    DrawState whole = draw_state();
    whole.scissor_x0 = pick(0, size), whole.scissor_x1 = pick(whole.scissor_x0, size);
    whole.scissor_y0 = pick(0, size / 4), whole.scissor_y1 = pick(3 * size / 4, size);
    DrawState first = whole, second = whole;
    if (chance(50)) {
      first.scissor_x1 = second.scissor_x0 = pick(whole.scissor_x0, whole.scissor_x1);
    } else {
      first.scissor_y1 = second.scissor_y0 = pick(whole.scissor_y0, whole.scissor_y1);
    }
    RC_LOG() << "--scissor " << first.scissor_x0 << ',' << first.scissor_y0 << ',' << first.scissor_x1 << ','
             << first.scissor_y1 << " and " << second.scissor_x0 << ',' << second.scissor_y0 << ',' << second.scissor_x1
             << ',' << second.scissor_y1 << "\n";
    std::vector<Fragment> parts = draw(c.machine, c.quad(), first);
    std::ranges::copy(draw(c.machine, c.quad(), second), std::back_inserter(parts));
    std::ranges::sort(parts, {}, [](const Fragment& f) { return std::pair(f.y, f.x); });
    RC_ASSERT(difference(parts, draw(c.machine, c.quad(), whole)) == "");
    seen += parts.size();
  });
}

}  // namespace
}  // namespace quadrille
