// Twin of rtl/quadrille_root_ratio.sv, and of its products in rtl/quadrille_ratio_products.sv.
#pragma once

#include "model/pixel/pixel_pipeline.hpp"

namespace quadrille {

/// num / den, neither negative.
struct RootRatio {
  PipelineFloat num, den;
};

/// The same ratio with exponents that are opposite but for one, so that products of three stay near 1; beside a zero 0.
inline RootRatio balanced(RootRatio r) {
  if (r.num.sig == 0 || r.den.sig == 0) {
    r.num.exp = r.den.exp = 0;
  } else {
    const int half = (r.num.exp - r.den.exp) >> 1;
    r.den.exp = half - (r.num.exp - r.den.exp);
    r.num.exp = half;
  }
  return r;
}

/// sqrt(q_far / q_near) of two vertex pairs without a corner in common, from u and v of `p`.
///
/// q = r r' + D of an edge, r r' - D of a diagonal. Where the terms are of one sign that is u; where they cancel it is
/// A² / u, by (r r')² - D² = A².
inline RootRatio root_ratio(const PixelTrace& p, std::size_t near, std::size_t far, const PipelineContext& c) {
  const auto cancels = [&](std::size_t k) { return p.d_fp[k].neg == (k < 4); };
  const PipelineFloat root = fp_sqrt(fp_multiply(p.u[near], p.u[far], c.format), c.sqrt_table, c.format);
  if (!cancels(near)) return balanced({cancels(far) ? p.v[far] : p.u[far], root});
  if (!cancels(far)) return balanced({root, p.v[near]});
  return balanced({fp_multiply(p.v[far], p.u[near], c.format), fp_multiply(p.v[near], root, c.format)});
}

}  // namespace quadrille
