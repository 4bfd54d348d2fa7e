#include "tb/yosys.hpp"

#include "model/tables.hpp"
#include "tb/environment_error.hpp"
#include "tb/process.hpp"
#include "tb/source_paths.hpp"
#include "tb/verilate.hpp"

#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

/// `read_verilog` of tables, packages and modules with the configuration's defines.
std::string read_commands(const Config& config, bool probes, const fs::path& directory) {
  const fs::path tables = directory / "quadrille_tables_pkg.sv";
  std::ofstream out(tables);
  out << tables_package(config);
  out.close();
  if (!out) throw EnvironmentError("cannot write " + tables.string());
  std::string command = "read_verilog -sv -DSYNTHESIS=1";
  for (const std::string& define : key_defines(config)) command += " " + define;
  if (probes) command += " -DQUADRILLE_PROBES=1";
  command += " \"" + tables.string() + "\"";
  for (const fs::path& source : rtl_sources(rtl_directory())) command += " \"" + fs::absolute(source).string() + "\"";
  return command + "\nhierarchy -check -top quadrille\n";
}

/// Runs a script; returns the log's path.
fs::path run(const std::string& script, const fs::path& directory, const std::string& stem) {
  const std::string yosys = find_program("yosys", "yosys");
  const fs::path file = directory / (stem + ".ys"), log = directory / (stem + ".log");
  std::ofstream(file) << script;
  fs::remove(log);
  const std::vector<std::string> command{yosys, "-s", file.string()};
  if (run_logged(command, directory, log) != 0) {
    throw VerilateError("Yosys failed; log " + log.string() + ", which ends:\n" + tail_of(log, 25));
  }
  return log;
}

}  // namespace

fs::path yosys_verilog(const Config& config, bool probes, const fs::path& directory) {
  fs::create_directories(directory);
  const fs::path verilog = directory / "quadrille_yosys.v";
  run(read_commands(config, probes, directory) + "proc\nopt\nwrite_verilog -noattr \"" + verilog.string() + "\"\n",
      directory, "roundtrip");
  return verilog;
}

SynthesisReport yosys_synthesise(const Config& config, const fs::path& directory) {
  fs::create_directories(directory);
  const fs::path log =
      run(read_commands(config, false, directory) + "synth -top quadrille\ncheck -assert\nstat\n", directory, "synth");
  std::ifstream in(log);
  SynthesisReport report;
  // The last statistics count the whole design ("design hierarchy" sums over instances where there is more than one
  // module).
  constexpr std::string_view total = "Number of cells:";
  for (std::string line; std::getline(in, line);) {
    if (line.find("=== ") != std::string::npos) {
      report.cells = report.latches = report.flip_flops = 0;
    } else if (const std::size_t at = line.find(total); at != std::string::npos) {
      report.cells = std::stoull(line.substr(at + total.size()));
    } else if (line.starts_with("Warning:")) {
      ++report.warnings;
    } else {
      std::istringstream words(line);  // $_DFF_P_ 123
      std::string cell, rest;
      std::uint64_t count = 0;
      if (!(words >> cell >> count) || words >> rest || !cell.starts_with("$")) continue;
      if (cell.starts_with("$dlatch") || cell.starts_with("$_DLATCH") || cell.starts_with("$sr") ||
          cell.starts_with("$_SR_")) {
        report.latches += count;
      } else if (cell.find("DFF") != std::string::npos || cell.find("dff") != std::string::npos) {
        report.flip_flops += count;
      }
    }
  }
  return report;
}

}  // namespace quadrille::tb
