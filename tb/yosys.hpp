// Yosys as the second reader of the RTL: the Verilog that it writes back takes the source's place in a co-simulation,
// and a full synthesis must end without a latch.
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

}  // namespace quadrille::tb
