// Yosys as the second reader of the RTL: the Verilog that it writes back takes the source's place in a co-simulation, a
// full synthesis must end without a latch, and a synthesis for a target says how large a configuration really is.
#pragma once

#include "model/port/config.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace quadrille::tb {

/// `proc; opt; write_verilog` of the whole machine for `config`: one Verilog file in `directory`, fit for
/// LockstepOptions::source. Throws EnvironmentError without Yosys, VerilateError when Yosys refuses the sources.
std::filesystem::path yosys_verilog(const Config& config, const std::filesystem::path& directory);

struct SynthesisReport {
  std::uint64_t cells = 0;
  std::uint64_t latches = 0;
  std::uint64_t flip_flops = 0;
  std::uint64_t warnings = 0;
};

/// `synth -top quadrille`.
SynthesisReport yosys_synthesise(const Config& config, const std::filesystem::path& directory);

/// What a configuration is synthesised for.
enum class SynthesisTarget {
  ecp5,        ///< Lattice ECP5 with DSP blocks
  ecp5_nodsp,  ///< the same with multipliers in logic, so that `luts` is the whole machine
  cells,       ///< standard cells (OSU 0.18 µm), timed by OpenSTA
};
inline constexpr std::array<std::string_view, 3> synthesis_target_names{"ecp5", "ecp5-nodsp", "cells"};
/// Throws ConfigError naming the targets.
SynthesisTarget parse_synthesis_target(std::string_view name);

/// What was counted and timed; what a target does not have is empty.
struct HardwareSize {
  std::uint64_t flip_flops = 0;  ///< on an ECP5 without its memories, as cells with what memories become
  /// Sites of four-input LUTs: a LUT4 is one, a CCU2C (two bits of a carry chain) two, a TRELLIS_DPR16X4 (16 words of
  /// four bits) six: four hold the words, two go to the write port.
  std::optional<std::uint64_t> luts;
  std::optional<std::uint64_t> dsps;          ///< MULT18X18D
  std::optional<std::uint64_t> block_rams;    ///< DP16KD, PDPW16KD
  std::optional<std::uint64_t> longest_path;  ///< cells from register to register: LUT4, CCU2C, DSP, read of a memory
  std::optional<double> area_um2;
  std::optional<double> nand2;  ///< area in two-input NANDs of the library
  std::optional<double> mhz;
  std::string critical_path;  ///< from where to where, through what

  friend bool operator==(const HardwareSize&, const HardwareSize&) = default;
};

/// Runs scripts/size.py or scripts/timing.py, who own how the RTL is synthesised and counted: minutes of one core and 1
/// to 2 GB. Results are kept in the cache (tb/device/cache.hpp) under a hash of the RTL sources, the configuration, the
/// scripts and the tools. Throws ConfigError for a configuration that cannot be built, EnvironmentError without a tool,
/// VerilateError when a tool refuses the sources.
HardwareSize synthesise_for(const Config& config, SynthesisTarget target);

}  // namespace quadrille::tb
