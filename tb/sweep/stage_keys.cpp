#include "tb/sweep/stage_keys.hpp"

namespace quadrille::sweep {

LevelKey level_key(const Config& c, Level level) {
  switch (level) {
    case Level::positions:
      return {c.viewport_bits, c.guard_bits, c.subpixel_bits, c.homogeneous_frac_bits};
    case Level::differences:
      return {c.quadratic_frac(), c.tile_log2};
    case Level::normalise:
      return {c.significand_bits};
    case Level::sqrt:
      return {c.sqrt_segments(), c.sqrt_degree};
    case Level::ratios:
      return {c.align_guard_bits};
    case Level::weights:
      return {};
    case Level::reciprocal:
      return {c.recip_segments(), c.recip_degree};
    case Level::output:
      return {c.attribute_int_bits, c.attribute_frac(), c.depth_bits};
    case Level::plane:
      return {c.plane_quads};
  }
  return {};
}

CyclesKey cycles_key(const Config& c) {
  return {c.tile_log2, c.dot_units, c.quad_slots_log2, c.tile_slots_log2, c.stamp_fifo_log2};
}

}  // namespace quadrille::sweep
