// The front in exact integers: rtl/SPEC.md from Snapping to stamp_coverage.
#include "tb/judge/stage_judge.hpp"

#include <cmath>

namespace quadrille::tb {
namespace {

using exact::magnitude;
using exact::Number;
using exact::sign_of;
using exact::top_bit;
using exact::Wide;

// ---- Roundings of the port ----

/// Something needs more bits than Wide has.
struct TooWide {};

Wide shifted(Wide m, int by) {
  if (m != 0 && top_bit(m) + by > 122) throw TooWide{};
  return m << by;
}

Number stripped(Number v) {
  if (v.zero()) return {};
  for (; (v.m & 1) == 0; ++v.e) v.m /= 2;
  return v;
}

Number number(double v) {
  int exponent = 0;
  const double m = std::frexp(v, &exponent);
  return stripped({static_cast<Wide>(std::ldexp(m, 53)), exponent - 53});
}

Number difference(const Number& a, const Number& b) {
  const int e = a.zero() ? b.e : b.zero() ? a.e : std::min(a.e, b.e);
  return stripped({shifted(a.m, a.zero() ? 0 : a.e - e) - shifted(b.m, b.zero() ? 0 : b.e - e), e});
}

Number times(const Number& a, const Number& b) {
  if (top_bit(a.m) + top_bit(b.m) > 122) throw TooWide{};
  return exact::product(a, b);
}

/// In magnitude.
bool smaller(const Number& a, const Number& b) {
  if (a.zero() || b.zero()) return !b.zero();
  if (a.exponent() != b.exponent()) return a.exponent() < b.exponent();
  return difference({magnitude(a.m), a.e}, {magnitude(b.m), b.e}).m < 0;
}

/// n/d, to nearest: ties to even, or up. d > 0.
Wide to_even(Wide n, Wide d) {
  const Wide whole = magnitude(n) / d, rest = magnitude(n) % d;
  const bool up = 2 * rest > d || (2 * rest == d && (whole & 1) != 0);
  return sign_of(n) * (whole + (up ? 1 : 0));
}
Wide half_up(Wide n, Wide d) {
  n = 2 * n + d;
  d *= 2;
  return n / d - (n % d < 0 ? 1 : 0);
}

/// n/d in units of 2^grain; beyond 2^70 of them that many.
Wide rounded(const Number& n, const Number& d, int grain, Wide (*round)(Wide, Wide) = to_even) {
  if (n.zero()) return 0;
  const int exponent = n.exponent() - d.exponent() - grain, shift = n.e - d.e - grain;
  if (exponent > 70) return sign_of(n.m) * (Wide{1} << 70);
  if (exponent < -3) return 0;  // of less than a quarter either rounding makes 0
  return round(shift >= 0 ? shifted(n.m, shift) : n.m, shift >= 0 ? d.m : shifted(d.m, -shift));
}

/// n/d to S significant bits, as the port has it.
PortNumber nearest_float(const Number& n, const Number& d, int s) {
  if (n.zero()) return {};
  int exponent = n.exponent() - d.exponent();  // of the quotient, or one too much
  const int ahead = top_bit(n.m) - top_bit(d.m);
  if (shifted(magnitude(n.m), std::max(-ahead, 0)) < shifted(d.m, std::max(ahead, 0))) --exponent;
  Wide sig = magnitude(rounded(n, d, exponent - (s - 1)));
  if (sig >> s != 0) sig >>= 1, ++exponent;
  if (exponent < -(1 << (Config::port_exp_bits - 1))) return {};
  return {n.m < 0, exponent, static_cast<std::uint32_t>(sig)};
}

bool same(const PortNumber& a, const PortNumber& b) { return a.neg == b.neg && a.exp == b.exp && a.sig == b.sig; }

/// Position and k = 1 / extent of a vertex.
struct ExactVertex {
  std::array<Wide, 3> at;
  Number extent;

  ExactVertex(const WindowVertex& v, const Config& config) : extent(number(v.w)) {
    const Number w = extent, half{w.m, w.e - 1}, x = difference(number(v.x), half), y = difference(number(v.y), half);
    if (v.w > 0) {
      const Wide gx = rounded(x, w, -config.subpixel_bits), gy = rounded(y, w, -config.subpixel_bits);
      at = {gx << config.homogeneous_frac_bits, gy << config.homogeneous_frac_bits, Wide{1} << config.frac()};
      const Wide band = Wide{1} << (config.subpixel_bits + config.pos_int());
      if (magnitude(gx) < band && magnitude(gy) < band) return;
    }
    for (const Number& c : {Number{x.m, x.e - config.pos_int()}, Number{y.m, y.e - config.pos_int()}})
      if (smaller(extent, c)) extent = c;
    extent.m = magnitude(extent.m);
    at = {rounded(x, extent, -config.frac()), rounded(y, extent, -config.frac()), rounded(w, extent, -config.frac())};
  }
};

/// Step 1 of the driver's contract.
bool must_refuse(const WindowQuad& given, const Config& config) {
  constexpr double most = 0x1p80;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [x, y, z, w] = given.vertex[i];
    const double extent = std::max({std::fabs(x), std::fabs(y), std::fabs(w)});
    for (const double c : {x, y, z, w})
      if (!std::isfinite(c)) return true;
    if (extent > most || extent < 1 / most || std::fabs(z) > most) return true;
    for (const double a : given.attribute[i])
      if (!(std::fabs(a) < std::ldexp(1.0, config.attribute_int_bits))) return true;
  }
  return false;
}

/// Tiles of the pixels in [first, end) that lie between the least and the largest coordinate, found one by one.
struct Tiles {
  int first = 0, count = 0;
};

template <class Coordinate>
Tiles tiles_along(const SnappedQuad& quad, Coordinate coordinate, bool homogeneous, int first, int end,
                  const Config& config) {
  Tiles out;
  bool any = false;
  const auto [least, most] = std::ranges::minmax(quad.vertex, {}, coordinate);
  for (int pixel = homogeneous ? 0 : first; pixel < end && first < end; ++pixel) {
    const std::int64_t at = std::int64_t{pixel} << config.frac();
    if (!homogeneous && !(least.*coordinate <= at && most.*coordinate >= at)) continue;
    const int tile = pixel / config.tile();
    if (!any) out.first = tile;
    any = true;
    out.count = tile - out.first + 1;
  }
  return out;
}

}  // namespace

SnappingFault snapping_fault(const WindowQuad& given, bool refused, const SnappedQuad& quad, const Config& config,
                             const DrawState& state) {
  const bool refuse = must_refuse(given, config);
  if (refused != refuse) return {refuse ? "not refused" : "refused"};
  if (refused) return {};
  SnappingFault out;
  const auto expect = [&](const std::string& what, auto&& right) {
    try {
      if (!right() && out.text.empty()) out.text = what;
    } catch (const TooWide&) {
      out.undecided = true;
    }
  };
  const int s = config.significand_bits, depth = config.depth_bits, fraction = config.attribute_frac();
  const Number one{1, 0};
  const Wide depth_one = Wide{1} << depth, limit = (Wide{1} << (config.attribute_int_bits + fraction)) - 1;
  const QuadBase& base = quad.base;
  for (std::size_t j = 0; j < given.attribute[0].size(); ++j)
    expect("base_attr[" + std::to_string(j) + "]", [&] {
      return base.attribute[j] == std::clamp(rounded(number(given.attribute[0][j]), one, -fraction), -limit, limit);
    });
  const auto in_front = [](const WindowVertex& v) { return v.w > 0; };
  expect("base_depth", [&] {
    const auto first = std::ranges::find_if(given.vertex, in_front);
    return base.depth == (first == given.vertex.end()
                              ? 0
                              : std::clamp<Wide>(rounded(number(first->z), number(first->w), -depth), 0, depth_one));
  });
  expect("depth_low and depth_high", [&] {
    if (!std::ranges::all_of(given.vertex, in_front)) return base.depth_low == -1 && base.depth_high == depth_one + 1;
    Wide low = depth_one + 1, high = -1;
    for (const WindowVertex& v : given.vertex) {
      const Wide code = std::clamp<Wide>(rounded(number(v.z), number(v.w), -depth, half_up), -1, depth_one + 1);
      low = std::min(low, code);
      high = std::max(high, code);
    }
    return base.depth_low == low && base.depth_high == high;
  });
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    const std::string of = "[" + std::to_string(i) + "]";
    std::optional<ExactVertex> exact;
    expect("x, y, w" + of, [&] {
      exact.emplace(given.vertex[i], config);
      return std::array<Wide, 3>{v.x, v.y, v.w} == exact->at;
    });
    if (!exact) continue;
    expect("k" + of, [&] { return same(v.k, nearest_float(one, exact->extent, s)); });
    expect("z" + of, [&] {
      const Number above =
          difference(number(given.vertex[i].z), times({base.depth, -depth}, number(given.vertex[i].w)));
      return same(v.z, nearest_float(above, exact->extent, s));
    });
    for (std::size_t j = 0; i > 0 && j < given.attribute[i].size(); ++j)
      expect("attr" + of + "[" + std::to_string(j) + "]", [&] {
        const double a = given.attribute[i][j];
        if (a == given.attribute[0][j]) return same(v.attribute[j], {});
        const Number above = difference(number(a), {base.attribute[j], -fraction});
        return same(v.attribute[j], state.perspective ? nearest_float(above, exact->extent, s)
                                                      : nearest_float(times(above, {v.w, -config.frac()}), one, s));
      });
  }
  return out;
}

std::string setup_fault(const SnappedQuad& quad, const SetupResult& r, const Config& config, const DrawState& state) {
  const std::int32_t one = 1 << config.frac();
  const bool homogeneous = std::ranges::any_of(quad.vertex, [&](const SnappedVertex& v) { return v.w != one; });
  if (r.homogeneous != homogeneous) return "homogeneous";
  Tiles tx = tiles_along(quad, &SnappedVertex::x, homogeneous, state.scissor_x0, state.scissor_x1, config);
  Tiles ty = tiles_along(quad, &SnappedVertex::y, homogeneous, state.scissor_y0, state.scissor_y1, config);
  if (tx.count == 0 || ty.count == 0) tx = ty = {};
  if (r.tile_x0 != tx.first || r.tiles_x != tx.count || r.tile_y0 != ty.first || r.tiles_y != ty.count)
    return "bounding box: tiles (" + std::to_string(r.tile_x0) + ", " + std::to_string(r.tile_y0) + ") + " +
           std::to_string(r.tiles_x) + " x " + std::to_string(r.tiles_y) + ", expected (" + std::to_string(tx.first) +
           ", " + std::to_string(ty.first) + ") + " + std::to_string(tx.count) + " x " + std::to_string(ty.count);

  const SeenFrom origin(quad.vertex, Wide{tx.first} * config.tile(), Wide{ty.first} * config.tile());
  const auto &x = origin.x, &y = origin.y, &w = origin.w;
  for (std::size_t k = 0; k < linear_count; ++k) {
    const auto [i, j] = vertex_pair[k];
    const LinearForm& f = r.linear[k];
    if (f.value != origin.linear(k) || f.gx != y[i] * w[j] - w[i] * y[j] || f.gy != w[i] * x[j] - x[i] * w[j])
      return "linear function " + std::to_string(k);
    // The same from every origin.
    const SnappedVertex &a = quad.vertex[i], &b = quad.vertex[j];
    const Wide dx = Wide{a.x} - b.x, dy = Wide{a.y} - b.y;
    if (r.length2[k] != (dx * dx + dy * dy) >> config.qdrop()) return "length " + std::to_string(k);
  }
  // The signs of determinants do not depend on the origin.
  const auto det = [&](std::size_t a, std::size_t b, std::size_t c) {
    return sign_of(x[a] * (y[b] * w[c] - w[b] * y[c]) - y[a] * (x[b] * w[c] - w[b] * x[c]) +
                   w[a] * (x[b] * y[c] - y[b] * x[c]));
  };
  const int d012 = det(0, 1, 2), d023 = det(0, 2, 3);
  const std::array<int, 4> relation{det(1, 2, 3), -d023, det(0, 1, 3), -d012};
  const auto least = std::ranges::min(relation), most = std::ranges::max(relation);
  const bool hull = homogeneous && least * most >= 0;
  if (r.hull != hull) return hull ? "hull missed" : "hull claimed";
  const int visible =
      !homogeneous || hull ? 15 : (d012 > 0 ? 1 : 0) | (d023 > 0 ? 2 : 0) | (d012 < 0 ? 4 : 0) | (d023 < 0 ? 8 : 0);
  return r.visible == visible ? "" : "visible clauses";
}

std::string quadratic_fault(const SeenFrom& origin, bool homogeneous, const TileEntry& tile, int drop) {
  for (std::size_t k = 0; k < quadratic_count; ++k) {
    const QuadraticForm& f = tile.quadratic[k];
    std::array<Wide, 4> expected{};
    if (homogeneous || k >= linear_count) expected = origin.coefficients(k, drop);
    if (std::array<Wide, 4>{f.value, f.gx, f.gy, f.q} != expected) return "quadratic function " + std::to_string(k);
  }
  return "";
}

std::string difference_fault(const TileEntry& tile, const QuadConstants& quad, int dx, int dy, const PixelTrace& p) {
  const auto stepped = [&](std::size_t k) {
    const QuadraticForm& f = tile.quadratic[k];
    return f.value + dx * Wide{f.gx} + dy * Wide{f.gy} + (dx * dx + dy * dy) * Wide{f.q};
  };
  for (std::size_t k = 0; k < linear_count; ++k) {
    const std::string of = "[" + std::to_string(k) + "]";
    if (p.a[k] != tile.linear[k] + dx * Wide{quad.gx[k]} + dy * Wide{quad.gy[k]}) return "a" + of;
    const auto [i, j] = vertex_pair[k];
    if (p.d[k] != (quad.homogeneous
                       ? stepped(k)
                       : (stepped(linear_count + i) + stepped(linear_count + j) - Wide{quad.length2[k]}) >> 1))
      return "d" + of;
  }
  for (std::size_t i = 0; i < 4; ++i)
    if (p.r2[i] != stepped(linear_count + i)) return "r2[" + std::to_string(i) + "]";
  return "";
}

std::string coverage_fault(const TileEntry& tile, const QuadConstants& quad, int row, const StampMasks& masks,
                           const Config& config, const DrawState& state) {
  for (int dx = 0; dx < config.tile(); ++dx) {
    const int x = tile.tile_x * config.tile() + dx, y = tile.tile_y * config.tile() + row;
    std::array<int, 5> sign{};
    bool zero = false;
    for (std::size_t k = 0; k < 5; ++k) {
      sign[k] = sign_of(tile.linear[k] + dx * Wide{quad.gx[k]} + row * Wide{quad.gy[k]});
      if (sign[k] != 0) continue;
      // On an edge: the side of a point a little further to the right, then further down.
      sign[k] = sign_of(quad.gx[k] != 0 ? quad.gx[k] : quad.gy[k]);
      zero = zero || sign[k] != 0;
    }
    const auto clause = [&](int o, unsigned first, unsigned second) {
      const bool one = sign[4] == o && sign[0] == o && sign[1] == o && (sign[2] == o || sign[3] == o);
      const bool two = sign[4] == -o && sign[2] == o && sign[3] == o && (sign[0] == o || sign[1] == o);
      return (one && (quad.visible & first) != 0) || (two && (quad.visible & second) != 0);
    };
    const bool inside = x >= state.scissor_x0 && x < state.scissor_x1 && y >= state.scissor_y0 && y < state.scissor_y1;
    const bool front = inside && clause(-1, 4, 8) && state.cull != Cull::front;
    const bool covered = front || (inside && clause(1, 1, 2) && state.cull != Cull::back);
    const auto is = [&](std::uint32_t mask, bool wanted) { return ((mask >> dx & 1) != 0) == wanted; };
    const char* wrong = !is(masks.mask, covered)          ? "mask"
                        : !is(masks.front, front)         ? "front"
                        : !is(masks.tie, zero && covered) ? "tie"
                                                          : nullptr;
    if (wrong != nullptr) return std::string(wrong) + "[" + std::to_string(row) + "], bit " + std::to_string(dx);
  }
  return "";
}

}  // namespace quadrille::tb
