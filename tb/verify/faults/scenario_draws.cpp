#include "tb/verify/faults/scenario_draws.hpp"

#include "golden/scenes/random_quads.hpp"

#include <initializer_list>
#include <utility>

namespace quadrille::tb {
namespace {

Config with(Config config, std::initializer_list<std::pair<const char*, int>> keys) {
  for (const auto& [key, value] : keys) config.set(key, value);
  return config;
}

}  // namespace

const Config& exact() {
  static const Config config = with({}, {{"significand_bits", 12}});
  return config;
}

const Config& reduced() {
  static const Config config = with({}, {{"significand_bits", 15},
                                         {"quadratic_frac_bits", 8},
                                         {"notch_exact", 0},
                                         {"tile_log2", 2},
                                         {"dot_units", 4},
                                         {"quad_slots_log2", 1},
                                         {"tile_slots_log2", 1},
                                         {"stamp_fifo_log2", 1},
                                         {"attribute_slots", 3},
                                         {"depth_bits", 16},
                                         {"performance_counters", 1}});
  return config;
}

const Config& four_lanes() {
  static const Config config =
      with(exact(), {{"attribute_slots", 1}, {"pixels_per_clock", 4}, {"performance_counters", 1}});
  return config;
}

const Config& hiding() {
  static const Config config = with(
      four_lanes(),
      {{"viewport_bits", 7}, {"attribute_slots", 3}, {"hierarchical_z_bits", 12}, {"hierarchical_z_tiles_log2", 6}});
  return config;
}

const Config& hiding_blocks() {
  static const Config config = with(hiding(), {{"viewport_bits", 8}, {"tile_log2", 2}});
  return config;
}

const Config& plane_weights() {
  static const Config config = with(exact(), {{"attribute_slots", 3}, {"plane_quads", 1}, {"performance_counters", 1}});
  return config;
}

LockstepOptions options(const Config& config, int edge) {
  LockstepOptions o;
  o.config = config;
  o.state = small_state(config, edge);
  o.seed = 5;
  o.watchdog = 20'000;
  return o;
}

std::vector<SnappedQuad> drawn(const LockstepOptions& o, std::uint64_t seed, int count, const Draw& draw) {
  golden::Prng random(seed, 17);
  std::vector<SnappedQuad> quads;
  while (static_cast<int>(quads.size()) < count) {
    WindowQuad quad = draw(random);
    quad.id = static_cast<std::uint32_t>(quads.size());
    for (auto& list : quad.attribute)  // slots that are not in use too
      while (static_cast<int>(list.size()) < o.config.attribute_slots) list.push_back(random.uniform(-7.9, 7.9));
    try {
      quads.push_back(snap_quad(quad, o.config, o.state));
    } catch (const SnapError&) {  // no point of the machine's space: draw another
    }
  }
  return quads;
}

WindowQuad on_grid(golden::Prng& random, int edge, std::span<const double> w) {
  WindowQuad quad;
  const double left = static_cast<double>(random.below(8)), top = static_cast<double>(random.below(8));
  for (WindowVertex& v : quad.vertex) {
    v.w = w[random.below(w.size())];
    v.x = (left + static_cast<double>(random.below(static_cast<std::uint64_t>(edge))) + 0.5) * v.w;
    v.y = (top + static_cast<double>(random.below(static_cast<std::uint64_t>(edge))) + 0.5) * v.w;
    v.z = random.uniform(0.05, 0.95) * v.w;
  }
  return quad;
}

bool corners_meet(const WindowQuad& quad) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const WindowVertex &a = quad.vertex[i], &b = quad.vertex[j];
      if (a.x * b.w == b.x * a.w && a.y * b.w == b.y * a.w) return true;
    }
  return false;
}

void halve(SnappedQuad& quad) {
  for (const std::size_t i : {1, 3}) {
    SnappedVertex& v = quad.vertex[i];
    v.x /= 2;
    v.y /= 2;
    v.w /= 2;
    if (v.z.sig != 0) v.z.exp -= 1;
  }
}

}  // namespace quadrille::tb
