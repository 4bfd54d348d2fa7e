// What the tests of cosim share.
#pragma once

#include "model/untimed.hpp"

#include <cctype>
#include <fstream>

namespace quadrille::tb {
namespace {

/// A configuration by name.
struct Named {
  const char* name;
  std::vector<std::pair<const char*, int>> keys;

  Config config() const {
    Config c;
    for (const auto& [key, value] : keys) c.set(key, value);
    return c;
  }
  friend std::ostream& operator<<(std::ostream& out, const Named& n) { return out << n.name; }
};

inline const Named standard{"standard", {}};
const Named s12{"s12", {{"significand_bits", 12}}};
const Named s24{"s24", {{"significand_bits", 24}}};
/// Every fraction bit of D and R² dropped: R² of 0 and below, singular classes by truncation.
const Named coarse{"coarse", {{"significand_bits", 24}, {"quadratic_frac_bits", 0}}};
/// Every key away from its default, odd numbers wherever possible.
const Named odd{"odd",
                {{"viewport_bits", 9},
                 {"guard_bits", 1},
                 {"subpixel_bits", 5},
                 {"homogeneous_frac_bits", 9},
                 {"quadratic_frac_bits", 23},
                 {"significand_bits", 15},
                 {"notch_exact", 0},
                 {"sqrt_segments_log2", 8},
                 {"sqrt_degree", 1},
                 {"recip_segments_log2", 9},
                 {"recip_degree", 1},
                 {"align_guard_bits", 1},
                 {"attribute_slots", 3},
                 {"attribute_int_bits", 5},
                 {"attribute_frac_bits", 19},
                 {"depth_bits", 17},
                 {"tile_log2", 2},
                 {"pixels_per_clock", 2},
                 {"dot_units", 4},
                 {"quad_slots_log2", 1},
                 {"tile_slots_log2", 1},
                 {"stamp_fifo_log2", 1},
                 {"hierarchical_z_bits", 9},
                 {"hierarchical_z_tiles_log2", 7},
                 {"plane_quads", 1},
                 {"quad_id_bits", 13},
                 {"performance_counters", 1}}};

/// Four lanes, little in each.
const Named lanes{"lanes", {{"significand_bits", 10}, {"attribute_slots", 1}, {"pixels_per_clock", 4}}};

}  // namespace
}  // namespace quadrille::tb
