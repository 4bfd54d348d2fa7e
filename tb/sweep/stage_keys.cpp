#include "tb/sweep/stage_keys.hpp"

namespace quadrille::sweep {

LevelKey level_key(const Config& config, Level level) {
  LevelKey values;
  for (const ConfigKey& key : Config::keys())
    if (key.stage == level) values.push_back(config.resolved(key.name));
  return values;
}

LevelKey port_key(const Config& config) {
  LevelKey values = level_key(config, Level::normalise);
  const LevelKey formats = level_key(config, Level::interpolate);
  values.insert(values.end(), formats.begin(), formats.end());
  return values;
}

LevelKey draw_key(const Config& config) {
  LevelKey values;
  for (const ConfigKey& key : Config::keys())
    if (key.stage != Level::none) values.push_back(config.resolved(key.name));
  return values;
}

CyclesKey cycles_key(const Config& config, const DrawState& state) {
  const bool rejects_by_depth = state.depth && (state.skip & skip_quads) != 0;
  CyclesKey values;
  for (const ConfigKey& key : Config::keys())
    if (key.has(ConfigKey::clocks) && (key.name != "depth_bits" || rejects_by_depth))
      values.push_back(config.resolved(key.name));
  return values;
}

}  // namespace quadrille::sweep
