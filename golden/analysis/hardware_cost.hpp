// What a configuration costs in hardware, counted from its derived widths: no synthesis, microseconds.
//
// The counts follow rtl/ module by module: what a good synthesis of the flattened machine has to keep, so a disabled
// feature counts nothing. The RTL is the machine, this is an estimate of its size; README.md says how good it is.
#pragma once

#include "model/config.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille {

/// Resources of a module or of the machine.
struct HardwareCost {
  std::uint64_t state_bits = 0;       ///< pipeline registers, delay lines, contexts, memories, FIFOs
  std::uint64_t multiplier_bits = 0;  ///< Σ (bits of one operand × bits of the other)
  std::uint64_t adder_bits = 0;  ///< Σ result bits of adders, subtracters, comparators, multiplexers (once for each
                                 ///< choice but the first) and of the stages of shifters; tests for zero a third
  std::uint64_t table_bits = 0;  ///< bits of the rsqrt and reciprocal ROMs, each copy counted

  HardwareCost& operator+=(const HardwareCost& other);
  friend bool operator==(const HardwareCost&, const HardwareCost&) = default;
};

/// What a bit of each resource costs, in LUTs of four inputs. The defaults are a fit to synthesis (README.md,
/// "Hardware cost"), save that of state: a flip-flop sits beside a LUT and takes none, but it is not free. Given in a
/// configuration file as the table [cost].
struct CostWeights {
  double state = 0.01, multiplier = 2.76, adder = 0.874, table = 0.056;

  friend bool operator==(const CostWeights&, const CostWeights&) = default;
};

struct ModuleCost {
  std::string module;  ///< name in rtl/
  HardwareCost cost;   ///< of all its instances, with what they instantiate that has no row of its own
};

/// Every module of the pipeline, front to back; together they are the whole machine. The configuration must pass
/// Config::validate().
std::vector<ModuleCost> module_costs(const Config& config);
/// The sum.
HardwareCost hardware_cost(const Config& config);
/// Scalar cost in LUTs.
double scalar_cost(const HardwareCost& cost, const CostWeights& weights);

}  // namespace quadrille
