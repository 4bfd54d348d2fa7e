#include "model/pixel/pixel_pipeline.hpp"

namespace quadrille {
namespace {

/// D_ij = (R²_i + R²_j − |V_i − V_j|²) / 2, floor; the sum may have 65 bits.
std::int64_t law_of_cosines(std::int64_t r2i, std::int64_t r2j, std::uint64_t length2) {
  const __int128 twice = static_cast<__int128>(r2i) + r2j - static_cast<__int128>(length2);
  return static_cast<std::int64_t>(twice >> 1);
}

}  // namespace

TileRow forward_difference_row(const TileEntry& tile, const QuadConstants& quad, int row) {
  TileRow r{tile, row};
  for (std::size_t k = 0; k < linear_count; ++k) r.linear[k] = wrap_add(tile.linear[k], row * quad.gy[k]);
  for (std::size_t k = quad.homogeneous ? 0 : 6; k < quadratic_count; ++k)
    r.quadratic[k] = wrap_add(tile.quadratic[k].value, row * tile.quadratic[k].gy);
  return r;
}

void forward_difference_column(PixelTrace& p, const TileRow& row, const QuadConstants& quad, int dx) {
  for (std::size_t k = 0; k < linear_count; ++k) p.a[k] = wrap_add(row.linear[k], dx * quad.gx[k]);
  const int square = dx * dx + row.row * row.row;
  const auto at = [&](std::size_t k) {
    const QuadraticForm& f = row.tile.quadratic[k];
    return wrap_add(row.quadratic[k], dx * f.gx + square * f.q);
  };
  for (std::size_t k = 0; k < 4; ++k) p.r2[k] = at(6 + k);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = vertex_pair[k];
    p.d[k] = quad.homogeneous ? at(k) : law_of_cosines(p.r2[i], p.r2[j], quad.length2[k]);
  }
}

}  // namespace quadrille
