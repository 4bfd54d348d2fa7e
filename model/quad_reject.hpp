// Twin of rtl/quad_reject.sv: quads that cannot give a fragment, known from their vertices before any product is
// made, or from the areas of the two triangles of expression (12).
#pragma once

#include "model/config.hpp"
#include "model/depth_rank.hpp"
#include "model/stages.hpp"

#include <optional>

namespace quadrille {

/// Whether every pixel's depth code is outside [znear, zfar], known from the corners'.
class DepthReject {
 public:
  DepthReject(const Config& config, const DrawState& state);
  bool operator()(const SnappedQuad& quad) const;

 private:
  Config config_;
  bool possible_;
  // The ranks of |Z / W| from which, or up to which, every code that can come of it is outside.
  std::optional<std::int64_t> near_;  ///< up to this, and zero, below znear
  std::int64_t far_ = 0;              ///< from this beyond zfar
  std::int64_t some_ = 0;             ///< from this the code is not 0: outside when negative
};

/// The reasons that need no product: empty, behind, depth. None when DrawState::skip says so.
QuadReject reject_by_vertices(const SnappedQuad& quad, const Config& config, const DrawState& state);
/// Those that need the triangles' areas, and of a homogeneous quad where they lie: line, culled, outside.
QuadReject reject_by_areas(const SetupResult& setup, const DrawState& state);
/// All of them, in this order.
QuadReject quad_reject(const SnappedQuad& quad, const Config& config, const DrawState& state);

}  // namespace quadrille
