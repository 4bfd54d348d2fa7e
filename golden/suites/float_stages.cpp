#include "golden/suites/float_stages.hpp"

#include "golden/io/error.hpp"
#include "golden/suites/float_cover.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace quadrille::vectors::floating {
namespace {

/// A vertex of the suite `snapping` in Real. An ordinary one is its window position on the subpixel grid, to nearest:
/// half a step. Others are scaled by k = 1/max(|x|/2^pos_int, |y|/2^pos_int, |w|) and rounded on the 2^-frac grid.
/// Real's x - w/2 is off by 2^-64 of its terms.
struct RealVertex {
  Real x, y, w, error, k = 0;
  bool ordinary = false, decided = true, point = true;

  RealVertex(const WindowVertex& v, const Config& c)
      : x(static_cast<Real>(v.x) - static_cast<Real>(v.w) / 2),
        y(static_cast<Real>(v.y) - static_cast<Real>(v.w) / 2),
        w(v.w),
        error(rounding * (std::max(fabsl(v.x), fabsl(v.y)) + fabsl(w))) {
    const Real extent = std::max({ldexpl(fabsl(x), -c.pos_int()), ldexpl(fabsl(y), -c.pos_int()), fabsl(w)});
    point = extent != 0;
    if (w > 0) {
      // Rounding decides on which side of the guard band a position in its last half step is.
      const Real reach = std::max(fabsl(x), fabsl(y)) / w, edge = ldexpl(1, c.pos_int());
      const Real last = edge - ldexpl(1, -c.subpixel_bits - 1);
      decided = fabsl(reach - last) > error / w;
      ordinary = reach < last;
    }
    k = ordinary ? 1 / w : 1 / extent;
  }
};

/// Numbers of the port are rounded to nearest: half of u. Differences to a base lose 2^-64 of what they are taken of.
void snapping(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const auto slots = static_cast<std::size_t>(c.attribute_slots);
  bool refused = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex& v = t.in.vertex[i];
    const double extent = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.w)});
    refused = refused || !std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w) ||
              !(extent <= 0x1p80) || !(extent >= 0x1p-80) || !(std::fabs(v.z) <= 0x1p80) || !RealVertex(v, c).point;
    for (std::size_t j = 0; j < slots; ++j)
      refused = refused || !(std::fabs(t.in.attribute[i][j]) < std::ldexp(1.0, c.attribute_int_bits));
  }
  const auto check_refused = [&] {
    judge.same("refused", -1, t.out.refused, 1);
    judge.undecided();
  };
  if (refused) return check_refused();
  std::array<RealVertex, 4> vertices{RealVertex(t.in.vertex[0], c), RealVertex(t.in.vertex[1], c),
                                     RealVertex(t.in.vertex[2], c), RealVertex(t.in.vertex[3], c)};
  for (const RealVertex& v : vertices)
    if (!v.decided) return judge.undecided();

  const SnappedQuad& q = t.out.snapped;
  const Real half = ldexpl(1, -c.significand_bits) * (1 + rounding) + rounding;
  const auto too_large = ldexpl(1, 1 << (Config::port_exp_bits - 1)), too_small = 1 / too_large;
  // A number of the port: its value, and how far Real may be off.
  struct Number {
    Real value, doubt;
  };
  const auto k_of = [&](std::size_t i) {
    return Number{vertices[i].k, vertices[i].ordinary ? 0 : vertices[i].k * vertices[i].k * vertices[i].error};
  };
  const auto depth_of = [&](std::size_t i, Real base) {
    const RealVertex& v = vertices[i];
    const Real z = t.in.vertex[i].z, from = base * v.w, relative = v.ordinary ? 0 : v.k * v.error;
    return Number{v.k * (z - from), v.k * (fabsl(z) + fabsl(from)) * (rounding + relative)};
  };
  const auto attribute_of = [&](std::size_t i, std::size_t j, Real base) {
    const RealVertex& v = vertices[i];
    const Real a = t.in.attribute[i][j], relative = v.ordinary ? 0 : v.k * v.error;
    if (t.in.attribute[i][j] == t.in.attribute[0][j]) return Number{0, 0};
    if (!t.in.state.perspective) {
      const Real w = ldexpl(static_cast<Real>(q.vertex[i].w), -c.frac());
      return Number{w * (a - base), fabsl(w) * (fabsl(a) + fabsl(base)) * rounding};
    }
    return Number{v.k * (a - base), v.k * (fabsl(a) + fabsl(base)) * (rounding + relative)};
  };

  // Products with k that the port cannot hold are refused, those below its exponents are zero.
  for (std::size_t i = 0; i < 4; ++i) {
    // Bases lie in [0, 1] and within the attribute's format: of no weight beside numbers of this size.
    const Real largest = std::max(k_of(i).value, vertices[i].k * ldexpl(1, c.attribute_int_bits + 1));
    const Real z = fabsl(depth_of(i, 0).value) + vertices[i].k * fabsl(vertices[i].w);
    if (std::max(largest, z) * (1 + 2 * half) >= too_large) {
      if (k_of(i).value >= too_large) return check_refused();
      return judge.undecided();
    }
  }
  judge.same("refused", -1, t.out.refused, 0);
  if (t.out.refused) return;

  const auto number = [&](const char* name, int index, const PortNumber& actual, const Number& exact) {
    const Real tolerance = half * fabsl(exact.value) + 2 * exact.doubt;
    Span span{exact.value - tolerance, exact.value + tolerance};
    if (fabsl(exact.value) - tolerance < too_small) {
      // Zero, or what rounds up to the smallest exponent.
      if (fabsl(exact.value) + tolerance < too_small) span = {};
      span = {std::min(span.lo, 0.0L), std::max(span.hi, 0.0L)};
    }
    check_number(judge, name, index, actual, span, t.losses);
  };
  const auto within = [&](const char* name, int index, std::int64_t actual, Real exact, Real tolerance) {
    judge.within(name, index, static_cast<Real>(actual), exact - tolerance, exact + tolerance);
  };

  // Bases, half a code from what they are of.
  const Real top = ldexpl(1, c.attribute_int_bits + c.attribute_frac()) - 1;
  for (std::size_t j = 0; j < slots; ++j)
    within("base_attr", static_cast<int>(j), q.base.attribute[j],
           std::clamp(ldexpl(t.in.attribute[0][j], c.attribute_frac()), -top, top), 0.5L);
  const Real depth_one = ldexpl(1, c.depth_bits);
  const auto first = std::ranges::find_if(vertices, [](const RealVertex& v) { return v.w > 0; });
  const auto window_z = [&](std::size_t i) {
    const Real z = static_cast<Real>(t.in.vertex[i].z) / vertices[i].w;
    return z < -1 ? -1.0L : z > 2 ? 2.0L : z;
  };
  if (first == vertices.end())
    judge.same("base_depth", -1, q.base.depth, 0);
  else
    within("base_depth", -1, q.base.depth,
           depth_one * std::clamp(window_z(static_cast<std::size_t>(first - vertices.begin())), 0.0L, 1.0L),
           0.5L + depth_one * rounding);
  if (std::ranges::all_of(vertices, [](const RealVertex& v) { return v.w > 0; })) {
    Real low = HUGE_VALL, high = -HUGE_VALL;
    for (std::size_t i = 0; i < 4; ++i) low = std::min(low, window_z(i)), high = std::max(high, window_z(i));
    const auto code = [&](Real z, Real doubt) {
      return std::clamp(floorl(depth_one * (z + doubt) + 0.5L), -1.0L, depth_one + 1);
    };
    judge.within("depth_low", -1, q.base.depth_low, code(low, -rounding), code(low, rounding));
    judge.within("depth_high", -1, q.base.depth_high, code(high, -rounding), code(high, rounding));
  } else {
    judge.same("depth_low", -1, q.base.depth_low, -1);
    judge.same("depth_high", -1, q.base.depth_high, depth_one + 1);
  }

  for (std::size_t i = 0; i < 4; ++i) {
    const RealVertex& v = vertices[i];
    const SnappedVertex& p = q.vertex[i];
    const int index = static_cast<int>(i), fraction = v.ordinary ? c.subpixel_bits : c.frac();
    const auto position = [&](const char* name, std::int32_t actual, Real exact) {
      const Real step = ldexpl(1, -fraction), value = ldexpl(static_cast<Real>(actual), -c.frac());
      const Real tolerance = step / 2 + v.k * v.error + rounding * fabsl(exact);
      judge.within(name, index, value, exact - tolerance, exact + tolerance);
      if (v.ordinary && actual % (1 << c.homogeneous_frac_bits) != 0)
        judge.differs(std::string(name) + ": not on the grid of an ordinary vertex");
    };
    position("x", p.x, v.k * v.x);
    position("y", p.y, v.k * v.y);
    if (v.ordinary)
      judge.same("w", index, p.w, ldexpl(1, c.frac()));
    else
      position("w", p.w, v.k * v.w);
    number("k_sig", index, p.k, k_of(i));
    number("z_sig", index, p.z, depth_of(i, ldexpl(static_cast<Real>(q.base.depth), -c.depth_bits)));
    for (std::size_t j = 0; i > 0 && j < slots; ++j)
      number("attr_sig", static_cast<int>((i - 1) * slots + j), p.attribute[j],
             attribute_of(i, j, ldexpl(static_cast<Real>(q.base.attribute[j]), -c.attribute_frac())));
  }
}

/// Exact integers; visibility by the signs of determinants.
void setup(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const DrawState& state = t.in.state;
  const SetupResult& r = t.out.setup;
  const auto& v = t.in.quad.vertex;
  const std::int32_t one = 1 << c.frac();
  const bool homogeneous = std::ranges::any_of(v, [&](const SnappedVertex& a) { return a.w != one; });
  judge.same("slot", -1, r.slot, 0);
  judge.same("homogeneous", -1, r.homogeneous, homogeneous);

  // Pixels [lo, hi] in x and y, then tiles.
  struct Interval {
    Real lo, hi;
  };
  const auto pixels = [&](auto coordinate, int first, int end) -> Interval {
    if (homogeneous) return {first < end ? 0.0L : 1.0L, first < end ? static_cast<Real>(end) - 1 : 0.0L};
    const auto [least, most] = std::ranges::minmax(v, {}, coordinate);
    return {std::max(ceill(static_cast<Real>(least.*coordinate) / one), static_cast<Real>(first)),
            std::min(floorl(static_cast<Real>(most.*coordinate) / one), static_cast<Real>(end) - 1)};
  };
  const Interval x = pixels(&SnappedVertex::x, state.scissor_x0, state.scissor_x1);
  const Interval y = pixels(&SnappedVertex::y, state.scissor_y0, state.scissor_y1);
  const bool empty = x.lo > x.hi || y.lo > y.hi;
  const auto first = [&](Interval i) { return empty ? 0 : floorl(i.lo / c.tile()); };
  const auto count = [&](Interval i) { return empty ? 0 : floorl(i.hi / c.tile()) - first(i) + 1; };
  judge.same("tile_x0", -1, r.tile_x0, first(x));
  judge.same("tile_y0", -1, r.tile_y0, first(y));
  judge.same("tiles_x", -1, r.tiles_x, count(x));
  judge.same("tiles_y", -1, r.tiles_y, count(y));

  const Visibility seen = visibility(t.in.quad, c);
  if (seen.decided) {
    judge.same("hull", -1, r.hull, seen.hull);
    judge.same("visible", -1, r.visible, seen.visible);
  } else {
    judge.undecided();
  }

  // Relative to the origin pixel.
  std::array<Real, 4> tx{}, ty{}, w{};
  for (std::size_t i = 0; i < 4; ++i) {
    w[i] = static_cast<Real>(v[i].w);
    tx[i] = static_cast<Real>(v[i].x) - w[i] * first(x) * c.tile();
    ty[i] = static_cast<Real>(v[i].y) - w[i] * first(y) * c.tile();
  }
  const auto two = [](Real a, Real b) {
    IntegerSum sum;
    sum.add(a);
    sum.add(b);
    return sum;
  };
  for (std::size_t n = 0; n < linear_count; ++n) {
    const auto [i, j] = vertex_pair[n];
    const int index = static_cast<int>(n);
    const auto& f = r.linear[n];
    check_integer(judge, "lin_value", index, static_cast<Real>(f.value), two(tx[i] * ty[j], -ty[i] * tx[j]));
    check_integer(judge, "lin_gx", index, static_cast<Real>(f.gx), two(ty[i] * w[j], -w[i] * ty[j]));
    check_integer(judge, "lin_gy", index, static_cast<Real>(f.gy), two(w[i] * tx[j], -tx[i] * w[j]));
  }
  // The same wherever the origin is. Differences of positions are at most 2^32, so their squares are exact.
  for (std::size_t n = 0; n < linear_count; ++n) {
    const auto [i, j] = vertex_pair[n];
    const Real way_x = static_cast<Real>(v[i].x) - static_cast<Real>(v[j].x),
               way_y = static_cast<Real>(v[i].y) - static_cast<Real>(v[j].y);
    check_shifted(judge, "length2", static_cast<int>(n), static_cast<Real>(r.length2[n]),
                  two(way_x * way_x, way_y * way_y), c.qdrop());
  }
}

/// Exact integers, from what the functions are: dot products of the vectors to two vertices at the tile's origin pixel
/// and its neighbours on either side. Twice gx is f(1) - f(-1), twice q f(1) - 2 f(0) + f(-1), of which one
/// coordinate's part is enough. Each coefficient is the floor by itself.
void tile_contexts(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const Real x0 = static_cast<Real>(t.in.tile_column) * c.tile(), y0 = static_cast<Real>(t.in.tile_row) * c.tile();
  for (std::size_t n = 0; n < quadratic_count; ++n) {
    const int index = static_cast<int>(n);
    const QuadraticForm& f = t.out.tile.quadratic[n];
    if (n < linear_count && !t.in.constants.homogeneous) {
      judge.same("quad_value", index, static_cast<Real>(f.value), 0);
      judge.same("quad_gx", index, static_cast<Real>(f.gx), 0);
      judge.same("quad_gy", index, static_cast<Real>(f.gy), 0);
      judge.same("quad_q", index, static_cast<Real>(f.q), 0);
      continue;
    }
    const RelativeVertex& a = t.in.constants.vertex[n < linear_count ? vertex_pair[n][0] : n - linear_count];
    const RelativeVertex& b = t.in.constants.vertex[n < linear_count ? vertex_pair[n][1] : n - linear_count];
    const auto part = [&](std::int64_t RelativeVertex::*coordinate, Real pixel) {
      return (static_cast<Real>(a.*coordinate) - static_cast<Real>(a.w) * pixel) *
             (static_cast<Real>(b.*coordinate) - static_cast<Real>(b.w) * pixel);
    };
    const auto x = [&](Real dx) { return part(&RelativeVertex::x, x0 + dx); };
    const auto y = [&](Real dy) { return part(&RelativeVertex::y, y0 + dy); };
    const auto check = [&](const char* name, std::int64_t actual, std::initializer_list<Real> terms, int drop) {
      IntegerSum sum;
      for (const Real term : terms) sum.add(term);
      check_shifted(judge, name, index, static_cast<Real>(actual), sum, drop);
    };
    check("quad_value", f.value, {x(0), y(0)}, c.qdrop());
    check("quad_gx", f.gx, {x(1), -x(-1)}, c.qdrop() + 1);
    check("quad_gy", f.gy, {y(1), -y(-1)}, c.qdrop() + 1);
    check("quad_q", f.q, {x(1), -x(0), x(-1), -x(0)}, c.qdrop() + 1);
  }
}

/// Signs of exact integers; a pixel is left out where Real cannot tell one.
void coverage(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const DrawState& state = t.in.state;
  const TileEntry& tile = t.in.tile;
  std::array<std::int64_t, 5> gx{}, gy{};
  std::copy_n(t.in.constants.gx.begin(), 5, gx.begin());
  std::copy_n(t.in.constants.gy.begin(), 5, gy.begin());
  for (int row = 0; row < c.tile(); ++row)
    for (int dx = 0; dx < c.tile(); ++dx) {
      std::array<IntegerSum, 5> e{};
      for (std::size_t k = 0; k < 5; ++k) {
        e[k].add(static_cast<Real>(tile.linear[k]));
        e[k].add(static_cast<Real>(gx[k]) * dx);
        e[k].add(static_cast<Real>(gy[k]) * row);
      }
      const int x = tile.tile_x * c.tile() + dx, y = tile.tile_y * c.tile() + row;
      PixelCover pixel;
      if (x >= state.scissor_x0 && x < state.scissor_x1 && y >= state.scissor_y0 && y < state.scissor_y1)
        pixel = cover(e, gx, gy, t.in.constants.visible, state.cull);
      if (!pixel.decided) {
        judge.undecided();
        continue;
      }
      const StampMasks& masks = t.out.row_masks[static_cast<std::size_t>(row)];
      judge.same("mask", row, masks.mask >> dx & 1, pixel.covered);
      judge.same("front", row, masks.front >> dx & 1, pixel.front);
      judge.same("tie", row, masks.tie >> dx & 1, pixel.tie);
    }
}

/// Exact integers. D of an ordinary quad is half of what the law of cosines says, by floor.
void forward_differences(Judge& judge, const Vector& t) {
  const TileEntry& tile = t.in.tile;
  const Real dx = t.in.dx, row = t.in.row;
  for (std::size_t k = 0; k < linear_count; ++k) {
    IntegerSum sum;
    sum.add(static_cast<Real>(tile.linear[k]));
    sum.add(static_cast<Real>(t.in.constants.gx[k]) * dx);
    sum.add(static_cast<Real>(t.in.constants.gy[k]) * row);
    check_integer(judge, "a", static_cast<int>(k), static_cast<Real>(t.out.pixel.a[k]), sum);
  }
  const auto add_function = [&](IntegerSum& sum, std::size_t k) {
    const QuadraticForm& f = tile.quadratic[k];
    sum.add(static_cast<Real>(f.value));
    sum.add(static_cast<Real>(f.gx) * dx);
    sum.add(static_cast<Real>(f.gy) * row);
    sum.add(static_cast<Real>(f.q) * (dx * dx + row * row));
  };
  for (std::size_t k = 0; k < quadratic_count; ++k) {
    const int index = static_cast<int>(k);
    IntegerSum sum;
    if (k >= linear_count) {
      add_function(sum, k);
      check_integer(judge, "r2", index - linear_count, static_cast<Real>(t.out.pixel.r2[k - linear_count]), sum);
    } else if (t.in.constants.homogeneous) {
      add_function(sum, k);
      check_integer(judge, "d", index, static_cast<Real>(t.out.pixel.d[k]), sum);
    } else {
      const auto [i, j] = vertex_pair[k];
      add_function(sum, linear_count + i);
      sum.add(-static_cast<Real>(t.in.constants.length2[k]));  // between the two, so that no partial sum is large
      add_function(sum, linear_count + j);
      check_shifted(judge, "d", index, static_cast<Real>(t.out.pixel.d[k]), sum, 1);
    }
  }
}

/// One truncation: (1 - u, 1] of the integer.
void normalised(Judge& judge, const Vector& t) {
  const PixelTrace &in = t.in.pixel, &out = t.out.pixel;
  const SingularClass is = singular_class([&](std::size_t i) { return in.r2[i] <= 0; },
                                          [&](std::size_t i) { return in.a[i] == 0 && in.d[i] < 0; });
  judge.same("two_corner", -1, out.two_corner, is.two_corner());
  judge.same("on_vertex", -1, out.on_vertex, is.on_vertex());
  judge.same("two_edge", -1, out.two_edge, is.two_edge());
  judge.same("on_edge", -1, out.on_edge, is.on_edge());
  const auto check = [&](const char* name, std::size_t i, const PipelineFloat& actual, Real exact) {
    check_number(judge, name, static_cast<int>(i), actual, t.losses.cut(exactly(exact)), t.losses);
  };
  for (std::size_t i = 0; i < 6; ++i) {
    check("a_sig", i, out.a_fp[i], ldexpl(static_cast<Real>(in.a[i]), -t.config.qdrop()));
    check("d_sig", i, out.d_fp[i], static_cast<Real>(in.d[i]));
  }
  for (std::size_t i = 0; i < 4; ++i)
    check("r2_sig", i, out.r2_fp[i], static_cast<Real>(std::max<std::int64_t>(in.r2[i], 0)));
}

/// Relative error u, and the table's polynomial (Losses).
void sqrts(Judge& judge, const Vector& t) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Real exact = sqrtl(value_of(t.in.pixel.r2_fp[i], t.losses.s));
    check_number(judge, "sig", static_cast<int>(i), t.out.pixel.root[i], t.losses.rooted(exactly(exact)), t.losses);
  }
}

void reciprocals(Judge& judge, const Vector& t) {
  const Real v = value_of(t.in.number, t.losses.s), exact = v == 0 ? 0 : 1 / v,
             tolerance = t.losses.reciprocal * fabsl(exact);
  check_number(judge, "sig", -1, t.out.inverse, {exact - tolerance, exact + tolerance}, t.losses);
}

/// u = r r' + |D| loses a grain of each term in the alignment and the truncation; v is |A| as it came.
void ratios(Judge& judge, const Vector& t) {
  const Losses& l = t.losses;
  const PixelTrace &in = t.in.pixel, &out = t.out.pixel;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = vertex_pair[k];
    const Real scale = value_of(in.root[i], l.s) * value_of(in.root[j], l.s);
    check_number(judge, "u_sig", static_cast<int>(k), out.u[k],
                 l.sum(std::array{scale, fabsl(value_of(in.d_fp[k], l.s))}), l);
    check_number(judge, "v_sig", static_cast<int>(k), out.v[k], exactly(fabsl(value_of(in.a_fp[k], l.s))), l);
  }
}

/// M_i = sqrt of the product of q over the pairs without i, up to a common power of two, q = r r' + D of an edge, r r'
/// - D of a diagonal (rtl/SPEC.md). Of pairs without a corner in common only the ratio of the q matters:
/// sqrt(q'/q) with q = u, or v²/u where its terms cancel. Truncations of u u', of the two products where both cancel,
/// and of the two that make M; the table's error in each root. Corners are exact.
void weights(Judge& judge, const Vector& t) {
  const Losses& l = t.losses;
  const PixelTrace& in = t.in.pixel;
  const SingularClass is = singular_class([&](std::size_t i) { return t.in.corner[i]; },
                                          [&](std::size_t i) { return t.in.a_sign[i] == 0 && t.in.d_negative[i]; });
  std::array<Real, 4> root{}, k{};
  for (std::size_t i = 0; i < 4; ++i) root[i] = value_of(in.root[i], l.s), k[i] = value_of(t.in.data.k[i], l.s);

  std::array<Span, 4> m{};
  const auto lowest_two = [](const std::array<bool, 4>& set) {
    std::array<std::size_t, 2> at{};
    for (std::size_t i = 0, found = 0; i < 4; ++i)
      if (set[i] && found < 2) at[found++] = i;
    return at;
  };
  if (is.corners > 0) {
    const auto at = lowest_two(is.corner);
    if (is.two_corner())
      m[at[0]] = exactly(fabsl(k[at[1]])), m[at[1]] = exactly(fabsl(k[at[0]]));
    else
      m[at[0]] = exactly(1);
  } else if (is.two_edge()) {
    // The mean of the interpolations along the two lowest edges: each vertex takes the other edge's denominator.
    const auto at = lowest_two(is.edge);
    const auto next = [](std::size_t e) { return (e + 1) % 4; };
    const auto denominator = [&](std::size_t e) {
      return magnitude(l.sum(std::array{root[next(e)] * k[e], root[e] * k[next(e)]}));
    };
    const std::array<Span, 2> d{denominator(at[0]), denominator(at[1])};
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<Span, 2> along{};
      std::size_t terms = 0;
      for (std::size_t n = 0; n < 2; ++n)
        if (i == at[n] || i == next(at[n]))
          along[n] = l.cut(d[1 - n] * exactly(root[i == at[n] ? next(at[n]) : at[n]])), ++terms;
      m[i] = along[0] + along[1];
      if (terms < 2) continue;
      const Real grains = 2 * l.grain * std::max(along[0].hi, along[1].hi);
      m[i] = l.cut({std::max(0.0L, m[i].lo - grains), m[i].hi});
    }
  } else {
    // Square root of q_far / q_near: {numerator, denominator}.
    const auto ratio = [&](std::size_t near, std::size_t far) -> std::array<Span, 2> {
      const auto u = [&](std::size_t n) { return value_of(in.u[n], l.s); };
      const auto v = [&](std::size_t n) { return value_of(in.v[n], l.s); };
      const auto adds = [&](std::size_t n) { return n < 4 ? !t.in.d_negative[n] : t.in.d_negative[n]; };
      const Span product = l.cut(exactly(u(near) * u(far)));
      const Span shared = l.rooted({sqrtl(product.lo), sqrtl(product.hi)});
      if (adds(near)) return {exactly(adds(far) ? u(far) : v(far)), shared};
      if (adds(far)) return {shared, exactly(v(near))};
      return {l.cut(exactly(v(far) * u(near))), l.cut(exactly(v(near)) * shared)};
    };
    const auto a = ratio(0, 2), b = ratio(3, 1), d = ratio(4, 5);
    const auto product = [&](Span x, Span y, Span z) { return l.cut(l.cut(x * y) * z); };
    m = {product(a[0], b[0], d[0]), product(a[0], b[1], d[1]), product(a[1], b[1], d[0]), product(a[1], b[0], d[1])};
    // The machine's power of two, by the largest weight.
    std::size_t largest = 0;
    for (std::size_t i = 1; i < 4; ++i)
      if (m[i].hi > m[largest].hi) largest = i;
    const Real given = value_of(t.out.pixel.m[largest], l.s);
    const int move = m[largest].hi > 0 && given > 0 ? static_cast<int>(lroundl(log2l(given / m[largest].hi))) : 0;
    for (Span& v : m) v = {ldexpl(v.lo, move), ldexpl(v.hi, move)};
  }
  for (std::size_t i = 0; i < 4; ++i) check_number(judge, "sig", static_cast<int>(i), t.out.pixel.m[i], m[i], l);
}

/// Exact products, of attributes three: at most four grains of the largest and one truncation, 5u with no guard bits.
void interpolation(Judge& judge, const Vector& t) {
  const Losses& l = t.losses;
  const PixelTrace& out = t.out.pixel;
  const QuadData& q = t.in.data;
  const auto check = [&](const char* name, int index, const PipelineFloat& actual, std::size_t first, auto&& factor) {
    std::array<Real, 4> terms{};
    for (std::size_t i = first; i < 4; ++i) terms[i] = value_of(t.in.pixel.m[i], l.s) * value_of(factor(i), l.s);
    check_number(judge, name, index, actual, l.sum(terms), l);
  };
  for (std::size_t j = 0; j < static_cast<std::size_t>(t.config.attribute_slots); ++j)
    check("attr_sig", static_cast<int>(j), out.num_a[j], 1, [&](std::size_t i) { return q.b[i][j]; });
  check("z_sig", -1, out.num_z, 0, [&](std::size_t i) { return q.z[i]; });
  check("den_k_sig", -1, out.den_k, 0, [&](std::size_t i) { return q.k[i]; });
  check("den_w_sig", -1, out.den_w, 0, [&](std::size_t i) { return q.w[i]; });
}

/// What a base and num/den in codes may add up to, den != 0: the reciprocal's relative error, then rounding to nearest.
/// From 2^integer on the quotient stands for one without end.
Span sum_codes(Real base, Real num, Real den, int integer, int fraction, const Losses& l) {
  const Real size = fabsl(num / den), limit = ldexpl(1, integer);
  const auto code = [&](Real q) { return q >= limit ? HUGE_VALL : floorl(ldexpl(q, fraction) + 0.5L); };
  const Span q{code(size * (1 - l.reciprocal - rounding)), code(size * (1 + l.reciprocal + rounding))};
  return num * den < 0 ? Span{base - q.hi, base - q.lo} : Span{base + q.lo, base + q.hi};
}

Span clamped(Span v, Real low, Real high) { return {std::clamp(v.lo, low, high), std::clamp(v.hi, low, high)}; }

void depth(Judge& judge, const Vector& t) {
  const Config& c = t.config;
  const Losses& l = t.losses;
  const PixelTrace &in = t.in.pixel, &out = t.out.pixel;
  const DrawState& state = t.in.state;
  const QuadBase& base = t.in.data.base;
  const Real num_z = value_of(in.num_z, l.s), den_k = value_of(in.den_k, l.s), den_w = value_of(in.den_w, l.s);

  // Codes of a drawn pixel's depth.
  Span codes;
  bool may_draw = !(t.in.data.hull && !(den_w > 0)), must_draw = may_draw;
  if (state.depth) {
    codes = clamped(den_w == 0 ? exactly(HUGE_VALL) : sum_codes(base.depth, num_z, den_w, 1, c.depth_bits, l),
                    base.depth_low, base.depth_high);
    const Span limits{static_cast<Real>(t.in.znear), static_cast<Real>(t.in.zfar)};
    must_draw = must_draw && codes.lo >= limits.lo && codes.hi <= limits.hi;
    codes = {std::max(codes.lo, limits.lo), std::min(codes.hi, limits.hi)};
    may_draw = may_draw && codes.lo <= codes.hi;
  }
  if (may_draw == must_draw) judge.same("valid", -1, out.drawn, may_draw);
  if (may_draw != must_draw) judge.undecided();
  const Fragment& g = out.fragment;
  if (!out.drawn) {
    judge.same("saturated", -1, g.flags, 0);
    judge.same("depth", -1, g.depth, 0);
    for (std::size_t j = 0; j < static_cast<std::size_t>(c.attribute_slots); ++j)
      judge.same("attr", static_cast<int>(j), static_cast<Real>(g.attribute[j]), 0);
    return;
  }
  judge.within("depth", -1, g.depth, codes.lo, codes.hi);
  const Real limit = ldexpl(1, c.attribute_int_bits + c.attribute_frac()) - 1;
  bool may_saturate = false, must_saturate = false;
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.attribute_slots); ++j) {
    const Real actual = static_cast<Real>(g.attribute[j]);
    const int index = static_cast<int>(j);
    if (index >= state.attributes) {
      judge.same("attr", index, actual, 0);
      continue;
    }
    if (den_k == 0) {
      may_saturate = true;
      judge.undecided();
      continue;
    }
    const Span sum = sum_codes(static_cast<Real>(base.attribute[j]), value_of(in.num_a[j], l.s), den_k,
                               c.attribute_int_bits + 1, c.attribute_frac(), l);
    const Span value = clamped(sum, -limit, limit);
    judge.within("attr", index, actual, value.lo, value.hi);
    may_saturate = may_saturate || sum.lo < -limit || sum.hi > limit;
    must_saturate = must_saturate || sum.hi < -limit || sum.lo > limit;
  }
  if (may_saturate != must_saturate)
    judge.undecided();
  else
    judge.same("saturated", -1, g.flags, may_saturate);
}

StageCheck find_stage(std::string_view suite) {
  static const std::map<std::string_view, StageCheck> stages{
      {"snapping", snapping},
      {"setup", setup},
      {"tile_context", tile_contexts},
      {"coverage", coverage},
      {"forward_difference", forward_differences},
      {"normalise", normalised},
      {"sqrt", sqrts},
      {"reciprocal", reciprocals},
      {"ratios", ratios},
      {"weights", weights},
      {"interpolation", interpolation},
      {"depth", depth},
  };
  const auto found = stages.find(suite);
  if (found == stages.end()) throw golden::InputError("the float engine does not know suite " + std::string(suite));
  return found->second;
}

}  // namespace
}  // namespace quadrille::vectors::floating

namespace quadrille::vectors {

FloatStage::FloatStage(std::string_view suite, const StageUnderTest& stage)
    : stage_(stage), losses_(stage.config()), check_(floating::find_stage(suite)) {}

VectorOutcome FloatStage::check(const Record& stimulus, const Record& response) const {
  StageData in, out;
  stage_.unpack_stimulus(stimulus, in);
  stage_.unpack_response(response, out);
  floating::Judge judge;
  check_(judge, {in, out, stage_.config(), losses_});
  return judge.outcome();
}

}  // namespace quadrille::vectors
