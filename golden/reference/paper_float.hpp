// The paper's own formulas in double precision, as printed: the baseline that shows what the homogeneous form gains.
#pragma once

#include "golden/reference/sample.hpp"
#include "model/config.hpp"
#include "model/records.hpp"

#include <array>

namespace quadrille::golden {

/// One quad by the pseudo-code of Hormann & Tarini (2004), section 4.2, in double: v_i = (x_i/w_i, y_i/w_i),
/// r_i = |s_i| sign(w_i), t_i = (r_i r_{i+1} - D_i) / A_i, mu_i = (t_{i-1} + t_i) / r_i, lambda_i = mu_i / sum(mu).
/// It divides by w, A and r; where one of them is 0 or a result is not finite, the sample is `undefined`. No switch, no
/// treatment of singular pixels. Coverage is expression (12) with homogeneous edge functions in double and the same tie
/// rule as the truth; in front of the eye where sum(lambda / w) > 0 (eq. 10: all of lambda' then lie in front).
///
/// Error: a few 2^-53 times |v|^2/|A| near general pixels, unbounded towards edges, corners and thin shapes.
class PaperFloatQuad {
 public:
  /// Snapped input, read as reals: x = X 2^-frac etc., relative to pixel centres at the integers; the given w of eq.
  /// (10) is W/k, z_i = Z/W, attribute a_i = b/k (b/W without perspective).
  PaperFloatQuad(const SnappedQuad& quad, const Config& config, const DrawState& draw);
  /// Input as given, pixel centres at +0.5.
  PaperFloatQuad(const WindowQuad& quad, const DrawState& draw);

  /// Eq. (10) for lambda (eq. 7 without perspective), (11) for attributes (eq. 4 without perspective), (4) for z.
  /// Scissor, cull mode, znear and zfar are not applied; where not covered only `covered` and `flags` are set.
  /// flag_on_edge, on_vertex, two_edge and two_corner are what double precision sees; eye_in_hull is always false.
  ReferenceSample sample(int px, int py) const;

 private:
  std::array<double, 4> x_{}, y_{}, w_{};           ///< homogeneous position
  std::array<double, 4> inverse_w_{}, z_over_w_{};  ///< 1/w of the given vertex (k/W when snapped); z of eq. (4)
  std::array<std::array<double, 4>, max_attribute_slots> a_{};  ///< a/w with perspective, else a
  double centre_ = 0;                                           ///< offset of pixel centres
  int attributes_ = 0;
  bool perspective_ = true;
  bool homogeneous_ = false;
};

}  // namespace quadrille::golden
