#include "golden/scenes/random_state.hpp"

#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace quadrille::golden {
namespace {

constexpr std::uint64_t stream = 200;

/// A half-open part of 0 … size that is at least a quarter of it.
std::pair<int, int> random_part(Prng& rng, int size) {
  const auto length = static_cast<int>(rng.integer((size + 3) / 4, size));
  const auto first = static_cast<int>(rng.integer(0, size - length));
  return {first, first + length};
}

/// The depth code of a vertex, halves up.
double corner_code(const WindowVertex& v, const Config& config) {
  return std::floor(std::ldexp(v.z / v.w, config.depth_bits) + 0.5);
}

/// A limit of window z: the code of some corner, the next one on either side, or any number.
double random_limit(Prng& rng, std::span<const WindowQuad> quads, const Config& config) {
  if (!quads.empty() && rng.chance(0.5)) {
    constexpr int tries = 16;
    for (int i = 0; i < tries; ++i) {
      const WindowQuad& quad = quads[rng.below(quads.size())];
      const WindowVertex& v = quad.vertex[rng.below(4)];
      if (v.w <= 0 || v.z < 0 || v.z > v.w) continue;
      const double code = corner_code(v, config) + static_cast<double>(rng.integer(-1, 1));
      return std::clamp(std::ldexp(code, -config.depth_bits), 0.0, 1.0);
    }
  }
  return rng.uniform();
}

}  // namespace

DrawState random_draw_state(const Config& config, int width, int height, std::span<const WindowQuad> quads,
                            std::uint64_t seed) {
  Prng rng(seed, stream);
  DrawState state;
  state.width = state.scissor_x1 = width;
  state.height = state.scissor_y1 = height;
  if (rng.chance(0.5)) {
    std::tie(state.scissor_x0, state.scissor_x1) = random_part(rng, width);
    std::tie(state.scissor_y0, state.scissor_y1) = random_part(rng, height);
  }
  if (rng.chance(0.5)) state.cull = rng.chance(0.5) ? Cull::front : Cull::back;
  state.perspective = rng.chance(0.5);
  state.depth = rng.chance(0.75);  // without depth there are no limits
  if (rng.chance(0.5)) state.znear = random_limit(rng, quads, config);
  if (rng.chance(0.5)) state.zfar = random_limit(rng, quads, config);
  if (state.znear > state.zfar) std::swap(state.znear, state.zfar);
  constexpr double least_interval = 0.25;  // so that most quads leave some fragments
  if (state.zfar - state.znear < least_interval) {
    if (state.znear < 1 - state.zfar)
      state.zfar = 1;
    else
      state.znear = 0;
  }
  if (rng.chance(0.5))
    state.attributes = static_cast<int>(rng.integer(1, config.attribute_slots));
  else
    state.attributes = config.attribute_slots;
  if (rng.chance(0.25)) state.skip &= ~std::uint32_t{skip_tiles};
  if (rng.chance(0.25)) state.skip &= ~std::uint32_t{skip_quads};
  if (config.hierarchical_z_bits != 0 && rng.chance(0.5) && state.depth) state.skip |= skip_hidden;
  if (rng.chance(0.25)) state.skip &= ~std::uint32_t{skip_walk};
  if (rng.chance(0.25)) state.skip &= ~std::uint32_t{skip_operands};
  if (config.plane_quads != 0 && rng.chance(0.5)) state.skip |= skip_plane;
  return state;
}

}  // namespace quadrille::golden
