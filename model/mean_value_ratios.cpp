#include "model/pixel_pipeline.hpp"

namespace quadrille {

void mean_value_ratios(PixelTrace& p, const PipelineContext& c) {
  const RawProduct one = raw_product(c.format.one(), c.format.one());
  for (std::size_t k = 0; k < 6; ++k) {
    const PipelineFloat scale = fp_multiply(p.rho[vertex_pair[k][0]], p.rho[vertex_pair[k][1]], c.format);
    RawProduct cosine = raw_product(p.d_fp[k], scale);
    cosine.neg = false;
    const PipelineFloat u = fp_sum({one, cosine}, c.format);    // 1 + |cos α|
    PipelineFloat v = fp_multiply(p.a_fp[k], scale, c.format);  // |sin α|
    v.neg = false;
    const bool obtuse = p.d_fp[k].neg;
    p.num[k] = obtuse ? u : v;
    p.den[k] = obtuse ? v : u;
  }
}

}  // namespace quadrille
