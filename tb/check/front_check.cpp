// Snapping, quad_setup, the walk's and the tiles' functions, those of a pixel and the codes of znear and zfar against
// exact integers (rtl/SPEC.md).
#include "model/covered_pixels.hpp"
#include "model/pixel_pipeline.hpp"
#include "model/quad_setup.hpp"
#include "model/snap.hpp"
#include "model/support/prng.hpp"
#include "tb/check/exact_number.hpp"
#include "tb/check/function_tally.hpp"

#include <cmath>
#include <cstdlib>
#include <vector>

namespace quadrille::cli {
namespace {

using exact::magnitude;
using exact::sign_of;
using exact::top_bit;
using exact::Wide;
using golden::Prng;

constexpr int snapped_quads = 1000, quads = 1500, walked_quads = 100, limits = 500;

// ---- Roundings of the port ----

/// n / d to the nearest integer, ties to even; d > 0.
Wide nearest(Wide n, Wide d) {
  const Wide whole = magnitude(n) / d, rest = magnitude(n) % d;
  const bool up = 2 * rest > d || (2 * rest == d && (whole & 1) != 0);
  return sign_of(n) * (whole + (up ? 1 : 0));
}

/// n / d to S significant bits, as the port has it; d > 0, both below 2^85 and d 2^S below 2^120.
PortNumber nearest_float(Wide n, Wide d, int s) {
  if (n == 0) return {};
  int exponent = top_bit(n) - top_bit(d);  // of the quotient, or one too much
  if (exponent >= 0 ? magnitude(n) < d << exponent : magnitude(n) << -exponent < d) --exponent;
  const int shift = s - 1 - exponent;
  const Wide sig = nearest(shift >= 0 ? magnitude(n) << shift : magnitude(n), shift >= 0 ? d : d << -shift);
  if (sig >> s != 0) return {n < 0, exponent + 1, static_cast<std::uint32_t>(sig >> 1)};
  return {n < 0, exponent, static_cast<std::uint32_t>(sig)};
}

bool same(const PortNumber& a, const PortNumber& b) { return a.neg == b.neg && a.exp == b.exp && a.sig == b.sig; }

/// Coordinates are given in units of 2^-10, so that the half pixel is exact in units of 2^-11; attributes in sixteenths
/// of a code, of which bases are rounded.
constexpr int unit_bits = 10, code_bits = 4;

struct GivenVertex {
  std::int64_t x, y, z, w, a;
};

/// Powers of two make ties of positions, odd numbers none; a quarter lies behind the eye or at infinity. A tenth have
/// a depth halfway between two codes, another an attribute within half a code of the format's end.
GivenVertex random_vertex(const Config& config, Prng& rng, bool before) {
  std::int64_t w = rng.chance(0.5) ? std::int64_t{1} << rng.below(16) : rng.integer(1, 1 << 14);
  if (!before && rng.chance(0.2)) w = -w;
  if (!before && rng.chance(0.05)) w = 0;
  const bool depth_tie = rng.chance(0.1);
  if (depth_tie) w = std::int64_t{1} << (config.depth_bits + 1);
  const double reach = std::ldexp(1.0, config.pos_int() + (rng.chance(0.2) ? 1 : -1)) *
                       (w == 0 ? 1024.0 : static_cast<double>(std::abs(w)));
  GivenVertex v{static_cast<std::int64_t>(rng.uniform(-reach, reach)),
                static_cast<std::int64_t>(rng.uniform(-reach, reach)),
                rng.chance(0.5) ? rng.integer(-2 * std::abs(w), 2 * std::abs(w)) : rng.integer(0, std::abs(w)), w, 0};
  const std::int64_t limit = std::int64_t{1} << (config.attribute_int_bits + config.attribute_frac() + code_bits);
  v.a = rng.integer(1 - limit, limit - 1);
  if (rng.chance(0.1)) v.a = (rng.chance(0.5) ? 1 : -1) * (limit - rng.integer(1, 1 << (code_bits - 1)));
  if (depth_tie) v.z = 2 * rng.integer(-2, (std::int64_t{1} << config.depth_bits) + 1) + 1;
  if (v.x == 0 && v.y == 0 && v.w == 0) v.x = 1;
  return v;
}

/// Position and k = scale / extent of a vertex.
struct ExactVertex {
  std::array<Wide, 3> at;
  Wide scale, extent;

  ExactVertex(const GivenVertex& v, const Config& config) : scale(Wide{1} << (unit_bits + 1)), extent(2 * Wide{v.w}) {
    const int pos = config.pos_int();
    const Wide cx = 2 * Wide{v.x} - v.w, cy = 2 * Wide{v.y} - v.w, cw = 2 * Wide{v.w};
    const Wide grid = Wide{1} << config.subpixel_bits, band = grid << pos;
    if (cw > 0) {
      const Wide gx = nearest(cx * grid, cw), gy = nearest(cy * grid, cw);
      at = {gx << config.homogeneous_frac_bits, gy << config.homogeneous_frac_bits, Wide{1} << config.frac()};
      if (magnitude(gx) < band && magnitude(gy) < band) return;
    }
    extent = std::max({magnitude(cx), magnitude(cy), magnitude(cw) << pos});
    scale <<= pos;
    const Wide fraction = Wide{1} << (config.frac() + pos);
    at = {nearest(cx * fraction, extent), nearest(cy * fraction, extent), nearest(cw * fraction, extent)};
  }
};

/// floor(n / d), d > 0.
Wide floored(Wide n, Wide d) { return n / d - (n % d < 0 ? 1 : 0); }

/// Bases, corner codes and differences of a quad: what is wrong, or nothing.
std::string snapping_fault(const std::array<GivenVertex, 4>& given, const SnappedQuad& quad, const Config& config,
                           const DrawState& state) {
  const int s = config.significand_bits, depth = config.depth_bits, fraction = config.attribute_frac() + code_bits;
  const Wide one = Wide{1} << depth;
  const Wide limit = (Wide{1} << (config.attribute_int_bits + config.attribute_frac())) - 1;
  const Wide base = std::clamp(nearest(given[0].a, Wide{1} << code_bits), -limit, limit);
  if (quad.base.attribute[0] != base) return "base of the attribute";
  Wide base_z = 0;
  for (const GivenVertex& v : given)
    if (v.w > 0) {
      base_z = std::clamp<Wide>(nearest(Wide{v.z} << depth, v.w), 0, one);
      break;
    }
  if (quad.base.depth != base_z) return "base of depth";
  Wide low = one + 1, high = -1;
  for (const GivenVertex& v : given) {
    if (v.w <= 0) {
      low = -1, high = one + 1;
      break;
    }
    const Wide code = std::clamp<Wide>(floored(((Wide{v.z} << depth) * 2) + v.w, 2 * Wide{v.w}), -1, one + 1);
    low = std::min(low, code);
    high = std::max(high, code);
  }
  if (quad.base.depth_low != low || quad.base.depth_high != high) return "codes of the corners";
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    const ExactVertex exact(given[i], config);
    if (v.x != exact.at[0] || v.y != exact.at[1] || v.w != exact.at[2]) return "position";
    if (!same(v.k, nearest_float(exact.scale, exact.extent, s))) return "k";
    const Wide z = (Wide{given[i].z} << depth) - base_z * given[i].w;
    if (!same(v.z, nearest_float(z * exact.scale, exact.extent << (unit_bits + depth), s)))
      return "difference of depth";
    PortNumber b;
    if (const Wide above = given[i].a - (base << code_bits); given[i].a != given[0].a)
      b = state.perspective ? nearest_float(above * exact.scale, exact.extent << fraction, s)
                            : nearest_float(above * Wide{v.w}, Wide{1} << (fraction + config.frac()), s);
    if (!same(v.attribute[0], b)) return "difference of the attribute";
  }
  return "";
}

void check_snapping(const Config& config, Prng& rng, FunctionTally& tally) {
  for (int n = 0; n < snapped_quads; ++n) {
    DrawState state;
    state.perspective = rng.chance(0.75);
    const bool before = rng.chance(0.6);
    std::array<GivenVertex, 4> given;
    WindowQuad quad;
    const auto real = [](std::int64_t v) { return std::ldexp(static_cast<double>(v), -unit_bits); };
    const int fraction = config.attribute_frac() + code_bits;
    for (std::size_t i = 0; i < 4; ++i) {
      GivenVertex& v = given[i];
      v = random_vertex(config, rng, before);
      if (i > 0 && rng.chance(0.3)) v.a = given[0].a + (rng.chance(0.5) ? 0 : given[0].a > 0 ? -1 : 1);
      quad.vertex[i] = {real(v.x), real(v.y), real(v.z), real(v.w)};
      quad.attribute[i] = {std::ldexp(static_cast<double>(v.a), -fraction)};
    }
    const std::string fault = snapping_fault(given, snap_quad(quad, config, state), config, state);
    tally.expect(fault.empty(), [&] {
      std::string text = fault + " of (x, y, z, w) * 1024, a in sixteenths of a code =";
      for (const GivenVertex& v : given)
        text += " (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ", " +
                std::to_string(v.w) + "; " + std::to_string(v.a) + ")";
      return text;
    });
  }
}

// ---- quad_setup ----

SnappedQuad random_quad(const Config& config, Prng& rng, int kind) {
  SnappedQuad quad;
  const std::int32_t one = 1 << config.frac(), grid = 1 << config.homogeneous_frac_bits;
  const int extent = std::min(96, 1 << config.viewport_bits);
  for (SnappedVertex& v : quad.vertex) {
    v.w = one;
    switch (kind % 4) {
      case 0:  // at pixel centres, some outside the viewport
        v.x = static_cast<std::int32_t>(rng.integer(-8, extent)) * one;
        v.y = static_cast<std::int32_t>(rng.integer(-8, extent)) * one;
        break;
      case 1:  // next to one
        v.x = static_cast<std::int32_t>(rng.integer(-8, extent)) * one +
              static_cast<std::int32_t>(rng.integer(-1, 1)) * grid;
        v.y = static_cast<std::int32_t>(rng.integer(-8, extent)) * one +
              static_cast<std::int32_t>(rng.integer(-1, 1)) * grid;
        break;
      case 2:  // few integers: determinants that are 0, corners that coincide or oppose each other
        v.x = static_cast<std::int32_t>(rng.integer(-2, 2)) * one;
        v.y = static_cast<std::int32_t>(rng.integer(-2, 2)) * one;
        v.w = static_cast<std::int32_t>(rng.integer(-1, 1)) * one;
        if (v.x == 0 && v.y == 0 && v.w == 0) v.x = one;
        break;
      default: {
        const std::int64_t most = std::int64_t{1} << (config.pos_int() + config.frac());
        v.x = static_cast<std::int32_t>(rng.integer(-most, most));
        v.y = static_cast<std::int32_t>(rng.integer(-most, most));
        v.w = static_cast<std::int32_t>(rng.integer(-one, one));
      }
    }
  }
  return quad;
}

struct Tiles {
  int first = 0, count = 0;
};

/// Tiles of the pixels in [first, end) that lie between the least and the largest coordinate, found one by one.
template <class Coordinate>
Tiles tiles_along(const SnappedQuad& quad, Coordinate coordinate, bool homogeneous, int first, int end,
                  const Config& config) {
  Tiles out;
  bool any = false;
  for (int pixel = homogeneous ? 0 : first; pixel < end; ++pixel) {
    if (homogeneous && first >= end) break;
    const std::int64_t at = std::int64_t{pixel} << config.frac();
    const auto below = [&](const SnappedVertex& v) { return v.*coordinate <= at; };
    const auto above = [&](const SnappedVertex& v) { return v.*coordinate >= at; };
    if (!homogeneous && !(std::ranges::any_of(quad.vertex, below) && std::ranges::any_of(quad.vertex, above))) continue;
    const int tile = pixel / config.tile();
    if (!any) out.first = tile;
    any = true;
    out.count = tile - out.first + 1;
  }
  return out;
}

/// |V_i - V_j|^2 of a pair, which is the same from every origin when W_i = W_j.
Wide length2(const SnappedQuad& quad, std::size_t pair) {
  const SnappedVertex &a = quad.vertex[vertex_pair[pair][0]], &b = quad.vertex[vertex_pair[pair][1]];
  const Wide x = Wide{a.x} - b.x, y = Wide{a.y} - b.y;
  return x * x + y * y;
}

std::string setup_fault(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  const SetupResult r = quad_setup(quad, config, state);
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

  std::array<Wide, 4> x, y, w;  // relative to the origin pixel
  for (std::size_t i = 0; i < 4; ++i) {
    w[i] = quad.vertex[i].w;
    x[i] = quad.vertex[i].x - w[i] * tx.first * config.tile();
    y[i] = quad.vertex[i].y - w[i] * ty.first * config.tile();
  }
  for (std::size_t k = 0; k < linear_count; ++k) {
    const auto [i, j] = vertex_pair[k];
    const LinearForm& f = r.linear[k];
    if (f.value != x[i] * y[j] - y[i] * x[j] || f.gx != y[i] * w[j] - w[i] * y[j] || f.gy != w[i] * x[j] - x[i] * w[j])
      return "linear function " + std::to_string(k);
  }
  for (std::size_t k = 0; k < linear_count; ++k)
    if (r.length2[k] != length2(quad, k) >> config.qdrop()) return "length " + std::to_string(k);
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

void check_setup(const Config& config, Prng& rng, FunctionTally& tally) {
  for (int n = 0; n < quads; ++n) {
    const SnappedQuad quad = random_quad(config, rng, n);
    DrawState state;
    state.width = state.height = std::min(80, 1 << config.viewport_bits);
    state.scissor_x0 = static_cast<int>(rng.below(12));
    state.scissor_y0 = static_cast<int>(rng.below(12));
    state.scissor_x1 = state.width - static_cast<int>(rng.below(12));
    state.scissor_y1 = rng.chance(0.05) ? state.scissor_y0 : state.height;
    const std::string fault = setup_fault(quad, config, state);
    tally.expect(fault.empty(), [&] {
      std::string text = fault + " of (X, Y, W) =";
      for (const SnappedVertex& v : quad.vertex)
        text += " (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.w) + ")";
      return text;
    });
  }
}

/// A quad seen from a pixel: what its linear and quadratic functions are there.
struct SeenFrom {
  std::array<Wide, 4> x, y, w;

  SeenFrom(const SnappedQuad& quad, Wide px, Wide py) {
    for (std::size_t i = 0; i < 4; ++i) {
      w[i] = quad.vertex[i].w;
      x[i] = quad.vertex[i].x - w[i] * px;
      y[i] = quad.vertex[i].y - w[i] * py;
    }
  }
  Wide linear(std::size_t k) const {
    const auto [i, j] = vertex_pair[k];
    return x[i] * y[j] - y[i] * x[j];
  }
  /// Vertices of D (0 to 5) or R² (6 to 9).
  static std::array<std::size_t, 2> vertices(std::size_t k) {
    return k < linear_count ? vertex_pair[k] : std::array{k - linear_count, k - linear_count};
  }
  Wide quadratic(std::size_t k) const {
    const auto [i, j] = vertices(k);
    return x[i] * x[j] + y[i] * y[j];
  }
  /// Value, gx, gy and q around this pixel, each without its `drop` lowest bits.
  std::array<Wide, 4> coefficients(std::size_t k, int drop) const {
    const auto [i, j] = vertices(k);
    return {quadratic(k) >> drop, -(x[i] * w[j] + w[i] * x[j]) >> drop, -(y[i] * w[j] + w[i] * y[j]) >> drop,
            (w[i] * w[j]) >> drop};
  }
};

/// What is wrong with a tile's functions, or nothing. An ordinary quad has no dot products there.
std::string tile_fault(const SnappedQuad& quad, const Config& config, bool homogeneous, const TileEntry& tile) {
  const SeenFrom origin(quad, Wide{tile.tile_x} * config.tile(), Wide{tile.tile_y} * config.tile());
  for (std::size_t k = 0; k < linear_count; ++k)
    if (tile.linear[k] != origin.linear(k)) return "linear function " + std::to_string(k);
  for (std::size_t k = 0; k < quadratic_count; ++k) {
    const QuadraticForm& f = tile.quadratic[k];
    std::array<Wide, 4> expected{};
    if (homogeneous || k >= linear_count) expected = origin.coefficients(k, config.qdrop());
    if (std::array<Wide, 4>{f.value, f.gx, f.gy, f.q} != expected) return "quadratic function " + std::to_string(k);
  }
  return "";
}

/// Positions that all lie on the subpixel grid, with W = 1: their products are multiples of 2^(2
/// homogeneous_frac_bits).
bool on_subpixel_grid(const SnappedQuad& quad, const Config& config) {
  const std::int32_t grid = 1 << config.homogeneous_frac_bits;
  return std::ranges::all_of(quad.vertex, [&](const SnappedVertex& v) {
    return v.w == 1 << config.frac() && v.x % grid == 0 && v.y % grid == 0;
  });
}

/// What is wrong with the functions at pixel (dx, dy) of a tile, or nothing: by the vertices where no bit is lost, else
/// by the tile's coefficients, and D of an ordinary quad by the law of cosines from these.
std::string pixel_fault(const SnappedQuad& quad, const Config& config, bool homogeneous, const TileEntry& tile, int dx,
                        int dy, const PixelTrace& p) {
  const int drop = config.qdrop();
  const Wide x = Wide{tile.tile_x} * config.tile(), y = Wide{tile.tile_y} * config.tile();
  const SeenFrom origin(quad, x, y), pixel(quad, x + dx, y + dy);
  const bool exact = drop == 0 || (drop <= 2 * config.homogeneous_frac_bits && on_subpixel_grid(quad, config));
  const auto stepped = [&](std::size_t k) {
    const auto [value, gx, gy, q] = origin.coefficients(k, drop);
    return value + dx * gx + dy * gy + (dx * dx + dy * dy) * q;
  };
  for (std::size_t k = 0; k < linear_count; ++k)
    if (p.a[k] != pixel.linear(k)) return "A " + std::to_string(k);
  for (std::size_t k = 0; k < quadratic_count; ++k) {
    const bool is_dot = k < linear_count;
    const Wide actual = is_dot ? p.d[k] : p.r2[k - linear_count];
    Wide expected = stepped(k);
    if (exact)
      expected = pixel.quadratic(k) / (Wide{1} << drop);  // no rest
    else if (is_dot && !homogeneous)
      expected = (stepped(linear_count + vertex_pair[k][0]) + stepped(linear_count + vertex_pair[k][1]) -
                  (length2(quad, k) >> drop)) >>
                 1;
    if (actual != expected || (exact && actual << drop != pixel.quadratic(k)))
      return (is_dot ? "D " : "R2 ") + std::to_string(is_dot ? k : k - linear_count);
  }
  return "";
}

/// Every tile of the bounding box once, with its functions, however many steps away; then those of a pixel of it.
void check_walk(const Config& config, Prng& rng, FunctionTally& tiles, FunctionTally& pixels) {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = std::min(160, 1 << config.viewport_bits);
  state.skip = 0;
  TileWalk walk(config, state);
  for (int n = 0; n < walked_quads; ++n) {
    SnappedQuad quad = random_quad(config, rng, n);
    if (n % 8 == 7)  // W = 1 beside the subpixel grid, as in the last half step of the guard band
      for (SnappedVertex& v : quad.vertex) v.w = 1 << config.frac();
    if (n % 4 < 2)  // over several blocks
      for (SnappedVertex& v : quad.vertex) v.x *= 2, v.y *= 2;
    const SetupResult setup = quad_setup(quad, config, state);
    const std::int32_t one = 1 << config.frac();
    const bool homogeneous = std::ranges::any_of(quad.vertex, [&](const SnappedVertex& v) { return v.w != one; });
    const int size = config.tile();
    std::vector<int> seen(static_cast<std::size_t>(setup.tiles_x * setup.tiles_y));
    walk_tiles(walk, setup, [&](const TileEntry& tile) {
      const int column = tile.tile_x - setup.tile_x0, row = tile.tile_y - setup.tile_y0;
      const bool inside = column >= 0 && column < setup.tiles_x && row >= 0 && row < setup.tiles_y;
      std::string fault = inside ? "" : "outside the bounding box";
      if (inside && seen[static_cast<std::size_t>(row * setup.tiles_x + column)]++ != 0) fault = "twice";
      if (fault.empty()) fault = tile_fault(quad, config, homogeneous, tile);
      const auto place = [&] {
        return fault + " of tile (" + std::to_string(tile.tile_x) + ", " + std::to_string(tile.tile_y) +
               "), the quad's first one (" + std::to_string(setup.tile_x0) + ", " + std::to_string(setup.tile_y0) + ")";
      };
      tiles.expect(fault.empty(), place);
      if (!fault.empty()) return;
      const int dx = static_cast<int>(rng.below(static_cast<std::uint64_t>(size))),
                dy = static_cast<int>(rng.below(static_cast<std::uint64_t>(size)));
      PixelTrace p;
      forward_difference(p, tile, walk.constants(), dx, dy);
      fault = pixel_fault(quad, config, homogeneous, tile, dx, dy, p);
      pixels.expect(fault.empty(), place);
    });
    const auto missed = std::ranges::count(seen, 0);
    tiles.expect(missed == 0, [&] { return std::to_string(missed) + " tiles of the bounding box left out"; });
  }
}

void check_limits(const Config& config, Prng& rng, FunctionTally& tally) {
  constexpr int fraction = 40;
  for (int n = 0; n < limits; ++n) {
    std::int64_t z = rng.integer(0, std::int64_t{1} << fraction);
    if (n % 2 == 0) z &= -(std::int64_t{1} << (fraction - config.depth_bits - 1));  // halves of a code
    const int drop = fraction - config.depth_bits;
    const std::int64_t wanted = (z + (std::int64_t{1} << (drop - 1))) >> drop;  // halves up
    const std::uint32_t code = depth_code(std::ldexp(static_cast<double>(z), -fraction), config);
    tally.expect(code == wanted, [&] {
      return "of " + std::to_string(z) + " / 2^40 gives " + std::to_string(code) + ", expected " +
             std::to_string(wanted);
    });
  }
}

}  // namespace

void check_front(const Config& config, std::vector<FunctionResult>& results) {
  FunctionTally snapping("snapping"), setup("quad_setup"), tiles("tile_walk"), pixels("forward_difference"),
      codes("depth limits");
  Prng rng(3);
  check_snapping(config, rng, snapping);
  check_setup(config, rng, setup);
  check_walk(config, rng, tiles, pixels);
  check_limits(config, rng, codes);
  for (const FunctionTally* tally : {&snapping, &setup, &tiles, &pixels, &codes}) results.push_back(tally->result());
}

}  // namespace quadrille::cli
