#include "model/pixel/pixel_pipeline.hpp"

namespace quadrille {

void mean_value_ratios(PixelTrace& p, const PipelineContext& c) {
  for (std::size_t k = 0; k < 6; ++k) {
    RawProduct cosine = raw_from_fp(p.d_fp[k], c.format);
    cosine.neg = false;
    const RawProduct scale = raw_product(p.root[vertex_pair[k][0]], p.root[vertex_pair[k][1]]);
    p.u[k] = fp_sum({scale, cosine}, c.format);
    p.v[k] = p.a_fp[k];
    p.v[k].neg = false;
  }
}

}  // namespace quadrille
