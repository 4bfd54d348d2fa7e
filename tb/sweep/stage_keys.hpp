// Which setting of a configuration matters at which stage.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstddef>
#include <vector>

namespace quadrille::sweep {

using Level = ConfigKey::Stage;

/// Resolved values of the keys that enter at one level, in the order of Config::keys().
using LevelKey = std::vector<int>;
LevelKey level_key(const Config& config, Level level);

/// What a quad's numbers at the port depend on besides its positions: significand_bits, and the formats that bases of
/// attributes and depth are codes of.
LevelKey port_key(const Config& config);

/// What a draw depends on: resolved values of the keys that enter at some stage.
LevelKey draw_key(const Config& config);

/// What the clocks of a draw depend on: the values of the keys that move clocks. depth_bits counts where quads are left
/// out by their depths. hierarchical_z_bits counts though a sweep hides nothing: its unit is in the way of every quad.
using CyclesKey = std::vector<int>;
CyclesKey cycles_key(const Config& config, const DrawState& state);

}  // namespace quadrille::sweep
