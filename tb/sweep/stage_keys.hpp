// Which setting of a configuration matters at which stage.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"

#include <string_view>
#include <vector>

namespace quadrille::sweep {

/// Levels of the tree of configurations, from the root. Those before `normalise` are computed for the whole input and
/// kept; `ratios` includes the weights, `reciprocal` the output.
enum class Level { positions, differences, normalise, sqrt, ratios, interpolate, reciprocal, plane };
inline constexpr std::size_t level_count = 8;

/// Resolved values of the keys that enter at one level, in the order of Config::keys(). A key that stage_keys.cpp does
/// not name enters at the first level: points that differ in it share nothing.
using LevelKey = std::vector<int>;
LevelKey level_key(const Config& config, Level level);

/// What a quad's numbers at the port depend on besides its positions: significand_bits, and the formats that bases of
/// attributes and depth are codes of.
LevelKey port_key(const Config& config);

/// What the clocks of a draw depend on: the values of all keys, 0 for those that change no clock. depth_bits counts
/// where quads are left out by their depths. Plane quads change no clock.
using CyclesKey = std::vector<int>;
CyclesKey cycles_key(const Config& config, const DrawState& state);

}  // namespace quadrille::sweep
