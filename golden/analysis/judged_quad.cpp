#include "golden/analysis/judged_quad.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/reference/port_number.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace quadrille {

using golden::port_value;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// W where it is ± a power of two, as its exponent; in units of 1.
std::optional<int> power_of_two(std::int32_t w, const Config& config) {
  const auto size = static_cast<std::uint32_t>(std::abs(w));
  if (!std::has_single_bit(size)) return std::nullopt;
  return std::countr_zero(size) - config.frac();
}

}  // namespace

double weight_bound(const Config& config) { return std::ldexp(1.0, -(config.significand_bits - 3)); }

Bounds::Bounds(const Config& config)
    : weight(weight_bound(config)),
      value(weight * value_bound_factor(config)),
      value_of_cut_w(weight * value_bound_factor(config, true)) {}

double FixedPoint::unit() const { return std::ldexp(1.0, -frac_bits); }
double FixedPoint::limit() const { return std::ldexp(1.0, int_bits) - unit() / 2; }
std::int64_t FixedPoint::largest_code() const { return (std::int64_t{1} << (int_bits + frac_bits)) - 1; }

double FixedPoint::distance(std::int64_t code, double value) const {
  return std::max(std::fabs(static_cast<double>(code) * unit() - value) - unit() / 2, 0.0);
}

bool FixedPoint::may_stand_for(std::int64_t code, double value, double tolerance) const {
  return distance(code, value) <= tolerance;
}

FixedPoint attribute_format(const Config& config) { return {config.attribute_int_bits, config.attribute_frac()}; }
FixedPoint depth_format(const Config& config) { return {1, config.depth_bits}; }

std::optional<std::int64_t> nearest_code(std::uint64_t sig, int exponent, int int_bits, int frac_bits) {
  if (sig == 0) return 0;
  if (static_cast<int>(std::bit_width(sig)) - 1 + exponent >= int_bits) return std::nullopt;
  const int shift = exponent + frac_bits;
  if (shift >= 0) return static_cast<std::int64_t>(sig << shift);  // below the limit, so it fits
  if (shift < -63) return 0;
  return static_cast<std::int64_t>((sig >> -shift) + (sig >> (-shift - 1) & 1));
}

double attribute_spread(const SnappedQuad& quad, std::size_t slot, const Config& config, bool perspective) {
  double low = 0, high = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    const double k = perspective ? port_value(v.k, config.significand_bits) : std::ldexp(v.w, -config.frac());
    const double above = port_value(v.attribute[slot], config.significand_bits) / k;
    low = std::min(low, above);
    high = std::max(high, above);
  }
  return high - low;
}

double depth_spread(const SnappedQuad& quad, const Config& config) {
  double low = 0, high = 0;
  for (const SnappedVertex& v : quad.vertex) {
    const double above = port_value(v.z, config.significand_bits) / std::ldexp(v.w, -config.frac());
    low = std::min(low, above);
    high = std::max(high, above);
  }
  return high - low;
}

bool cuts_w(const SnappedQuad& quad, const Config& config) {
  return std::ranges::any_of(quad.vertex, [&](const SnappedVertex& v) {
    const auto size = static_cast<std::uint32_t>(std::abs(v.w));
    return size != 0 && static_cast<int>(std::bit_width(size)) - std::countr_zero(size) > config.significand_bits;
  });
}

JudgedQuad::JudgedQuad(const SnappedQuad& snapped, const Config& config, const Bounds& bounds, const DrawState& state)
    : quad_(snapped),
      config_(config),
      bounds_(bounds),
      truth_(snapped, config, state),
      perspective_(state.perspective) {
  for (std::size_t i = 0; i < 4; ++i) w_[i] = std::ldexp(static_cast<double>(snapped.vertex[i].w), -config.frac());
  depth_may_cancel_ = std::ranges::any_of(w_, [](double w) { return w <= 0; });
  may_cancel_ = !perspective_ && depth_may_cancel_;
  const double by_w = cuts_w(snapped, config) ? bounds.value_of_cut_w : bounds.value;
  if (!depth_may_cancel_) depth_tolerance_ = bounded() ? by_w * depth_spread(snapped, config) : infinity;
  for (std::size_t slot = 0; !may_cancel_ && slot < static_cast<std::size_t>(config.attribute_slots); ++slot)
    attribute_tolerance_[slot] =
        (perspective_ ? bounds.value : by_w) * attribute_spread(snapped, slot, config, perspective_);
}

bool JudgedQuad::tolerates_visibility(const golden::ReferenceSample& truth) const {
  const bool nothing = std::ranges::all_of(w_, [](double w) { return w == 0; });
  return truth.eye_in_hull && !nothing && (!bounded() || std::fabs(truth.visible_margin) < bounds_.weight);
}

double JudgedQuad::cancelled_tolerance(double above, double numerator, double denominator) const {
  if (!bounded()) return infinity;
  // A weight of 1/2 that errs by the bound comes of an M that errs by twice that, relatively.
  const double error = 2 * bounds_.weight, lost = error * denominator;
  if (!(lost < 1)) return infinity;
  return (error * numerator + std::fabs(above) * lost) / (1 - lost);
}

double JudgedQuad::quotient_tolerance(int x, int y, const std::array<double, 4>& numerator) const {
  const auto m = truth_.homogeneous_weights(x, y);
  double above = 0, below = 0, sum_n = 0, sum_w = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double mi = static_cast<double>(m[i]);
    above += std::fabs(mi * numerator[i]);
    below += std::fabs(mi * w_[i]);
    sum_n += mi * numerator[i];
    sum_w += mi * w_[i];
  }
  const double scale = std::fabs(sum_w);
  return cancelled_tolerance(sum_n / sum_w, above / scale, below / scale);
}

double JudgedQuad::depth_tolerance(int x, int y) const {
  if (!depth_may_cancel_) return depth_tolerance_;
  std::array<double, 4> z;
  for (std::size_t i = 0; i < 4; ++i) z[i] = port_value(quad_.vertex[i].z, config_.significand_bits);
  return quotient_tolerance(x, y, z);
}

double JudgedQuad::attribute_tolerance(std::size_t slot, int x, int y) const {
  if (!may_cancel_) return attribute_tolerance_[slot];
  std::array<double, 4> b{};
  for (std::size_t i = 1; i < 4; ++i) b[i] = port_value(quad_.vertex[i].attribute[slot], config_.significand_bits);
  return quotient_tolerance(x, y, b);
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
  const std::int64_t base = quad_.base.attribute[slot];
  if (corner == 0 || b.sig == 0) return base;
  std::optional<int> scale = power_of_two(v.w, config_);
  if (perspective_) scale = std::has_single_bit(v.k.sig) ? std::optional(v.k.exp) : std::nullopt;
  if (!scale) return std::nullopt;
  const FixedPoint format = attribute_format(config_);
  const auto above =
      nearest_code(b.sig, b.exp - *scale - (config_.significand_bits - 1), format.int_bits + 1, format.frac_bits);
  const std::int64_t limit = format.largest_code(), size = above ? *above : 2 * limit;
  const bool neg = b.neg != (!perspective_ && v.w < 0);
  return std::clamp(base + (neg ? -size : size), -limit, limit);
}

std::optional<std::int64_t> JudgedQuad::exact_depth(int corner) const {
  const SnappedVertex& v = quad_.vertex[static_cast<std::size_t>(corner)];
  const QuadBase& base = quad_.base;
  const std::optional<int> scale = power_of_two(v.w, config_);
  if (!scale && v.z.sig != 0) return std::nullopt;
  const FixedPoint format = depth_format(config_);
  const auto above = v.z.sig == 0 ? std::optional<std::int64_t>(0)
                                  : nearest_code(v.z.sig, v.z.exp - *scale - (config_.significand_bits - 1),
                                                 format.int_bits, format.frac_bits);
  const std::int64_t size = above ? *above : 2 * (format.largest_code() + 1);
  return std::clamp<std::int64_t>(std::int64_t{base.depth} + (v.z.neg != (v.w < 0) ? -size : size), base.depth_low,
                                  base.depth_high);
}

}  // namespace quadrille
