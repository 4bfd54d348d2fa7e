// Which setting of a configuration matters at which stage.
#pragma once

#include "model/config.hpp"

#include <array>

namespace quadrille::sweep {

/// Levels of the tree of configurations, from the root. Those before `normalise` are computed for the whole input and
/// kept; `weights` includes the sums.
enum class Level { positions, differences, normalise, sqrt, ratios, weights, reciprocal, output, plane };
inline constexpr std::size_t level_count = 9;

/// Resolved values of the keys that enter at one level; unused places are 0.
using LevelKey = std::array<int, 5>;

LevelKey level_key(const Config& config, Level level);

/// What the clocks of a draw depend on besides the positions: tile_log2, dot_units, quad_slots_log2,
/// tile_slots_log2, stamp_fifo_log2. Plane quads change no clock.
using CyclesKey = std::array<int, 5>;
CyclesKey cycles_key(const Config& config);

}  // namespace quadrille::sweep
