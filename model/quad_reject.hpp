// Twin of rtl/quad_reject.sv: quads that cannot give a fragment, known from their vertices before any product is
// made, or from the areas of the two triangles of expression (12).
#pragma once

#include "model/config.hpp"
#include "model/stages.hpp"

namespace quadrille {

/// Relative margin of a depth code against Z_i / W_i of the corners, in units of 2^-(S-1); conservative.
///
/// A pixel's depth is (ΣMZ)(1/ΣMW) with weights M >= 0, so between the corners' but for what the operations lose, all
/// of it relative: a sum of four terms of one sign u (1 + 3·2^-G) at most, u = 2^-(S-1) (fp_sum), once above and once
/// below the line; the reciprocal's table u at most, where it has its automatic number of segments. Terms of unlike
/// signs only come closer to zero. The truncation to a code is monotonic.
int depth_margin(const Config& config);

/// Whether the machine has the test of depth: with a table of fewer segments than the automatic ones nothing is
/// claimed.
bool rejects_by_depth(const Config& config);

/// The reasons that need no product: empty, behind, depth. None when DrawState::skip says so.
QuadReject reject_by_vertices(const SnappedQuad& quad, const Config& config, const DrawState& state);
/// Those that need the triangles' areas: line, culled.
QuadReject reject_by_areas(const SetupResult& setup, const DrawState& state);
/// All of them, in this order.
QuadReject quad_reject(const SnappedQuad& quad, const Config& config, const DrawState& state);

}  // namespace quadrille
