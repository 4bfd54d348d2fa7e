#include "tb/commands/cosim_draws.hpp"

#include "golden/scenes/random_state.hpp"
#include "model/port/draw_state.hpp"

#include <algorithm>

namespace quadrille::tb {

namespace {

constexpr std::uint64_t draws_stream = 210;

/// The quads of draw d of `count`.
std::span<const WindowQuad> group(std::span<const WindowQuad> quads, std::size_t d, std::size_t count) {
  if (quads.size() < count) return quads.subspan(d % quads.size(), 1);
  const std::size_t first = d * quads.size() / count, last = (d + 1) * quads.size() / count;
  return quads.subspan(first, last - first);
}

DrawState draw_state(const Config& config, int width, int height, std::span<const WindowQuad> quads,
                     golden::Prng& rng) {
  DrawState state = golden::random_draw_state(config, width, height, quads, rng.next());
  if (rng.chance(0.35)) {  // nothing in the way: all of the viewport, nothing culled or cut
    const int attributes = state.attributes;
    state = draw_state_for(config, width, height);
    state.attributes = attributes;
  }
  if (config.hierarchical_z_bits != 0 && state.depth && rng.chance(0.7)) state.skip |= skip_hidden;
  return state;
}

unsigned random_clears(const Config& config, golden::Prng& rng) {
  const std::uint64_t kind = rng.below(8);
  if (config.hierarchical_z_bits == 0) return kind < 2 ? 1 : 0;
  constexpr int section_log2 = 4;  // rtl/SPEC.md, hierarchical_z: epochs
  const int epoch_bits = config.hierarchical_z_tiles_log2 - section_log2;
  // Half of the epochs: what is there comes back where the highest bit is not looked at; all: where none is.
  if (kind < 2) return 1u << std::max(0, epoch_bits - 1);
  return kind < 5 ? 1 : kind < 6 ? 2 : 0;
}

}  // namespace

std::uint32_t random_id_bits(const Config& config, golden::Prng& rng) {
  return static_cast<std::uint32_t>(rng.next() >> (64 - config.quad_id_bits));
}

// Rare: a quad that comes a beat in 33 clocks must get through.
double flush_chance(std::size_t draw) { return draw % 3 == 1 ? 0.01 : 0; }

std::vector<PlannedDraw> plan_draws(std::span<const WindowQuad> quads, std::size_t count, const Config& config,
                                    int width, int height, std::uint64_t seed) {
  golden::Prng rng(seed, draws_stream);
  std::vector<PlannedDraw> draws;
  if (quads.empty()) return draws;
  bool reset = false;
  for (std::size_t d = 0; d < count; ++d) {
    PlannedDraw draw;
    const auto add = [&](std::span<const WindowQuad> more) {
      draw.quads.insert(draw.quads.end(), more.begin(), more.end());
    };
    if (d > 0 && rng.chance(0.5)) add(group(quads, d - 1 - rng.below(std::min<std::size_t>(d, 3)), count));
    add(group(quads, d, count));
    draw.state = draw_state(config, width, height, draw.quads, rng);
    draw.reset = reset;
    draw.clears = d == 0 || reset ? 0 : random_clears(config, rng);
    draw.id_bits = random_id_bits(config, rng);
    draw.seed = seed + d;
    draw.flush = flush_chance(d);
    draw.waits = static_cast<WaitKind>(rng.below(wait_kind_names().size()));
    reset = rng.chance(0.15);
    if (reset && d + 1 < count && rng.chance(0.7)) draw.limit = 1 + rng.below(200);
    draws.push_back(std::move(draw));
  }
  return draws;
}

}  // namespace quadrille::tb
