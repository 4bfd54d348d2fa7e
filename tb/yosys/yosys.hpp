// Yosys as the second reader of the RTL: the Verilog that it writes back takes the source's place in a co-simulation, a
// full synthesis must end without a latch, and an FPGA mapping says how large a configuration really is.
#pragma once

#include "model/config.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace quadrille::tb {

/// `proc; opt; write_verilog` of the whole machine for `config`: one Verilog file in `directory`, fit for
/// LockstepOptions::source. Throws EnvironmentError without Yosys, VerilateError when Yosys refuses the sources.
std::filesystem::path yosys_verilog(const Config& config, bool probes, const std::filesystem::path& directory);

struct SynthesisReport {
  std::uint64_t cells = 0;
  std::uint64_t latches = 0;
  std::uint64_t flip_flops = 0;
  std::uint64_t warnings = 0;
};

/// `synth -top quadrille` without probes.
SynthesisReport yosys_synthesise(const Config& config, const std::filesystem::path& directory);

/// What a configuration takes on a Lattice ECP5, with its multipliers in logic, so that `luts` is the whole machine.
struct FpgaReport {
  /// Sites of four-input LUTs: a LUT4 is one, a CCU2C (two bits of a carry chain) two, a TRELLIS_DPR16X4 (16 words of
  /// four bits) six: four hold the words, two go to the write port.
  std::uint64_t luts = 0;
  std::uint64_t flip_flops = 0;    ///< TRELLIS_FF; memories are not among them
  std::uint64_t dsps = 0;          ///< MULT18X18D that the multipliers would take in place of their LUTs
  std::uint64_t block_rams = 0;    ///< DP16KD, PDPW16KD
  std::uint64_t longest_path = 0;  ///< cells from register to register: LUT4, CCU2C, a read of a memory

  friend bool operator==(const FpgaReport&, const FpgaReport&) = default;
};

/// `synth_ecp5` without probes: about two minutes of one core and 1 to 2 GB. Results are kept in the cache
/// (tb/device/verilate.hpp) under a hash of the RTL sources, the configuration, the script and Yosys's version. Throws
/// ConfigError for a configuration that cannot be built, EnvironmentError without Yosys, VerilateError when Yosys
/// refuses the sources.
FpgaReport synthesise_fpga(const Config& config);

}  // namespace quadrille::tb
