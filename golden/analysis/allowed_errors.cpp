#include "golden/analysis/allowed_errors.hpp"

#include "golden/reference/port_number.hpp"

#include <cmath>

namespace quadrille {

ErrorBounds::ErrorBounds(const JudgedQuad& quad, const Config& config, const DrawState& state)
    : quad_(quad),
      attributes_(static_cast<std::size_t>(state.attributes)),
      attribute_code_(attribute_format(config).unit() / 2),
      depth_code_(depth_format(config).unit() / 2),
      quick_(state.perspective && quad.bounded()) {
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.quad().vertex[i];
    const double k = golden::port_value(v.k, config.significand_bits);
    z_[i] = golden::port_value(v.z, config.significand_bits) / k;
    w_[i] = std::ldexp(static_cast<double>(v.w), -config.frac()) / k;
  }
  const Bounds& bounds = quad.bounds();
  fixed_.weight = {bounds.value + attribute_code_, bounds.weight, bounds.weight, bounds.weight};
  for (std::size_t a = 0; !quad.may_cancel() && a < attributes_; ++a)
    fixed_.attribute[a] = quad.attribute_tolerance(a, 0, 0) + attribute_code_;
}

AllowedErrors ErrorBounds::at(const golden::ReferenceSample& truth, int x, int y) const {
  AllowedErrors allowed = fixed_;
  for (std::size_t a = 0; quad_.may_cancel() && a < attributes_; ++a)
    allowed.attribute[a] = quad_.attribute_tolerance(a, x, y) + attribute_code_;
  allowed.depth = (quick_ && quad_.depth_may_cancel() ? depth(truth) : quad_.depth_tolerance(x, y)) + depth_code_;
  return allowed;
}

/// JudgedQuad::depth_tolerance with M_i = lambda_i / k_i, up to a common factor.
double ErrorBounds::depth(const golden::ReferenceSample& truth) const {
  double above = 0, below = 0, sum = 0, sum_z = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double mw = truth.lambda[i] * w_[i], mz = truth.lambda[i] * z_[i];
    above += std::fabs(mz);
    below += std::fabs(mw);
    sum += mw;
    sum_z += mz;
  }
  const double scale = std::fabs(sum);
  return quad_.cancelled_tolerance(sum_z / sum, above / scale, below / scale);
}

}  // namespace quadrille
