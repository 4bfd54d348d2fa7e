#include "tb/sweep/stage_keys.hpp"

#include "tb/sweep/search.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace quadrille::sweep {
namespace {

struct KeyLevel {
  std::string_view key;
  Level level;
};

constexpr std::array key_levels{
    KeyLevel{"viewport_bits", Level::positions},
    KeyLevel{"guard_bits", Level::positions},
    KeyLevel{"subpixel_bits", Level::positions},
    KeyLevel{"homogeneous_frac_bits", Level::positions},
    KeyLevel{"quadratic_frac_bits", Level::differences},
    KeyLevel{"tile_log2", Level::differences},
    KeyLevel{"significand_bits", Level::normalise},
    KeyLevel{"sqrt_segments_log2", Level::sqrt},
    KeyLevel{"sqrt_degree", Level::sqrt},
    KeyLevel{"align_guard_bits", Level::ratios},
    KeyLevel{"attribute_int_bits", Level::interpolate},
    KeyLevel{"attribute_frac_bits", Level::interpolate},
    KeyLevel{"depth_bits", Level::interpolate},
    KeyLevel{"recip_segments_log2", Level::reciprocal},
    KeyLevel{"recip_degree", Level::reciprocal},
    KeyLevel{"plane_quads", Level::plane},
};

/// None: the key has no effect on what the tree computes. quad_id_bits only decides whether the input can be drawn.
std::optional<Level> level_of(std::string_view key) {
  const auto named = std::ranges::find(key_levels, key, &KeyLevel::key);
  if (named != key_levels.end()) return named->level;
  if (!affects_error(key) || key == "quad_id_bits") return std::nullopt;
  return Level::positions;
}

/// By level, the positions of its keys in Config::keys().
std::array<std::vector<std::string_view>, level_count> keys_by_level() {
  std::array<std::vector<std::string_view>, level_count> keys;
  for (const ConfigKey& key : Config::keys())
    if (const std::optional<Level> level = level_of(key.name))
      keys[static_cast<std::size_t>(*level)].push_back(key.name);
  return keys;
}

/// Keys that no clock depends on: widths and tables behind the traversal. hierarchical_z_bits counts: its unit is in
/// the way of every quad and tile, though the sweep skips none.
constexpr std::array<std::string_view, 14> clockless{
    "quadratic_frac_bits", "notch_exact",         "sqrt_segments_log2", "sqrt_degree",          "recip_segments_log2",
    "recip_degree",        "align_guard_bits",    "quad_id_bits",       "performance_counters", "plane_quads",
    "attribute_int_bits",  "attribute_frac_bits", "attribute_slots",    "significand_bits"};

}  // namespace

LevelKey level_key(const Config& config, Level level) {
  static const auto keys = keys_by_level();
  LevelKey values;
  for (const std::string_view key : keys[static_cast<std::size_t>(level)]) values.push_back(config.resolved(key));
  return values;
}

LevelKey port_key(const Config& config) {
  LevelKey values = level_key(config, Level::normalise);
  const LevelKey formats = level_key(config, Level::interpolate);
  values.insert(values.end(), formats.begin(), formats.end());
  return values;
}

CyclesKey cycles_key(const Config& config, const DrawState& state) {
  const bool rejects_by_depth = state.depth && (state.skip & skip_quads) != 0;
  CyclesKey values;
  for (const ConfigKey& key : Config::keys()) {
    bool counts = std::ranges::find(clockless, key.name) == clockless.end();
    if (key.name == "depth_bits") counts = rejects_by_depth;
    values.push_back(counts ? config.resolved(key.name) : 0);
  }
  return values;
}

}  // namespace quadrille::sweep
