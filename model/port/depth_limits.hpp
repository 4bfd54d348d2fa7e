// The depths that a draw keeps.
#pragma once

#include "model/port/config.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/records.hpp"

#include <cstdint>

namespace quadrille {

/// The interval [znear, zfar] as codes, and on which side of it a quad's corners lie; every depth lies between them.
class DepthLimits {
 public:
  DepthLimits(const Config& config, const DrawState& state)
      : on_(state.depth), near_(depth_code(state.znear, config)), far_(depth_code(state.zfar, config)) {}

  /// No pixel can be inside.
  bool outside(const QuadBase& base) const { return on_ && (base.depth_high < near_ || base.depth_low > far_); }
  /// No pixel can be outside.
  bool inside(const QuadBase& base) const { return base.depth_low >= near_ && base.depth_high <= far_; }

 private:
  bool on_;
  std::int64_t near_, far_;
};

}  // namespace quadrille
