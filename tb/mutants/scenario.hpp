// The draw that every mutant is put through: small, but every unit of the machine works in it.
#pragma once

#include "golden/scenes/random_quads.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <vector>

namespace quadrille::tb {

inline LockstepOptions mutant_options() {
  LockstepOptions options;
  options.config.set("significand_bits", 12);
  options.state = small_state(options.config);
  options.state.scissor_x0 = 1;
  options.state.scissor_y1 -= 3;
  options.state.scissor_x1 -= 3;  // not on a tile's border
  options.seed = 5;
  options.stall = 0.3;
  options.gap = 0.1;
  options.watchdog = 20'000;
  options.optimise = 1;
  return options;
}

inline std::vector<SnappedQuad> mutant_quads(const LockstepOptions& options) {
  return random_quads(options.config, options.state, 31, 300);
}

}  // namespace quadrille::tb
