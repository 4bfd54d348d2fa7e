// Synthesis of chosen points of a sweep, several at a time.
#pragma once

#include "golden/analysis/hardware_cost.hpp"
#include "model/port/config.hpp"
#include "tb/yosys/yosys.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::sweep {

struct SynthesisPoint {
  std::size_t row = 0;  ///< position in the grid
  Config config;
};

/// One row of synth.csv.
struct SynthesisRow {
  std::size_t row = 0;
  tb::SynthesisTarget target{};
  tb::HardwareSize size;
  // The estimates with the weights given.
  double cost = 0;              ///< scalar_cost()
  double cost_luts = 0;         ///< lut_cost()
  std::uint64_t cost_dsps = 0;  ///< 0 where multipliers are logic

  friend bool operator==(const SynthesisRow&, const SynthesisRow&) = default;
};

/// The weights that estimate a target. Those of standard cells rank their area: multipliers are logic there.
CostWeights weights_of(tb::SynthesisTarget target);

/// What `cost_luts` estimates: LUTs, or in its order the area of standard cells.
double measured_cost(const SynthesisRow& row);

/// synth.csv, header line first; empty cells are what the target does not have.
std::string synthesis_table(std::span<const SynthesisRow> rows);

/// Synthesises the points on up to `threads` processors, each with a Yosys of its own (about 2 GB); results in the
/// order of the points. `progress` (may be empty) gets the number of
/// points done on the calling thread now and then. Configurations
/// synthesised before come from the cache. The first failure ends the call once the running syntheses are done:
/// EnvironmentError without a tool of the target, VerilateError when it fails, ConfigError for a point that cannot be
/// built.
std::vector<SynthesisRow> synthesise(std::span<const SynthesisPoint> points, tb::SynthesisTarget target,
                                     const CostWeights& weights, unsigned threads,
                                     const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace quadrille::sweep
