// What a configuration costs in hardware, counted from its derived widths: no synthesis, microseconds.
#pragma once

#include "model/config.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille {

/// Resources of a module or of the machine.
struct HardwareCost {
  std::uint64_t state_bits = 0;       ///< flip-flops: pipeline registers, contexts, FIFOs
  std::uint64_t multiplier_bits = 0;  ///< Σ (bits of one operand × bits of the other)
  std::uint64_t adder_bits = 0;       ///< Σ result bits of adders, subtracters, comparators and shifters' stages
  std::uint64_t table_bits = 0;       ///< bits of the rsqrt and reciprocal ROMs, each copy counted

  HardwareCost& operator+=(const HardwareCost& other);
};

/// What a bit of each resource costs, in LUTs of four inputs. The defaults are a fit to Yosys `synth_ecp5`; README says
/// how to repeat it. Given in a configuration file as the table [cost].
struct CostWeights {
  double state = 1, multiplier = 1, adder = 1, table = 1;

  friend bool operator==(const CostWeights&, const CostWeights&) = default;
};

struct ModuleCost {
  std::string module;  ///< name in rtl/
  HardwareCost cost;   ///< of all its instances
};

/// Per module of rtl/, in the order of the pipeline.
std::vector<ModuleCost> module_costs(const Config& config);
/// The sum.
HardwareCost hardware_cost(const Config& config);
/// Scalar cost in LUTs.
double scalar_cost(const HardwareCost& cost, const CostWeights& weights);

}  // namespace quadrille
