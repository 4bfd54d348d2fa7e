#include "model/pixel_pipeline.hpp"

namespace quadrille {
void normalise(PixelTrace& p, const PipelineContext& c) {
  for (std::size_t k = 0; k < 6; ++k) {
    p.a_fp[k] = fp_from_signed(p.a[k], c.quadratic_bias, c.format);
    p.d_fp[k] = fp_from_signed(p.d[k], 0, c.format);
  }
  int corners = 0;
  int edges = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    p.r2_fp[i] = p.r2[i] > 0 ? fp_from_signed(p.r2[i], 0, c.format) : PipelineFloat{};
    corners += p.r2[i] <= 0;
    edges += p.a[i] == 0 && p.d[i] < 0;
  }
  p.two_corner = corners >= 2;
  p.on_vertex = corners == 1;
  p.two_edge = corners == 0 && edges >= 2;
  p.on_edge = corners == 0 && edges == 1;
}

void sqrt_stage(PixelTrace& p, const PipelineContext& c) {
  for (std::size_t i = 0; i < 4; ++i) p.root[i] = fp_sqrt(p.r2_fp[i], c.sqrt_table, c.format);
}

}  // namespace quadrille
