// Twin of rtl/quadrille_quad_reject.sv: quads that cannot give a fragment, known from their vertices before any product
// is made, or from the areas of the two triangles of expression (12).
#pragma once

#include "model/port/config.hpp"
#include "model/port/stages.hpp"

namespace quadrille {

/// The reasons that need no product: empty, behind, depth. None when DrawState::skip says so.
QuadReject reject_by_vertices(const SnappedQuad& quad, const Config& config, const DrawState& state);
/// Those that need the triangles' areas, and of a homogeneous quad where they lie: line, culled, outside.
QuadReject reject_by_areas(const SetupResult& setup, const DrawState& state);
/// All of them, in this order.
QuadReject quad_reject(const SnappedQuad& quad, const Config& config, const DrawState& state);

}  // namespace quadrille
