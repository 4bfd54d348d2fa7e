#include "model/pixel/weight_factors.hpp"

namespace quadrille {
namespace {

/// Along an edge (i, j) the weights are r_j and r_i, with the denominator r_j k_i + r_i k_j; crossing the denominators
/// of two edges gives the mean of their interpolations. A vertex on both has two such terms.
void two_edge(PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  const SignificandFormat& f = c.format;
  const auto is_on = [&](std::size_t e) { return p.a[e] == 0 && p.d[e] < 0; };
  std::size_t a = 0;
  while (!is_on(a)) ++a;
  std::size_t b = a + 1;
  while (!is_on(b)) ++b;
  const PipelineFloat of_a = edge_denominator(p, a, quad, c), of_b = edge_denominator(p, b, quad, c);
  for (std::size_t i = 0; i < 4; ++i) {
    /// The weight along an edge that has vertex i, or nothing.
    const auto along = [&](std::size_t e, const PipelineFloat& other_denominator) -> PipelineFloat {
      if (i == e) return fp_multiply(p.root[(e + 1) % 4], other_denominator, f);
      if (i == (e + 1) % 4) return fp_multiply(p.root[e], other_denominator, f);
      return {};
    };
    p.m[i] = fp_sum({raw_from_fp(along(a, of_b), f), raw_from_fp(along(b, of_a), f)}, f);
  }
}

}  // namespace

void mean_value_weights(PixelTrace& p, const QuadData& quad, const PipelineContext& c) {
  if (p.two_edge) return two_edge(p, quad, c);
  const std::array<WeightFactors, 4> m = weight_factors(p, quad, c);
  for (std::size_t i = 0; i < 4; ++i) p.m[i] = fp_multiply(fp_multiply(m[i].x, m[i].y, c.format), m[i].z, c.format);
}

}  // namespace quadrille
