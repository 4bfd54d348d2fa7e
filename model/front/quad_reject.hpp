// Twin of rtl/quad_reject.sv: quads that cannot give a fragment, known from their vertices before any product is
// made, or from the areas of the two triangles of expression (12).
#pragma once

#include "model/config.hpp"
#include "model/stages.hpp"

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

/// The reasons that need no product: empty, behind, depth. None when DrawState::skip says so.
QuadReject reject_by_vertices(const SnappedQuad& quad, const Config& config, const DrawState& state);
/// Those that need the triangles' areas, and of a homogeneous quad where they lie: line, culled, outside.
QuadReject reject_by_areas(const SetupResult& setup, const DrawState& state);
/// All of them, in this order.
QuadReject quad_reject(const SnappedQuad& quad, const Config& config, const DrawState& state);

}  // namespace quadrille
