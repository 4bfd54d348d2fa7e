#include "model/pixel/pixel_pipeline.hpp"

namespace quadrille {

void interpolate(PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  const auto weighted_sum = [&](const PipelineFloat& v0, const PipelineFloat& v1, const PipelineFloat& v2,
                                const PipelineFloat& v3) {
    return fp_sum({raw_product(p.m[0], v0), raw_product(p.m[1], v1), raw_product(p.m[2], v2), raw_product(p.m[3], v3)},
                  c.format);
  };
  p.den_k = weighted_sum(quad.k[0], quad.k[1], quad.k[2], quad.k[3]);
  p.den_w = weighted_sum(quad.w[0], quad.w[1], quad.w[2], quad.w[3]);
  p.num_z = weighted_sum(quad.z[0], quad.z[1], quad.z[2], quad.z[3]);
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.config.attribute_slots); ++j)
    p.num_a[j] = fp_sum(
        {raw_product(p.m[1], quad.b[1][j]), raw_product(p.m[2], quad.b[2][j]), raw_product(p.m[3], quad.b[3][j])},
        c.format);
}

}  // namespace quadrille
