// Verilating on demand: a configuration of the machine becomes a shared object behind device_abi.h, kept in the cache
// under a hash over the bytes of the RTL sources, of the table package and of the glue, every configuration key, the
// options below, Verilator's and the compiler's version. Ninja runs the compilers, through ccache where there is one.
#pragma once

#include "model/port/config.hpp"
#include "tb/device/cache.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

struct VerilateOptions {
  bool probes = true;      ///< outputs at the stage boundaries (rtl/SPEC.md, Probes)
  bool trace = false;      ///< FST waveforms
  bool assertions = true;  ///< --assert
  int optimise = 2;        ///< g++ -O level of the simulated clock; 0-3
  unsigned jobs = 0;       ///< compilers at a time; 0: one per processor
  /// Sources instead of the project's: a directory with *.sv, or one Verilog file that has the tables and every module,
  /// without probes (std::invalid_argument).
  std::filesystem::path source;
  /// Further files, read after the others.
  std::vector<std::filesystem::path> extra;
  std::string verilator;  ///< the program; empty: the one in PATH
  /// Further arguments of Verilator.
  std::vector<std::string> arguments;
};

/// Verilator or the C++ compiler refused; the text has the log's path and its last lines.
struct VerilateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A machine to load any number of times; its entry of the cache stays as long as this lives.
struct Simulator {
  CacheEntry entry;
  std::filesystem::path object() const { return entry.path() / "device.so"; }
};

/// The simulator of `config`, built now if the cache has none; a BuildNotice says so. Throws EnvironmentError when a
/// tool is missing or the cache cannot be written, VerilateError when the sources do not build.
Simulator verilate(const Config& config, const VerilateOptions& options = {});

/// The arguments -DQUADRILLE_<KEY>=value for every key of the configuration (-1, automatic, is passed on as it is).
std::vector<std::string> key_defines(const Config& config);

/// The keys that differ from their defaults, for people: "key=value key=value", or "default".
std::string summary(const Config& config);

}  // namespace quadrille::tb
