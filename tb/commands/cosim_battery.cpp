#include "tb/commands/cosim_battery.hpp"

#include "golden/scenes/corner_quads.hpp"
#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/random_state.hpp"
#include "golden/scenes/stress.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille::tb {

namespace {

constexpr std::uint64_t stream = 220;

/// A draw of quads as the port gets them.
PlannedDraw port_draw(std::vector<SnappedQuad> quads, const DrawState& state) {
  PlannedDraw draw;
  draw.quads.resize(quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i) {
    quads[i].id = draw.quads[i].id = static_cast<std::uint32_t>(i);
  }
  draw.at_port = std::move(quads);
  draw.state = state;
  return draw;
}

/// Waits in turn, and what comes before the draw: a clear, a reset, another power-on.
void place(PlannedDraw& draw, std::size_t number, const Config& config, std::uint64_t seed) {
  golden::Prng rng(seed + number, stream + 9);
  draw.id_bits = random_id_bits(config, rng);
  draw.seed = seed + number;
  draw.flush = flush_chance(number);
  draw.waits = static_cast<WaitKind>(number % wait_kind_names().size());
  if (draw.waits == WaitKind::chance && number % 2 == 1) draw.stall = 0.5, draw.gap = 0.1;
  draw.clears = 1;
}

DrawState random_state(const Config& config, const DrawState& state, std::span<const WindowQuad> quads,
                       golden::Prng& rng) {
  DrawState drawn = golden::random_draw_state(config, state.width, state.height, quads, rng.next());
  if (config.hierarchical_z_bits != 0 && rng.chance(0.5)) drawn.skip |= skip_hidden;
  return with_possible_skips(drawn, config);
}

/// Every corner group in the state that it needs, with the operands of all pixels: what is held hides faults.
std::vector<PlannedDraw> corners(const Config& config, std::uint64_t seed) {
  std::vector<PlannedDraw> draws;
  for (golden::CornerDraw& corner : golden::corner_draws(config, seed)) {
    corner.state.skip &= ~std::uint32_t{skip_operands};
    PlannedDraw draw = port_draw(std::move(corner.quads), corner.state);
    place(draw, draws.size(), config, seed);
    if (corner.stall > 0) {
      draw.waits = WaitKind::chance;
      draw.stall = corner.stall;
      draw.gap = 0;
    }
    draws.push_back(std::move(draw));
  }
  return draws;
}

/// The same quads in states at random; of the limits of depth half of the draws keep those that the group is about.
std::vector<PlannedDraw> varied_corners(const Config& config, std::uint64_t seed) {
  golden::Prng rng(seed, stream);
  std::vector<PlannedDraw> draws;
  for (golden::CornerDraw& corner : golden::corner_draws(config, seed + 1)) {
    // Those over a large viewport are about its borders, which they keep.
    if (corner.state.width > 64) continue;
    DrawState state = random_state(config, corner.state, {}, rng);
    if (rng.chance(0.5)) {
      state.depth = corner.state.depth;
      state.znear = corner.state.znear;
      state.zfar = corner.state.zfar;
    }
    PlannedDraw draw = port_draw(std::move(corner.quads), with_possible_skips(state, config));
    place(draw, draws.size() + 2, config, seed);
    draw.clears = static_cast<unsigned>(rng.below(2));
    draws.push_back(std::move(draw));
  }
  return draws;
}

/// Quads of all kinds; the draws come after a power-on, after a reset in the middle of the one before, or go on.
std::vector<PlannedDraw> random_draws(const Config& config, std::uint64_t seed) {
  golden::Prng rng(seed, stream + 1);
  std::vector<PlannedDraw> draws;
  constexpr std::size_t count = 48;
  for (std::size_t d = 0; d < count; ++d) {
    DrawState base = small_state(config, 24 + static_cast<int>(rng.below(40)));
    if (d % 5 == 3) {  // a few pixels
      base.width = base.scissor_x1 = 1 + static_cast<int>(rng.below(9));
      base.height = base.scissor_y1 = 1 + static_cast<int>(rng.below(9));
    }
    if (d % 8 == 0) base.skip &= ~std::uint32_t{skip_operands};
    const DrawState state = d % 4 == 0 ? base : random_state(config, base, {}, rng);
    PlannedDraw draw = port_draw(random_quads(config, state, seed + d, 30), state);
    place(draw, d, config, seed);
    draw.power_on = d % 4 == 2;
    draw.reset = d % 4 == 1;
    if (d % 4 == 0) draw.limit = 1 + rng.below(300);  // a reset in the middle
    draws.push_back(std::move(draw));
  }
  return draws;
}

/// The state of registers before reset, by many seeds.
std::vector<PlannedDraw> power_on_draws(const Config& config, std::uint64_t seed) {
  std::vector<PlannedDraw> draws;
  for (std::size_t d = 0; d < 24; ++d) {
    DrawState state = small_state(config, 20);
    if (config.hierarchical_z_bits != 0) state.skip |= skip_hidden;
    if (config.plane_quads != 0) state.skip |= skip_plane;
    PlannedDraw draw = port_draw(random_quads(config, state, seed + 40 + d, 5), state);
    draw.power_on = true;
    draw.seed = seed + d;
    draws.push_back(std::move(draw));
  }
  return draws;
}

/// Of a stress family, which has four weights besides.
int attributes_of(const Config& config) { return std::min(config.attribute_slots, 4); }

/// Of those that snapping takes.
std::vector<WindowQuad> that_snap(std::vector<WindowQuad> quads, const Config& config, const DrawState& state) {
  std::erase_if(quads, [&](const WindowQuad& quad) {
    try {
      WindowQuad full = quad;
      for (auto& list : full.attribute) list.resize(static_cast<std::size_t>(config.attribute_slots));
      snap_quad(full, config, state);
      return false;
    } catch (const SnapError&) {
      return true;
    }
  });
  return quads;
}

/// Every stress family.
std::vector<PlannedDraw> families(const Config& config, std::uint64_t seed) {
  golden::Prng rng(seed, stream + 2);
  std::vector<PlannedDraw> draws;
  for (std::size_t n = 0; n < 3 * golden::stress_families().size(); ++n) {
    const golden::StressFamilyInfo& family = golden::stress_families()[n % golden::stress_families().size()];
    DrawState state = small_state(config, 40);
    state.height = state.scissor_y1 = 27;  // no multiple of a tile
    PlannedDraw draw;
    draw.quads = that_snap(golden::make_stress_without_weights(family.family, 8, seed + n, state.width, state.height,
                                                               attributes_of(config)),
                           config, state);
    draw.state = draws.size() % 3 == 0 ? state : random_state(config, state, draw.quads, rng);
    place(draw, draws.size(), config, seed);
    draws.push_back(std::move(draw));
  }
  return draws;
}

/// A wall over all of the viewport in two parts, which meet within tiles, and quads behind it and before it: hidden
/// tiles, masks and blocks through draws, clears, epochs and resets.
std::vector<PlannedDraw> layers(const Config& config, std::uint64_t seed) {
  if (config.hierarchical_z_bits == 0) return {};
  golden::Prng rng(seed, stream + 3);
  // More than a block of tiles in both directions, and no whole number of tiles.
  const int tile = config.tile(), most = 1 << config.viewport_bits;
  const int width = std::min(17 * tile + 2, most), height = std::min(9 * tile + 3, most);
  const std::size_t count = tile > 8 ? 10 : 30, each = 12;
  const double step = std::ldexp(1, -std::min(config.hierarchical_z_bits, 12));
  std::vector<WindowQuad> quads;
  const auto add = [&](double x0, double x1, double x2, double x3, double top, double bottom, double z, double lean) {
    WindowQuad quad;
    quad.id = static_cast<std::uint32_t>(quads.size());
    quad.vertex = {{{x0, top, z, 1}, {x1, bottom, z + lean, 1}, {x2, bottom, z + lean, 1}, {x3, top, z, 1}}};
    if (rng.chance(0.15)) std::swap(quad.vertex[1], quad.vertex[3]);
    for (auto& attribute : quad.attribute)
      for (int j = 0; j < config.attribute_slots; ++j) attribute.push_back(rng.uniform(-1, 1));
    quads.push_back(std::move(quad));
  };
  for (std::size_t d = 0; d < count; ++d) {
    const double wall = rng.uniform(0.1, 0.5), a = rng.uniform(0, width), b = a + rng.uniform(-tile, tile);
    add(-4, -4, b, a, -4, height + 4, wall, rng.chance(0.5) ? 0 : step);
    add(a, b, width + 4, width + 4, -4, height + 4, wall + (rng.chance(0.5) ? 0 : 2 * step), 0);
    for (std::size_t i = 2; i < each; ++i) {
      const double x = rng.uniform(-tile, width), y = rng.uniform(-tile, height);
      const double w = rng.uniform(tile, width), h = rng.uniform(tile, height);
      const double z = rng.chance(0.3)   ? wall + step * static_cast<double>(rng.integer(-3, 3))
                       : rng.chance(0.8) ? rng.uniform(wall, 0.95)
                                         : rng.uniform(0.02, wall);
      const double slope = rng.chance(0.3) ? rng.uniform(-0.1, 0.1) : 0;
      add(x, x + rng.uniform(-4, 4), x + w, x + w, y, y + h, z, slope);
    }
  }
  return plan_draws(quads, count, config, width, height, seed);
}

/// Quads that take setup long and pixels few, at every distance from one another.
std::vector<PlannedDraw> phases(const Config& config, std::uint64_t seed) {
  std::vector<PlannedDraw> draws;
  for (const golden::StressFamily family : {golden::StressFamily::eye_in_hull, golden::StressFamily::any_w}) {
    for (const std::uint32_t skip : {skip_default & ~skip_walk, skip_default, std::uint32_t{0}}) {
      PlannedDraw draw;
      DrawState state = small_state(config, 16);
      state.skip = skip;
      draw.quads = that_snap(
          golden::make_stress_without_weights(family, 100, seed, state.width, state.height, attributes_of(config)),
          config, state);
      draw.state = state;
      draw.waits = draws.size() % 2 == 0 ? WaitKind::locked : WaitKind::sparse;
      draw.seed = seed + draws.size();
      draws.push_back(std::move(draw));
    }
  }
  return draws;
}

/// A large viewport, a small scissor somewhere in it, quads that reach far beyond.
std::vector<PlannedDraw> far_scissors(const Config& config, std::uint64_t seed) {
  golden::Prng rng(seed, stream + 4);
  std::vector<PlannedDraw> draws;
  const int size = std::min(1 << config.viewport_bits, 128 * config.tile());
  const std::array kinds{golden::StressFamily::huge,   golden::StressFamily::eye_crossing,
                         golden::StressFamily::w_zero, golden::StressFamily::long_span,
                         golden::StressFamily::any_w,  golden::StressFamily::general};
  for (std::size_t n = 0; n < 3 * kinds.size(); ++n) {
    const golden::StressFamily family = kinds[n % kinds.size()];
    PlannedDraw draw;
    DrawState state = small_state(config, size);
    draw.quads = that_snap(golden::make_stress_without_weights(family, 8, seed + n, size, size, attributes_of(config)),
                           config, state);
    state = random_state(config, state, draw.quads, rng);
    const auto part = [&](int& first, int& last) {
      const int length = rng.chance(0.1) ? 0 : std::min(size, 1 + static_cast<int>(rng.below(40)));
      first =
          rng.chance(0.3) ? size - length : static_cast<int>(rng.below(static_cast<std::uint64_t>(size - length + 1)));
      last = first + length;
    };
    part(state.scissor_x0, state.scissor_x1);
    part(state.scissor_y0, state.scissor_y1);
    draw.state = state;
    place(draw, draws.size(), config, seed);
    draws.push_back(std::move(draw));
  }
  return draws;
}

struct Machine {
  const char* name;
  std::vector<std::string> settings;
};

std::vector<Machine> machines() {
  return {
      {"lanes",
       {"significand_bits=12", "attribute_slots=3", "pixels_per_clock=4", "viewport_bits=8", "hierarchical_z_bits=12",
        "hierarchical_z_tiles_log2=6", "performance_counters=1"}},
      {"odd",
       {"viewport_bits=9",
        "guard_bits=1",
        "subpixel_bits=5",
        "homogeneous_frac_bits=9",
        "quadratic_frac_bits=10",
        "significand_bits=15",
        "notch_exact=0",
        "sqrt_degree=1",
        "recip_degree=1",
        "align_guard_bits=1",
        "attribute_slots=3",
        "attribute_int_bits=5",
        "attribute_frac_bits=19",
        "depth_bits=17",
        "tile_log2=2",
        "pixels_per_clock=2",
        "dot_units=4",
        "quad_slots_log2=1",
        "tile_slots_log2=1",
        "stamp_fifo_log2=1",
        "hierarchical_z_bits=9",
        "hierarchical_z_tiles_log2=7",
        "plane_quads=1",
        "quad_id_bits=13",
        "performance_counters=1"}},
      {"default", {}},
      {"plane",
       {"significand_bits=12", "quadratic_frac_bits=6", "attribute_slots=2", "plane_quads=1", "quad_slots_log2=2",
        "depth_bits=12", "hierarchical_z_bits=12", "hierarchical_z_tiles_log2=6", "viewport_bits=8", "tile_log2=2",
        "performance_counters=1"}},
      {"wide",
       {"significand_bits=24", "attribute_slots=8", "depth_bits=30", "tile_log2=4", "dot_units=4", "stamp_fifo_log2=5",
        "tile_slots_log2=4", "hierarchical_z_bits=16", "hierarchical_z_tiles_log2=9"}},
  };
}

struct Input {
  const char* name;
  std::vector<PlannedDraw> (*draws)(const Config&, std::uint64_t seed);
};

constexpr Input inputs[]{
    {"random", random_draws}, {"corners", corners}, {"layers", layers},        {"varied", varied_corners},
    {"families", families},   {"phases", phases},   {"power", power_on_draws}, {"scissors", far_scissors},
};

}  // namespace

std::vector<BatteryGroup> battery_groups() {
  std::vector<BatteryGroup> groups;
  for (const Input& input : inputs)
    for (const Machine& machine : machines()) {
      const bool hides = std::ranges::any_of(machine.settings,
                                             [](const std::string& s) { return s.starts_with("hierarchical_z_bits"); });
      if (input.draws == layers && !hides) continue;
      groups.push_back({std::string(machine.name) + "." + input.name, machine.settings, input.draws});
    }
  return groups;
}

}  // namespace quadrille::tb
