#include "tb/check/judged_quad.hpp"

#include "golden/reference/port_number.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace quadrille::cli {

using golden::port_value;

double FixedPoint::unit() const { return std::ldexp(1.0, -frac_bits); }
double FixedPoint::limit() const { return std::ldexp(1.0, int_bits); }
std::int64_t FixedPoint::largest_code() const { return (std::int64_t{1} << (int_bits + frac_bits)) - 1; }

std::int64_t FixedPoint::code_of(bool neg, std::uint64_t sig, int exponent) const {
  std::int64_t code = 0;
  if (sig != 0) {
    const int top = static_cast<int>(std::bit_width(sig)) - 1 + exponent, shift = exponent + frac_bits;
    if (top >= int_bits)
      code = largest_code();
    else if (shift >= 0)
      code = static_cast<std::int64_t>(sig) << shift;  // below the limit, so it fits
    else
      code = shift < -63 ? 0 : static_cast<std::int64_t>(sig >> -shift);
  }
  return neg ? -code : code;
}

double FixedPoint::distance(std::int64_t code, double value) const {
  // Truncation toward zero: the number is the code's or up to a unit further from zero.
  const double at = static_cast<double>(code) * unit();
  const double low = at - (code <= 0 ? unit() : 0), high = at + (code >= 0 ? unit() : 0);
  return std::max({low - value, value - high, 0.0});
}

bool FixedPoint::may_stand_for(std::int64_t code, double value, double tolerance) const {
  return distance(code, value) <= tolerance;
}

FixedPoint attribute_format(const Config& config) { return {config.attribute_int_bits, config.attribute_frac()}; }
FixedPoint depth_format(const Config& config) { return {1, config.depth_bits}; }

DepthLimits::DepthLimits(const Config& config, const DrawState& state) {
  // Rounded to a code as the driver's contract says, halves up.
  const auto code = [&](double z) {
    return static_cast<std::int64_t>(std::floor(std::ldexp(std::clamp(z, 0.0, 1.0), config.depth_bits) + 0.5));
  };
  near_code_ = code(state.znear);
  far_code_ = code(state.zfar);
  const double unit = depth_format(config).unit();
  // A code holds what is up to a unit above it; code 0 also what is up to a unit below.
  lowest_ = near_code_ == 0 ? -unit : static_cast<double>(near_code_) * unit;
  end_ = static_cast<double>(far_code_ + 1) * unit;
}

int DepthLimits::side(double z, double tolerance) const {
  if (z + tolerance < lowest_ || z - tolerance >= end_) return -1;
  return z - tolerance >= lowest_ && z + tolerance < end_ ? 1 : 0;
}

JudgedQuad::JudgedQuad(const SnappedQuad& snapped, const Config& config, const DrawState& state)
    : quad_(snapped), config_(config), truth_(snapped, config, state), perspective_(state.perspective) {
  for (std::size_t i = 0; i < 4; ++i) w_[i] = std::ldexp(static_cast<double>(snapped.vertex[i].w), -config.frac());
  const bool behind = std::ranges::any_of(w_, [](double w) { return w <= 0; });
  const auto negative = [](const SnappedVertex& v) { return v.z.neg; };
  may_cancel_ = !perspective_ && behind;
  depth_may_cancel_ =
      behind || (std::ranges::any_of(snapped.vertex, negative) && !std::ranges::all_of(snapped.vertex, negative));
}

bool JudgedQuad::tolerates_visibility(const golden::ReferenceSample& truth, double bound) const {
  const bool nothing = std::ranges::all_of(w_, [](double w) { return w == 0; });
  return truth.eye_in_hull && !nothing && (!bounded() || std::fabs(truth.visible_margin) < bound);
}

double JudgedQuad::quotient_tolerance(int x, int y, double bound, const std::array<double, 4>& numerator,
                                      double value) const {
  if (!bounded()) return std::numeric_limits<double>::infinity();
  // A weight of 1/2 that errs by `bound` comes of an M that errs by twice that, relatively.
  const auto m = truth_.homogeneous_weights(x, y);
  double above = 0, below = 0, sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double mi = static_cast<double>(m[i]);
    above += std::fabs(mi * numerator[i]);
    below += std::fabs(mi * w_[i]);
    sum += mi * w_[i];
  }
  const double scale = std::fabs(sum), lost = 2 * bound * (below / scale);
  if (!(lost < 1)) return std::numeric_limits<double>::infinity();
  return (2 * bound * (above / scale) + std::fabs(value) * lost) / (1 - lost);
}

double JudgedQuad::depth_tolerance(int x, int y, double bound) const {
  const auto m = truth_.homogeneous_weights(x, y);
  std::array<double, 4> z;
  double sum_z = 0, sum_w = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    z[i] = port_value(quad_.vertex[i].z, config_.significand_bits);
    sum_z += static_cast<double>(m[i]) * z[i];
    sum_w += static_cast<double>(m[i]) * w_[i];
  }
  return quotient_tolerance(x, y, bound, z, sum_z / sum_w);
}

double JudgedQuad::attribute_tolerance(std::size_t slot, double value, int x, int y, double bound) const {
  std::array<double, 4> b;
  for (std::size_t i = 0; i < 4; ++i) b[i] = port_value(quad_.vertex[i].attribute[slot], config_.significand_bits);
  if (may_cancel_) return quotient_tolerance(x, y, bound, b, value);
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
    sum += std::fabs(b[i] / (perspective_ ? port_value(quad_.vertex[i].k, config_.significand_bits) : w_[i]));
  return bound * sum;
}

int JudgedQuad::corner_at(int x, int y) const {
  for (int i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad_.vertex[static_cast<std::size_t>(i)];
    if (v.x == std::int64_t{v.w} * x && v.y == std::int64_t{v.w} * y) return i;
  }
  return -1;
}

std::optional<std::int64_t> JudgedQuad::exact_attribute(int corner, std::size_t slot) const {
  const SnappedVertex& v = quad_.vertex[static_cast<std::size_t>(corner)];
  const PortNumber& b = v.attribute[slot];
  const int s = config_.significand_bits;
  if (perspective_) {
    if (!std::has_single_bit(v.k.sig)) return std::nullopt;
    return attribute_format(config_).code_of(b.neg, b.sig, b.exp - v.k.exp - (s - 1));
  }
  const auto size = static_cast<std::uint32_t>(std::abs(v.w));
  if (!std::has_single_bit(size)) return std::nullopt;
  const int exponent = std::countr_zero(size) - config_.frac();
  return attribute_format(config_).code_of(b.neg != (v.w < 0), b.sig, b.exp - exponent - (s - 1));
}

std::optional<std::int64_t> JudgedQuad::exact_depth(int corner) const {
  const SnappedVertex& v = quad_.vertex[static_cast<std::size_t>(corner)];
  const auto size = static_cast<std::uint32_t>(std::abs(v.w));
  if (!std::has_single_bit(size)) return std::nullopt;
  const int exponent = std::countr_zero(size) - config_.frac();
  return depth_format(config_).code_of(v.z.neg != (v.w < 0), v.z.sig,
                                       v.z.exp - exponent - (config_.significand_bits - 1));
}

}  // namespace quadrille::cli
