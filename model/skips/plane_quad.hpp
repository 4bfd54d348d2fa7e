// Twin of rtl/quadrille_plane_quad.sv: quads whose values are plane, so that areas of triangles are as good weights as
// mean value ones.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

namespace quadrille {

/// The draw asks for it and the machine can.
bool takes_plane_quads(const Config& config, const DrawState& state);
/// An ordinary parallelogram, exactly, over which each value in use (k with perspective, Z with depth, attributes times
/// k_eff) is the same along one pair of opposite sides, in every bit. Never without takes_plane_quads.
bool plane_quad(const SnappedQuad& quad, const Config& config, const DrawState& state);

}  // namespace quadrille
