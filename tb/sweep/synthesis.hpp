// Synthesis of chosen points of a sweep, several at a time.
#pragma once

#include "golden/analysis/hardware_cost.hpp"
#include "model/config.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadrille::sweep {

struct SynthesisPoint {
  std::size_t row = 0;  ///< position in the grid
  Config config;
};

/// One row of synth.csv; what is counted: tb::FpgaReport.
struct SynthesisRow {
  std::size_t row = 0;
  std::uint64_t luts = 0, flip_flops = 0, dsps = 0, longest_path = 0;
  double cost = 0;  ///< the estimate, scalar_cost() with the weights given

  friend bool operator==(const SynthesisRow&, const SynthesisRow&) = default;
};

/// Synthesises the points on up to `threads` processors, each with a Yosys of its own (about 2 GB); results in the
/// order of the points. `progress` (may be empty) gets the number of
/// points done on the calling thread now and then. Configurations
/// synthesised before come from the cache. The first failure ends the call once the running syntheses are done:
/// EnvironmentError without Yosys, VerilateError when it fails, ConfigError for a point that cannot be built.
std::vector<SynthesisRow> synthesise(std::span<const SynthesisPoint> points, const CostWeights& weights,
                                     unsigned threads,
                                     const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace quadrille::sweep
