// Draw states at random, for lockstep and for the comparison with the truth.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstdint>
#include <span>

namespace quadrille::golden {

/// A draw state for a viewport of this size: scissor rectangle (at least a quarter of the viewport in each direction),
/// culling, perspective, depth, znear and zfar (at least 1/4 apart), attributes in use (1 to attribute_slots) and
/// the skips, each at its default in about half of the draws. znear or zfar may be the depth code of a corner of
/// one of `quads` (which may be none) or the next code. The same arguments give the same state everywhere.
DrawState random_draw_state(const Config& config, int width, int height, std::span<const WindowQuad> quads,
                            std::uint64_t seed);

}  // namespace quadrille::golden
