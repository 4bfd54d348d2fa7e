#include "model/front/quad_setup.hpp"

#include "model/port/snap.hpp"
#include "model/skips/scissor_separation.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace quadrille {
namespace {

using Wide = __int128;

/// V_i × V_j: its components are the coefficients (gx, gy, value) of the homogeneous edge function E_ij.
LinearForm cross(const RelativeVertex& a, const RelativeVertex& b) {
  return {a.x * b.y - a.y * b.x, a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w};
}

/// |a − b|², at most 2^63.
std::uint64_t length2(const RelativeVertex& a, const RelativeVertex& b) {
  const auto square = [](std::int64_t v) { return static_cast<std::uint64_t>(v * v); };
  return square(a.x - b.x) + square(a.y - b.y);
}

Wide determinant(const LinearForm& edge, const RelativeVertex& v) {
  return static_cast<Wide>(edge.gx) * v.x + static_cast<Wide>(edge.gy) * v.y + static_cast<Wide>(edge.value) * v.w;
}

int sign(Wide v) { return (v > 0) - (v < 0); }

struct PixelSpan {
  int lo, hi;  // inclusive pixels
};

/// Pixels whose centre may be covered, along one axis.
PixelSpan pixel_range(const std::array<std::int64_t, 4>& v, int frac, int scissor_lo, int scissor_hi) {
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  const std::int64_t first = -(-*low >> frac);  // ceil
  const std::int64_t last = *high >> frac;      // floor
  return {static_cast<int>(std::max<std::int64_t>(first, scissor_lo)),
          static_cast<int>(std::min<std::int64_t>(last, scissor_hi - 1))};
}

/// Eye inside the tetrahedron of the four vertices (or on its boundary): rtl/SPEC.md, quad_setup.
bool eye_in_hull(Wide d012, Wide d023, Wide d123, Wide d013) {
  const std::array<int, 4> s{sign(d123), -sign(d023), sign(d013), -sign(d012)};
  const bool any_positive = std::any_of(s.begin(), s.end(), [](int v) { return v > 0; });
  const bool any_negative = std::any_of(s.begin(), s.end(), [](int v) { return v < 0; });
  return !(any_positive && any_negative);
}

}  // namespace

TileRange bounding_tiles(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  PixelSpan x{0, state.scissor_x1 - 1};
  PixelSpan y{0, state.scissor_y1 - 1};
  bool empty = state.scissor_x0 >= state.scissor_x1 || state.scissor_y0 >= state.scissor_y1;
  if (is_ordinary(quad, config)) {
    const auto& v = quad.vertex;
    x = pixel_range({v[0].x, v[1].x, v[2].x, v[3].x}, config.frac(), state.scissor_x0, state.scissor_x1);
    y = pixel_range({v[0].y, v[1].y, v[2].y, v[3].y}, config.frac(), state.scissor_y0, state.scissor_y1);
    empty = x.lo > x.hi || y.lo > y.hi;
  }
  if (empty) return {};
  const int tile = config.tile_log2, x0 = x.lo >> tile, y0 = y.lo >> tile;
  return {x0, y0, (x.hi >> tile) - x0 + 1, (y.hi >> tile) - y0 + 1, y.hi & (config.tile() - 1)};
}

SetupResult quad_setup(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  SetupResult r;
  std::array<RelativeVertex, 4>& v = r.vertex;
  r.homogeneous = !is_ordinary(quad, config);
  for (std::size_t i = 0; i < 4; ++i) v[i] = {quad.vertex[i].x, quad.vertex[i].y, quad.vertex[i].w};
  const TileRange tiles = bounding_tiles(quad, config, state);
  r.tile_x0 = tiles.x0;
  r.tile_y0 = tiles.y0;
  r.tiles_x = tiles.columns;
  r.tiles_y = tiles.rows;
  r.last_row = tiles.last_row;

  // Translate to the first tile's origin pixel.
  for (RelativeVertex& t : v) {
    t.x -= t.w * (r.tile_x0 << config.tile_log2);
    t.y -= t.w * (r.tile_y0 << config.tile_log2);
  }
  for (std::size_t k = 0; k < linear_count; ++k) {
    const auto [i, j] = vertex_pair[k];
    r.linear[k] = cross(v[i], v[j]);
    r.length2[k] = length2(v[i], v[j]) >> config.qdrop();
  }

  const auto clauses_of = [](Wide d012, Wide d023) {
    return static_cast<std::uint8_t>((d012 > 0 ? 1 : 0) | (d023 > 0 ? 2 : 0) | (d012 < 0 ? 4 : 0) | (d023 < 0 ? 8 : 0));
  };
  r.visible = 0xf;
  if (r.homogeneous) {
    const Wide d012 = determinant(r.linear[0], v[2]);
    const Wide d023 = determinant(r.linear[2], v[0]);
    const Wide d123 = determinant(r.linear[1], v[3]);
    const Wide d013 = determinant(r.linear[3], v[1]);
    r.hull = eye_in_hull(d012, d023, d123, d013);
    r.clauses = r.hull ? 0xf : clauses_of(d012, d023);
    if (!r.hull) {
      r.visible = r.clauses;
      if ((state.skip & skip_walk) != 0)
        r.separated = static_cast<std::uint8_t>(scissor_separation(r, quad.vertex, state));
    }
  } else {  // E01 + E12 + E20 is twice the area of the triangle 012, anywhere
    const Wide d012 = Wide{r.linear[0].value} + r.linear[1].value + r.linear[4].value;
    const Wide d023 = Wide{r.linear[2].value} + r.linear[3].value - r.linear[4].value;
    r.clauses = clauses_of(d012, d023);
  }
  return r;
}

int quad_setup_steps(bool homogeneous, int pairs, const DrawState& state) {
  const bool separates = (state.skip & skip_walk) != 0;
  if (pairs == 2) return !homogeneous ? 3 : separates ? 24 : 11;
  return !homogeneous ? 6 : separates ? 40 : 20;
}

}  // namespace quadrille
