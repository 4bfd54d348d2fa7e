// What the scenarios are made with, and those that scenario.cpp lists from other files.
#pragma once

#include "model/port/snap.hpp"
#include "model/support/prng.hpp"
#include "tb/verify/faults/scenario.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

// ---- Machines: each takes a simulator ----

/// Everything exact, few bits.
const Config& exact();
/// What the other has not: bits of D and r² dropped, no flag of notches, buffers of the least size, other widths.
const Config& reduced();
/// Four pixels a clock; few slots, for a machine that is quick to build.
const Config& four_lanes();
/// Hidden tiles. Tags of two bits and four epochs: what memory holds before it is wiped is soon taken for an entry.
const Config& hiding();
/// Six columns of blocks of tiles at four places.
const Config& hiding_blocks();
/// Areas for weights where values are plane, a pixel a clock.
const Config& plane_weights();

// ---- Tools ----

LockstepOptions options(const Config& config, int edge);

using Draw = std::function<WindowQuad(golden::Prng&)>;
/// `count` quads that snapping takes, of what `draw` draws.
std::vector<SnappedQuad> drawn(const LockstepOptions& o, std::uint64_t seed, int count, const Draw& draw);

/// Corners on the pixel centres of a square of `edge` pixels: ties, collinear and coincident corners, crossings. Each w
/// is one of `w`, a power of two with sign: positions stay exact.
WindowQuad on_grid(golden::Prng& random, int edge, std::span<const double> w);
bool corners_meet(const WindowQuad& quad);
/// W = ONE/2 at two corners: no bounding box.
void halve(SnappedQuad& quad);

// ---- Hidden tiles: scenario_layers.cpp ----

Scenario layers();
Scenario flushes_and_clears();
Scenario block_layers(const std::string& name, bool near_together);
Scenario unwiped(const std::string& name, std::uint64_t seed);
Scenario wiped(int width, int height);
Scenario joined_layers();
Scenario acute_layers();
Scenario far_end();

// ---- Numbers at the ends of their formats, and places far away: scenario_values.cpp ----

Scenario bases();
Scenario sprites();
Scenario after_reset(std::uint64_t seed);
Scenario far_scissor();
Scenario far_scissor_homogeneous();
Scenario far_exponents();
Scenario flat_at_infinity();

}  // namespace quadrille::tb
