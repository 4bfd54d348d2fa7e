// The paper's own formulas as printed, in single or double precision: the baseline that shows what the homogeneous form
// gains.
#pragma once

#include "golden/reference/coverage_rows.hpp"
#include "golden/reference/sample.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cmath>

namespace quadrille::golden {

/// The weights at a pixel as printed: s_i = v_i minus the pixel, and sign(w_i).
template <class Real>
struct PaperWeights {
  std::array<Real, 4> area{}, dot{}, r{}, t{}, mu{};

  PaperWeights() = default;
  /// t_i counts as 0 where |A_i| < least_area, as a published program has it.
  PaperWeights(const std::array<Real, 4>& sx, const std::array<Real, 4>& sy, const std::array<Real, 4>& w_sign,
               Real least_area = 0) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t next = (i + 1) % 4;
      area[i] = sx[i] * sy[next] - sy[i] * sx[next];
      dot[i] = sx[i] * sx[next] + sy[i] * sy[next];
      r[i] = std::sqrt(sx[i] * sx[i] + sy[i] * sy[i]) * w_sign[i];
    }
    for (std::size_t i = 0; i < 4; ++i)
      t[i] = std::abs(area[i]) < least_area ? 0 : (r[i] * r[(i + 1) % 4] - dot[i]) / area[i];
    for (std::size_t i = 0; i < 4; ++i) mu[i] = (t[(i + 3) % 4] + t[i]) / r[i];
  }
};

/// One quad by the pseudo-code of Hormann & Tarini (2004), section 4.2, with Real = double or float:
/// v_i = (x_i/w_i, y_i/w_i), r_i = |s_i| sign(w_i), t_i = (r_i r_{i+1} - D_i) / A_i, mu_i = (t_{i-1} + t_i) / r_i,
/// lambda_i = mu_i / sum(mu). It divides by w, A and r; where one of them is 0 or a result is not finite, the sample is
/// `undefined`. No switch, no treatment of singular pixels.
///
/// Every input is rounded to Real once, and everything that vertex and fragment shader would compute is in Real: v,
/// 1/w, z/w, a/w; s, r, D, A, t, mu, lambda; eqs. (4), (10), (11). Coverage is not: it is expression (12) with
/// homogeneous edge functions in double and the same tie rule as the truth. In front of the eye where
/// sum(lambda / w) > 0 (eq. 10: all of lambda' then lie in front), in Real.
///
/// Error: a few units of rounding (2^-53, 2^-24) times |v|^2/|A| near general pixels, unbounded towards edges, corners
/// and thin shapes.
template <class Real>
class PaperQuad {
 public:
  /// What the pseudo-code computes at one pixel.
  struct Pixel : PaperWeights<Real> {
    Real sum_mu = 0, sum_inverse_w = 0;  ///< sum(mu); sum(lambda / w)
    std::array<Real, 4> lambda{};        ///< of eq. (10); without perspective of eq. (7)
    Real z = 0;
    std::array<Real, max_attribute_slots> attribute{};
    bool defined = false;  ///< all of the results are finite
  };

  /// Snapped input, read as reals: x = X 2^-frac etc., relative to pixel centres at the integers; the given w of eq.
  /// (10) is W/k, z_i = base + Z/W, attribute a_i = base + b/k (b/W without perspective), a_0 = base.
  PaperQuad(const SnappedQuad& quad, const Config& config, const DrawState& draw);
  /// Input as given, pixel centres at +0.5.
  PaperQuad(const WindowQuad& quad, const DrawState& draw);

  /// Eq. (10) for lambda (eq. 7 without perspective), (11) for attributes (eq. 4 without perspective), (4) for z.
  /// Scissor, cull mode, znear and zfar are not applied; where not covered only `covered` and `flags` are set.
  /// flag_on_edge, on_vertex, two_edge and two_corner are what Real sees; eye_in_hull is always false.
  ReferenceSample sample(int px, int py) const;

  /// Every covered pixel of the scissor lies in them, behind the eye too: `undefined` says nothing of the eye.
  const CoverageRows& rows() const { return rows_; }

  /// The pseudo-code alone, covered or not: what a fragment costs.
  Pixel interpolate(int px, int py) const;

 private:
  void find_rows(const DrawState& draw);
  void cover(int px, int py, ReferenceSample& out) const;

  std::array<double, 4> x_{}, y_{}, w_{};         ///< homogeneous position, for coverage
  std::array<Real, 4> vx_{}, vy_{}, w_sign_{};    ///< screen position; sign(w)
  std::array<Real, 4> inverse_w_{}, z_over_w_{};  ///< 1/w of the given vertex (k/W when snapped); z of eq. (4)
  std::array<std::array<Real, 4>, max_attribute_slots> a_{};  ///< a/w with perspective, else a
  double centre_ = 0;                                         ///< offset of pixel centres
  int attributes_ = 0;
  bool perspective_ = true;
  bool homogeneous_ = false;
  CoverageRows rows_;
};

extern template class PaperQuad<float>;
extern template class PaperQuad<double>;

using PaperFp64Quad = PaperQuad<double>;
using PaperFp32Quad = PaperQuad<float>;

}  // namespace quadrille::golden
