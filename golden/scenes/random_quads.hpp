// Random quads for tests, mutants and golden vectors: every corner of the machine in few pixels. (stress.hpp has the
// families that the commands and the error bounds use.)
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstdint>
#include <vector>

namespace quadrille::tb {

/// A small viewport that keeps homogeneous quads short.
DrawState small_state(const Config& config, int edge = 48);

/// `count` snapped quads with ids 0, 1, 2 …: general, concave, bow-tie, tiny, on integer positions (exact ties, pixels
/// on edges and vertices), collapsed edges, triangles, off screen, behind the eye, w = 0, all around the eye; depths
/// and attributes that are close together or equal, far from 0 or not. Some are changed to what the port may be given
/// but no vertices give: attributes that saturate, other bases, corner codes that clamp depth.
std::vector<SnappedQuad> random_quads(const Config& config, const DrawState& state, std::uint64_t seed, int count);

}  // namespace quadrille::tb
