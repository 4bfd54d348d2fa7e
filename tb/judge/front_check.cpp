// The model's snapping, quad_setup, the walk's and the tiles' functions and those of a pixel before the judge; the
// codes of znear and zfar.
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "tb/judge/function_tally.hpp"
#include "tb/judge/stage_judge.hpp"

#include <cmath>
#include <cstdlib>
#include <vector>

namespace quadrille::tb {
namespace {

using exact::Wide;
using golden::Prng;

constexpr int snapped_quads = 1000, setup_quads = 1500, walked_quads = 100, limit_pairs = 500;

// ---- snapping ----

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
    const SnappingFault fault = snapping_fault(quad, false, snap_quad(quad, config, state), config, state);
    tally.expect(fault.text.empty() && !fault.undecided, [&] {
      std::string text = fault.text + " of (x, y, z, w) * 1024, a in sixteenths of a code =";
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

void check_setup(const Config& config, Prng& rng, FunctionTally& tally) {
  for (int n = 0; n < setup_quads; ++n) {
    const SnappedQuad quad = random_quad(config, rng, n);
    DrawState state;
    state.width = state.height = std::min(80, 1 << config.viewport_bits);
    state.scissor_x0 = static_cast<int>(rng.below(12));
    state.scissor_y0 = static_cast<int>(rng.below(12));
    state.scissor_x1 = state.width - static_cast<int>(rng.below(12));
    state.scissor_y1 = rng.chance(0.05) ? state.scissor_y0 : state.height;
    const std::string fault = setup_fault(quad, quad_setup(quad, config, state), config, state);
    tally.expect(fault.empty(), [&] {
      std::string text = fault + " of (X, Y, W) =";
      for (const SnappedVertex& v : quad.vertex)
        text += " (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.w) + ")";
      return text;
    });
  }
}

/// What is wrong with a tile's functions, or nothing.
std::string tile_fault(const SnappedQuad& quad, const Config& config, bool homogeneous, const TileEntry& tile) {
  const SeenFrom origin(quad.vertex, Wide{tile.tile_x} * config.tile(), Wide{tile.tile_y} * config.tile());
  for (std::size_t k = 0; k < linear_count; ++k)
    if (tile.linear[k] != origin.linear(k)) return "linear function " + std::to_string(k);
  return quadratic_fault(origin, homogeneous, tile, config.qdrop());
}

/// Positions that all lie on the subpixel grid, with W = 1: their products are multiples of 2^(2
/// homogeneous_frac_bits).
bool on_subpixel_grid(const SnappedQuad& quad, const Config& config) {
  const std::int32_t grid = 1 << config.homogeneous_frac_bits;
  return std::ranges::all_of(quad.vertex, [&](const SnappedVertex& v) {
    return v.w == 1 << config.frac() && v.x % grid == 0 && v.y % grid == 0;
  });
}

/// What is wrong with the functions at pixel (dx, dy) of a tile, or nothing: by the tile's, and where no bit is lost by
/// the vertices.
std::string pixel_fault(const SnappedQuad& quad, const Config& config, const TileEntry& tile,
                        const QuadConstants& constants, int dx, int dy, const PixelTrace& p) {
  const SeenFrom pixel(quad.vertex, Wide{tile.tile_x} * config.tile() + dx, Wide{tile.tile_y} * config.tile() + dy);
  for (std::size_t k = 0; k < linear_count; ++k)
    if (p.a[k] != pixel.linear(k)) return "A " + std::to_string(k);
  const int drop = config.qdrop();
  if (drop == 0 || (drop <= 2 * config.homogeneous_frac_bits && on_subpixel_grid(quad, config)))
    for (std::size_t k = 0; k < quadratic_count; ++k)
      if (Wide{k < linear_count ? p.d[k] : p.r2[k - linear_count]} << drop != pixel.quadratic(k))
        return "D or R2 " + std::to_string(k);
  return difference_fault(tile, constants, dx, dy, p);
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
      fault = pixel_fault(quad, config, tile, walk.constants(), dx, dy, p);
      pixels.expect(fault.empty(), place);
    });
    const auto missed = std::ranges::count(seen, 0);
    tiles.expect(missed == 0, [&] { return std::to_string(missed) + " tiles of the bounding box left out"; });
  }
}

void check_limits(const Config& config, Prng& rng, FunctionTally& tally) {
  constexpr int fraction = 40;
  for (int n = 0; n < limit_pairs; ++n) {
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

}  // namespace quadrille::tb
