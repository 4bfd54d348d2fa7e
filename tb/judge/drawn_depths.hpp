// Which depth codes a draw keeps, by the driver's contract.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstdint>

namespace quadrille::tb {

/// Which depth codes are drawn: near_code to far_code, both included.
class DepthLimits {
 public:
  DepthLimits(const Config& config, const DrawState& state);

  bool holds(std::int64_t code) const { return code >= near_code_ && code <= far_code_; }
  /// Every depth of the quad is drawn.
  bool hold_all_of(const QuadBase& base) const { return base.depth_low >= near_code_ && base.depth_high <= far_code_; }
  /// None is.
  bool hold_none_of(const QuadBase& base) const { return base.depth_high < near_code_ || base.depth_low > far_code_; }
  /// Some may and some may not be: where a pixel's depth is near a limit, either is right.
  bool cut(const QuadBase& base) const { return !hold_all_of(base) && !hold_none_of(base); }
  /// 1: a window z within `tolerance` of z is drawn; -1: is not; 0: may be either.
  int side(double z, double tolerance) const;

 private:
  std::int64_t near_code_, far_code_;
  double lowest_, highest_;  ///< window z is drawn between them, and at them or not
};

}  // namespace quadrille::tb
