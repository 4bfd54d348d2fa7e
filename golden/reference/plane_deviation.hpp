// How much a fragment of a quad may change when areas of triangles stand for mean value weights, from the corners in
// exact and extended arithmetic. A second opinion on model/plane_tolerance.hpp, and what the judges of fragments go by.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"

#include <array>

namespace quadrille::golden {

struct PlaneDeviation {
  bool possible = false;  ///< all W are 1 and the corners turn strictly to one side: areas are weights at all
  /// Bounds of |with areas - with mean values|, relative to `*_range`; 0 of what is not drawn, or 0 everywhere.
  double depth = 0;
  std::array<double, max_attribute_slots> attribute{};
  /// The largest magnitude at a corner, of window z and of an attribute (b / k_eff).
  double depth_range = 0;
  std::array<double, max_attribute_slots> attribute_range{};

  /// The largest of the deviations.
  double largest() const;
};

/// In a convex quad either kind of weight is not negative, sums to 1, and reproduces linear functions. With ℓ the plane
/// through a value's numbers at all corners but i, and d_i what is missing there, it gives ℓ(p) + λ_i d_i, so that two
/// kinds differ by |λ_i - μ_i| |d_i| <= |d_i|; each corner i gives such a bound, and all of a quad's values take the
/// same corner for their least one. A quotient n/k of two such sums then changes by at most
/// (|d_n| + max|n/k| |d_k|) / min k. (Hormann & Tarini's weights are of this kind: their property of linear precision.)
PlaneDeviation plane_deviation(const SnappedQuad& quad, const Config& config, const DrawState& state);

/// 2^-t where the configuration has a tolerance of t bits and the draw asks for plane quads, and the quad deviates by
/// no more: how far a fragment may be from mean values, of the range. Else 0.
double plane_allowance(const PlaneDeviation& deviation, const Config& config, const DrawState& state);

}  // namespace quadrille::golden
