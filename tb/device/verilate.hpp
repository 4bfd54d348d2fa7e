// Verilating on demand: a configuration of the machine becomes a shared object behind device_abi.h, kept in a cache.
//
// The cache is $QUADRILLE_CACHE, else $XDG_CACHE_HOME/quadrille, else $HOME/.cache/quadrille, else the build directory.
// An entry's name is a hash over everything that decides its contents: the bytes of the RTL sources, of the table
// package and of the glue, every configuration key, the options below, Verilator's and the compiler's version. An entry
// is built beside its place under a lock and renamed into it, so two programs may ask for the same one at the same
// time.
#pragma once

#include "model/config.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille::tb {

struct VerilateOptions {
  bool probes = true;      ///< outputs at the stage boundaries (rtl/README.md section 6)
  bool trace = false;      ///< FST waveforms
  bool assertions = true;  ///< --assert
  int optimise = 2;        ///< g++ -O level of the simulated clock; 0-3
  unsigned jobs = 0;       ///< compilers at a time; 0: one per processor
  /// Sources instead of the project's: a directory with *.sv, or one Verilog file that has the tables and every module.
  std::filesystem::path source;
  /// Further files, read after the others.
  std::vector<std::filesystem::path> extra;
  /// Further arguments of Verilator.
  std::vector<std::string> arguments;
};

/// Verilator or the C++ compiler refused; the text has the log's path and its last lines.
struct VerilateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Path of the shared object for `config`, built now if the cache has none. Throws EnvironmentError when a tool is
/// missing or the cache cannot be written, VerilateError when the sources do not build.
std::filesystem::path verilate(const Config& config, const VerilateOptions& options = {});

/// The cache's directory, created if need be.
std::filesystem::path cache_directory();

/// The arguments -DQUADRILLE_<KEY>=value for every key of the configuration (-1, automatic, is passed on as it is).
std::vector<std::string> key_defines(const Config& config);

/// FNV-1a, 128 bits, over length-prefixed pieces.
class Fingerprint {
 public:
  void add(std::string_view piece);
  void add_file(
      const std::filesystem::path& file);  ///< name and contents; throws EnvironmentError when it cannot be read
  std::string hex() const;

 private:
  void byte(unsigned char b);
  unsigned __int128 hash_ = (static_cast<unsigned __int128>(0x6c62272e07bb0142u) << 64) | 0x62b821756295c58du;
};

}  // namespace quadrille::tb
