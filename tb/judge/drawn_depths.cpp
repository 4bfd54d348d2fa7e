#include "tb/judge/drawn_depths.hpp"

#include "golden/analysis/judged_quad.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {

DepthLimits::DepthLimits(const Config& config, const DrawState& state) {
  // Rounded to a code as the driver's contract says, halves up.
  const auto code = [&](double z) {
    return static_cast<std::int64_t>(std::floor(std::ldexp(std::clamp(z, 0.0, 1.0), config.depth_bits) + 0.5));
  };
  near_code_ = code(state.znear);
  far_code_ = code(state.zfar);
  const double unit = depth_format(config).unit();
  lowest_ = (static_cast<double>(near_code_) - 0.5) * unit;
  highest_ = (static_cast<double>(far_code_) + 0.5) * unit;
}

int DepthLimits::side(double z, double tolerance) const {
  if (z + tolerance < lowest_ || z - tolerance > highest_) return -1;
  return z - tolerance > lowest_ && z + tolerance < highest_ ? 1 : 0;
}

}  // namespace quadrille::tb
