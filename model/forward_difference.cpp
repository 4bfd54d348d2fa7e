#include "model/pixel_pipeline.hpp"

namespace quadrille {

void forward_difference(PixelTrace& p, const TileEntry& tile, const QuadConstants& quad, int dx, int row) {
  for (std::size_t k = 0; k < linear_count; ++k) p.a[k] = wrap_add(tile.linear[k], dx * quad.gx[k] + row * quad.gy[k]);
  const int square = dx * dx + row * row;
  const auto at = [&](std::size_t k) {
    const QuadraticForm& f = tile.quadratic[k];
    return wrap_add(f.value, dx * f.gx + row * f.gy + square * quad.q[k]);
  };
  for (std::size_t k = 0; k < 6; ++k) p.d[k] = at(k);
  for (std::size_t k = 0; k < 4; ++k) p.r2[k] = at(6 + k);
}

}  // namespace quadrille
