#include "model/front/stamp_coverage.hpp"

namespace quadrille {

StampMasks stamp_coverage(const TileEntry& entry, const QuadConstants& quad, int row, const Config& config,
                          const DrawState& state) {
  StampMasks out;
  const int y = (entry.tile_y << config.tile_log2) + row;
  if (y < state.scissor_y0 || y >= state.scissor_y1) return out;
  EdgeSigns signs[5];  // bit dx: of pixel dx
  std::uint32_t zero = 0;
  const int tile = config.tile();
  for (std::size_t k = 0; k < 5; ++k) {
    std::int64_t e = entry.linear[k] + row * quad.gy[k];
    const std::int64_t last = e + (tile - 1) * quad.gx[k];
    if ((e > 0 && last > 0) || (e < 0 && last < 0)) {  // as in most rows: no pixel between is on another side
      (e > 0 ? signs[k].positive : signs[k].negative) = (1u << tile) - 1;
      continue;
    }
    std::uint32_t p = 0, n = 0, z = 0;
    for (int dx = 0; dx < tile; ++dx) {
      p |= static_cast<std::uint32_t>(e > 0) << dx;
      n |= static_cast<std::uint32_t>(e < 0) << dx;
      z |= static_cast<std::uint32_t>(e == 0) << dx;
      e = wrap_add(e, quad.gx[k]);
    }
    signs[k].positive = p | (quad.tie_pos[k] ? z : 0);
    signs[k].negative = n | (quad.tie_neg[k] ? z : 0);
    if (quad.tie_pos[k] || quad.tie_neg[k]) zero |= z;  // an all-zero edge decides nothing
  }
  const InsidePlaces inside = inside_expression(signs, quad.visible, state.cull);

  const int x0 = entry.tile_x << config.tile_log2;
  std::uint32_t scissor = 0;
  for (int dx = 0; dx < tile; ++dx)
    scissor |= static_cast<std::uint32_t>(x0 + dx >= state.scissor_x0 && x0 + dx < state.scissor_x1) << dx;
  out.mask = (inside.back | inside.front) & scissor;
  out.front = inside.front & scissor;
  out.tie = zero & out.mask;
  return out;
}

}  // namespace quadrille
