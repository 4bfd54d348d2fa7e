#include "model/pixel/pixel_pipeline.hpp"

namespace quadrille {
namespace {

/// Two neighbouring A have strictly opposite signs: an edge turns backward as seen from the pixel.
bool turns_backward(const PixelTrace& p) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int64_t before = p.a[(i + 3) % 4];
    if ((before < 0 && p.a[i] > 0) || (before > 0 && p.a[i] < 0)) return true;
  }
  return false;
}

/// Twin of rtl/quadrille_singular_class.sv.
void singular_class(PixelTrace& p, const PipelineContext& c) {
  int corners = 0;
  int edges = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    corners += p.r2[i] <= 0;
    edges += p.a[i] == 0 && p.d[i] < 0;
  }
  p.two_corner = corners >= 2;
  p.on_vertex = corners == 1;
  p.two_edge = corners == 0 && edges >= 2;
  p.on_edge = corners == 0 && edges == 1;
  p.notch = c.config.notch_exact && !p.two_corner && !p.on_vertex && !p.two_edge && turns_backward(p);
}

}  // namespace

void normalise(PixelTrace& p, const PipelineContext& c) {
  for (std::size_t k = 0; k < 6; ++k) {
    p.a_fp[k] = fp_from_signed(p.a[k], c.quadratic_bias, c.format);
    p.d_fp[k] = fp_from_signed(p.d[k], 0, c.format);
  }
  for (std::size_t i = 0; i < 4; ++i) p.r2_fp[i] = p.r2[i] > 0 ? fp_from_signed(p.r2[i], 0, c.format) : PipelineFloat{};
  singular_class(p, c);
}

void sqrt_stage(PixelTrace& p, const PipelineContext& c) {
  for (std::size_t i = 0; i < 4; ++i) p.root[i] = fp_sqrt(p.r2_fp[i], c.sqrt_table, c.format);
}

}  // namespace quadrille
