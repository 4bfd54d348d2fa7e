// Quads with something for every key of the configuration to move.
#pragma once

#include "golden/scenes/stress.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace quadrille {

inline constexpr int every_key_size = 40;  // pixels of an edge of the viewport
inline constexpr int every_key_attributes = 3;

/// Vertices of every kind, depths at a limit and across it, values at the ends of formats, enough small quads for
/// queues to fill, plane quads.
inline std::vector<WindowQuad> quads_for_every_key() {
  using enum golden::StressFamily;
  std::vector<WindowQuad> quads;
  const auto place = [&](double x, double y, double edge, double z) -> WindowQuad& {
    constexpr std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    WindowQuad& quad = quads.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {x + edge * corners[i][0], y + edge * corners[i][1], z, 1};
    return quad;
  };
  for (const auto family : {general, any_w, eye_crossing, on_vertex, perspective})
    for (WindowQuad& quad :
         golden::make_stress(family, 1, 11, 1.0, every_key_size, every_key_size, every_key_attributes))
      quads.push_back(std::move(quad));
  for (int n = 0; n < 24; ++n) {
    WindowQuad& quad = place(1.3 + 5 * (n % 7), 2.7 + 9 * (n / 7), n % 3 == 0 ? 12 : 4, n % 2 == 0 ? 0.2999 : 0.5);
    for (std::size_t i = 0; i < 4; ++i) {
      const double v = static_cast<double>(i);
      quad.attribute[i] = {2 - 0x1p-27, 0.1 * v * (n % 5), 0.7 + 1e-5 * v};  // the first: 2 in a format
      if (n % 4 == 1) quad.vertex[i].z += 0.07 * (v - 1);
      if (n % 5 == 0) quad.attribute[i][2] = i == 1 || i == 2 ? 0.25 : 0.75;  // plane
    }
  }
  // Past the guard band of narrower coordinates, and of all.
  for (const double far : {9000.0, 40000.0}) {
    WindowQuad& quad = place(3.3, 4.4, 20, 0.4);
    quad.vertex[2].x = far;
    for (std::size_t i = 0; i < 4; ++i) quad.attribute[i].assign(every_key_attributes, 0.25 * static_cast<double>(i));
  }
  // Open to the right behind the eye. The upper edge is nearer to the centres of a row than a coarse step: how a
  // homogeneous vertex is rounded decides on the row.
  for (const double beside : {-0x1p-13, 0x1p-13}) {
    WindowQuad& quad = place(3.25, 10.5, 14, 0.5);
    quad.vertex[1] = {20, beside - 10.5, -0.5, -1};
    quad.vertex[2] = {20, -24.5, -0.5, -1};
    for (auto& values : quad.attribute) values.assign(every_key_attributes, 0.5);
  }
  for (std::size_t q = 0; q < quads.size(); ++q) quads[q].id = static_cast<std::uint32_t>(q);
  return quads;
}

inline DrawState state_for_every_key() {
  DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = every_key_size;
  state.attributes = every_key_attributes;
  state.znear = 0.3, state.zfar = 0.9;
  state.skip |= skip_plane;
  return state;
}

/// Configurations around which every key moves what it does: by default, with few bits, with hidden tiles.
inline const std::array<Config, 3>& bases_for_every_key() {
  static const std::array<Config, 3> bases = [] {
    std::array<Config, 3> list;
    Config &narrow = list[1], &hidden = list[2];
    narrow.significand_bits = 11, narrow.subpixel_bits = 6, narrow.depth_bits = 12, narrow.attribute_frac_bits = 14;
    narrow.sqrt_segments_log2 = narrow.recip_segments_log2 = narrow.dot_units = 4, narrow.quadratic_frac_bits = 8;
    hidden.hierarchical_z_bits = 8, hidden.tile_log2 = hidden.pixels_per_clock = 2;
    return list;
  }();
  return bases;
}

/// All of a key's values, or where these are many the ends of its range and values on both sides of its default.
inline std::set<int> values_of(const ConfigKey& key) {
  std::set<int> values{key.minimum, key.maximum};
  const int middle = Config().resolved(key.name);
  for (int value = key.minimum; value < key.maximum; ++value)
    if (key.maximum - key.minimum < 8 || value == middle - 2 || value == middle + 1) values.insert(value);
  return values;
}

/// `base` with each of these values of a key that can be built.
inline std::vector<Config> configs_around(const Config& base, const ConfigKey& key) {
  std::vector<Config> configs;
  for (const int value : values_of(key)) {
    Config config = base;
    config.set(key.name, value);
    try {
      config.validate();
      configs.push_back(config);
    } catch (const ConfigError&) {
    }
  }
  return configs;
}

}  // namespace quadrille
