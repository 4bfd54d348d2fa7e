// Twin of rtl/root_ratio.sv, and of its products in rtl/ratio_products.sv.
#pragma once

#include "model/pixel_pipeline.hpp"

namespace quadrille {

/// num / den, both positive.
struct RootRatio {
  PipelineFloat num, den;
};

/// sqrt(q_far / q_near) of two vertex pairs without a corner in common, from u and v of `p`.
///
/// q = r r' + D of an edge, r r' - D of a diagonal. Where the terms are of one sign that is u; where they cancel it is
/// A² / u, by (r r')² - D² = A².
inline RootRatio root_ratio(const PixelTrace& p, std::size_t near, std::size_t far, const PipelineContext& c) {
  const auto cancels = [&](std::size_t k) { return p.d_fp[k].neg == (k < 4); };
  const PipelineFloat root = fp_sqrt(fp_multiply(p.u[near], p.u[far], c.format), c.sqrt_table, c.format);
  if (!cancels(near)) return {cancels(far) ? p.v[far] : p.u[far], root};
  if (!cancels(far)) return {root, p.v[near]};
  return {fp_multiply(p.v[far], p.u[near], c.format), fp_multiply(p.v[near], root, c.format)};
}

}  // namespace quadrille
