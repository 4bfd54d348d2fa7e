#include "model/pixel_pipeline.hpp"

namespace quadrille {
namespace {

Fp signed_to_fp(std::int64_t v, int bias, const SignificandFormat& f) {
  const std::uint64_t magnitude = v < 0 ? -static_cast<std::uint64_t>(v) : static_cast<std::uint64_t>(v);
  Fp r = fp_from_magnitude(magnitude, bias, f);
  r.neg = v < 0;
  return r;
}

}  // namespace

void normalise(PixelTrace& p, const PipelineContext& c) {
  for (std::size_t k = 0; k < 6; ++k) {
    p.a_fp[k] = signed_to_fp(p.a[k], c.quadratic_bias, c.format);
    p.d_fp[k] = signed_to_fp(p.d[k], 0, c.format);
  }
  int corners = 0;
  int edges = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    p.r2_fp[i] = p.r2[i] > 0 ? signed_to_fp(p.r2[i], 0, c.format) : Fp{};
    corners += p.r2[i] <= 0;
    edges += p.a[i] == 0 && p.d[i] < 0;
  }
  p.two_corner = corners >= 2;
  p.on_vertex = corners == 1;
  p.two_edge = corners == 0 && edges >= 2;
  p.on_edge = corners == 0 && edges == 1;
}

void rsqrt_stage(PixelTrace& p, const PipelineContext& c) {
  for (std::size_t i = 0; i < 4; ++i) p.rho[i] = rsqrt(p.r2_fp[i], c.rsqrt_table, c.format);
}

}  // namespace quadrille
