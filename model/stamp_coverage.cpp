#include "model/stamp_coverage.hpp"

namespace quadrille {

StampMasks stamp_coverage(const TileEntry& entry, const QuadConstants& quad, int row, const Config& config,
                          const DrawState& state) {
  StampMasks out;
  const int y = (entry.tile_y << config.tile_log2) + row;
  if (y < state.scissor_y0 || y >= state.scissor_y1) return out;
  // Bit dx of each word: the sign of edge k at pixel dx.
  std::uint32_t pos[5], neg[5];
  std::uint32_t zero = 0;
  const int tile = config.tile();
  for (std::size_t k = 0; k < 5; ++k) {
    std::int64_t e = entry.linear[k] + row * quad.gy[k];
    std::uint32_t p = 0, n = 0, z = 0;
    for (int dx = 0; dx < tile; ++dx) {
      p |= static_cast<std::uint32_t>(e > 0) << dx;
      n |= static_cast<std::uint32_t>(e < 0) << dx;
      z |= static_cast<std::uint32_t>(e == 0) << dx;
      e = wrap_add(e, quad.gx[k]);
    }
    pos[k] = p | (quad.tie_pos[k] ? z : 0);
    neg[k] = n | (quad.tie_neg[k] ? z : 0);
    if (quad.tie_pos[k] || quad.tie_neg[k]) zero |= z;  // an all-zero edge decides nothing
  }
  const auto clause = [&](int bit, std::uint32_t value) { return quad.visible >> bit & 1 ? value : 0; };
  std::uint32_t back =
      clause(0, pos[4] & pos[0] & pos[1] & (pos[2] | pos[3])) | clause(1, neg[4] & pos[2] & pos[3] & (pos[0] | pos[1]));
  std::uint32_t front =
      clause(2, neg[4] & neg[0] & neg[1] & (neg[2] | neg[3])) | clause(3, pos[4] & neg[2] & neg[3] & (neg[0] | neg[1]));
  if (state.cull == Cull::back) back = 0;
  if (state.cull == Cull::front) front = 0;

  const int x0 = entry.tile_x << config.tile_log2;
  std::uint32_t inside = 0;
  for (int dx = 0; dx < tile; ++dx)
    inside |= static_cast<std::uint32_t>(x0 + dx >= state.scissor_x0 && x0 + dx < state.scissor_x1) << dx;
  out.mask = (back | front) & inside;
  out.front = front & inside;
  out.tie = zero & out.mask;
  return out;
}

}  // namespace quadrille
