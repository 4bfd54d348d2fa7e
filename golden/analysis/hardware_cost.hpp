// What a configuration costs in hardware, counted from its derived widths: no synthesis, microseconds.
//
// The counts follow rtl/ module by module: what a good synthesis of the flattened machine has to keep, so a disabled
// feature counts nothing. The RTL is the machine, this is an estimate of its size; README.md says how good it is.
#pragma once

#include "model/port/config.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille {

/// Resources of a module or of the machine.
struct HardwareCost {
  std::uint64_t state_bits = 0;       ///< pipeline registers, delay lines, contexts, memories, FIFOs
  std::uint64_t multiplier_bits = 0;  ///< Σ (bits of one operand × bits of the other)
  std::uint64_t adder_bits = 0;   ///< Σ result bits of adders, subtracters, comparators, multiplexers (once for each
                                  ///< choice but the first) and of the stages of shifters; tests for zero a third; the
                                  ///< LUTs of small RAMs, one and a half a bit of each read port
  std::uint64_t table_bits = 0;   ///< bits of the sqrt and reciprocal ROMs that are logic, each copy counted, without
                                  ///< those that are the same in every word
  std::uint64_t dsps = 0;         ///< blocks of 18 × 18 bits that the multipliers take where there are such
  std::uint64_t join_bits = 0;    ///< adder bits that join the blocks of one multiplier, there
  std::uint64_t memory_bits = 0;  ///< of state_bits those that a target with memories keeps in them
  std::uint64_t block_rams = 0;   ///< of 18 Kbit, there: deep FIFOs and large ROMs

  HardwareCost& operator+=(const HardwareCost& other);
  friend bool operator==(const HardwareCost&, const HardwareCost&) = default;
};

/// What a bit of each resource, a DSP block and a block RAM cost, in LUTs of four inputs. A target weighs what it has:
/// multipliers are DSP blocks or logic, never both. The defaults are those of an ECP5 with DSP blocks. Given in a
/// configuration file as the table [cost].
struct CostWeights {
  double state = 0.001, multiplier = 0, adder = 1, table = 0.106, dsp = 536, join = 1.26, block_ram = 402;

  friend bool operator==(const CostWeights&, const CostWeights&) = default;
};

/// Lattice ECP5 with DSP blocks: a block costs as many LUTs as the largest device has for each of its own (83,640 /
/// 156 DSP blocks, 83,640 / 208 block RAMs).
inline constexpr CostWeights ecp5_weights{};
/// The same with multipliers in logic: all in one number. A fit to synthesis (README.md, "Hardware cost"), save state:
/// a flip-flop sits beside a LUT and takes none, but it is not free.
inline constexpr CostWeights ecp5_nodsp_weights{
    .state = 0.001, .multiplier = 2.73, .adder = 1, .table = 0.106, .dsp = 0, .join = 0, .block_ram = 402};

struct ModuleCost {
  std::string module;  ///< name in rtl/
  HardwareCost cost;   ///< of all its instances, with what they instantiate that has no row of its own
};

/// Every module of the pipeline, front to back; together they are the whole machine. The configuration must pass
/// Config::validate().
std::vector<ModuleCost> module_costs(const Config& config);
/// The sum.
HardwareCost hardware_cost(const Config& config);
/// The LUTs among the cost: everything but the blocks.
double lut_cost(const HardwareCost& cost, const CostWeights& weights);
/// Scalar cost in LUTs, DSP blocks and block RAMs at their price.
double scalar_cost(const HardwareCost& cost, const CostWeights& weights);

}  // namespace quadrille
