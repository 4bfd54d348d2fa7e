#pragma once

#include "model/skips/hierarchical_z.hpp"
#include "model/skips/masked_depth.hpp"

namespace quadrille::clocked {

/// The control of hierarchical_z: clocks in which words are wiped and no vertex is taken.
struct HierarchicalZ {
  static constexpr int section = 16;  ///< places that a clear wipes

  quadrille::HierarchicalZ memory;
  MaskedDepth masked;
  int wiping = 0;

  void reset(const Config& config) {
    memory = quadrille::HierarchicalZ(config);
    masked = MaskedDepth(config);
    wiping = config.hierarchical_z_bits != 0 ? 1 << config.hierarchical_z_tiles_log2 : 0;
  }
  void clock(bool clear, bool present) {
    if (wiping > 0) {
      --wiping;
    } else if (clear && present) {
      memory.clear();
      masked.clear();
      wiping = section;
    }
  }
};

}  // namespace quadrille::clocked
