#include "tb/sweep/stage_keys.hpp"

#include "model/plane_quad.hpp"
#include "model/plane_tolerance.hpp"

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
      return {c.plane_tolerance_bits};
  }
  return {};
}

CyclesKey cycles_key(const Config& c, const DrawState& state) {
  const bool looks = has_plane_tolerance(c) && takes_plane_quads(c, state);
  return {c.tile_log2,
          c.dot_units,
          c.quad_slots_log2,
          c.tile_slots_log2,
          c.stamp_fifo_log2,
          looks ? c.attribute_slots : 0,
          looks ? c.significand_bits : 0};
}

}  // namespace quadrille::sweep
