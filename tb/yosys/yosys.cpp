#include "tb/yosys/yosys.hpp"

#include "model/tables.hpp"
#include "tb/device/verilate.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <array>
#include <fstream>
#include <optional>
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

/// Runs a script in `directory`.
void run(const std::string& script, const fs::path& directory, const std::string& stem, const fs::path& log) {
  const std::string yosys = find_program("yosys", "yosys");
  const fs::path file = directory / (stem + ".ys");
  std::ofstream(file) << script;
  fs::remove(log);
  const std::vector<std::string> command{yosys, "-s", file.string()};
  if (run_logged(command, directory, log) != 0) {
    throw VerilateError("Yosys failed; log " + log.string() + ", which ends:\n" + tail_of(log, 25));
  }
}

}  // namespace

fs::path yosys_verilog(const Config& config, bool probes, const fs::path& directory) {
  fs::create_directories(directory);
  const fs::path verilog = directory / "quadrille_yosys.v";
  run(read_commands(config, probes, directory) + "proc\nopt\nwrite_verilog -noattr \"" + verilog.string() + "\"\n",
      directory, "roundtrip", directory / "roundtrip.log");
  return verilog;
}

SynthesisReport yosys_synthesise(const Config& config, const fs::path& directory) {
  fs::create_directories(directory);
  const fs::path log = directory / "synth.log";
  run(read_commands(config, false, directory) + "synth -top quadrille\ncheck -assert\nstat\n", directory, "synth", log);
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

namespace {

/// Synthesis for ECP5, faster than one flat run:
/// - The modules listed stay apart: each is optimised and mapped once however often it is instantiated. The rest is
///   flattened, so that the constants of a table or of a feature that is off reach the logic behind them.
/// - `dsps` is counted beforehand, by the steps that lead to DSP blocks in `synth_ecp5`.
/// - LUTs of more than four inputs are not formed: abc would spend LUT4s on them for speed.
/// - For the longest path registers are cut out and a memory's read becomes one LUT4; ltp knows neither.
constexpr std::string_view fpga_script = R"(
setattr -mod -set keep_hierarchy 1 *quad_setup* *quad_slots* *tile_walk* *tile_ring* *stamp_coverage*
setattr -mod -set keep_hierarchy 1 *vertex_assembly* *forward_difference* *normalise* *rsqrt* *reciprocal*
setattr -mod -set keep_hierarchy 1 *mean_value_ratios* *interpolate* *fragment_output* *fixed_point*
setattr -mod -set keep_hierarchy 1 *fp_multiply* *fp_raw_product* *fp_sum* *one_plus*
setattr -mod -unset keep_hierarchy *fp_normalise*
design -save start
proc
flatten
opt -nodffe -nosdff
opt
wreduce
peepopt
opt_clean
techmap -map +/mul2dsp.v -map +/ecp5/dsp_map.v -D DSP_A_MAXWIDTH=18 -D DSP_B_MAXWIDTH=18 -D DSP_A_MINWIDTH=2 -D DSP_B_MINWIDTH=2 -D DSP_NAME=$__MUL18X18
tee -o dsps.txt stat
design -load start
synth_ecp5 -nodsp -nowidelut -top quadrille -run :check
tee -o cells.txt stat
delete t:TRELLIS_FF
techmap -map read_port.v
setattr -mod -unset keep_hierarchy *
flatten
tee -o path.txt ltp
)";

constexpr std::string_view read_port = R"(
module TRELLIS_DPR16X4 (input [3:0] DI, input [3:0] WAD, input WRE, input WCK, input [3:0] RAD, output [3:0] DO);
  parameter WCKMUX = "WCK";
  parameter WREMUX = "WRE";
  parameter INITVAL = 64'd0;
  genvar g;
  generate
    for (g = 0; g < 4; g = g + 1) LUT4 read (.A(RAD[0]), .B(RAD[1]), .C(RAD[2]), .D(RAD[3]), .Z(DO[g]));
  endgenerate
endmodule
)";

/// Cells of a type in the last statistics of a file; those of the whole design where there are several modules.
std::uint64_t cells_of(const fs::path& statistics, std::string_view type) {
  std::ifstream in(statistics);
  std::uint64_t cells = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);  // LUT4 123
    std::string cell;
    std::uint64_t count = 0;
    if (line.find("=== ") != std::string::npos) {
      cells = 0;
    } else if (words >> cell >> count && cell == type) {
      cells = count;
    }
  }
  return cells;
}

std::optional<std::uint64_t> longest_path(const fs::path& file) {
  std::ifstream in(file);
  constexpr std::string_view before = "(length=";
  for (std::string line; std::getline(in, line);) {
    if (const std::size_t at = line.find(before); at != std::string::npos)
      return std::stoull(line.substr(at + before.size()));
  }
  return std::nullopt;
}

constexpr std::array fpga_fields{&FpgaReport::luts, &FpgaReport::flip_flops, &FpgaReport::dsps, &FpgaReport::block_rams,
                                 &FpgaReport::longest_path};

std::optional<FpgaReport> read_report(const fs::path& file) {
  std::ifstream in(file);
  FpgaReport report;
  for (const auto field : fpga_fields) {
    if (!(in >> report.*field)) return std::nullopt;
  }
  return report;
}

FpgaReport run_fpga(const Config& config, const fs::path& directory, const fs::path& log) {
  write_text(directory / "read_port.v", read_port);
  run(read_commands(config, false, directory) + std::string(fpga_script), directory, "fpga", log);
  const fs::path cells = directory / "cells.txt";
  FpgaReport report;
  const std::uint64_t lut4s = cells_of(cells, "LUT4");
  report.luts = lut4s + 2 * cells_of(cells, "CCU2C") + 6 * cells_of(cells, "TRELLIS_DPR16X4");
  report.flip_flops = cells_of(cells, "TRELLIS_FF");
  report.dsps = cells_of(directory / "dsps.txt", "MULT18X18D");
  report.block_rams = cells_of(cells, "DP16KD") + cells_of(cells, "PDPW16KD");
  const std::optional<std::uint64_t> path = longest_path(directory / "path.txt");
  if (lut4s == 0 || report.flip_flops == 0 || report.dsps == 0 || !path)
    throw VerilateError("the statistics of this version of Yosys are not understood; see " + log.string());
  report.longest_path = *path;
  return report;
}

}  // namespace

FpgaReport synthesise_fpga(const Config& config) {
  config.validate();
  const std::string yosys = find_program("yosys", "yosys");
  Fingerprint key;
  key.add("fpga 1");
  key.add(run_captured(std::vector<std::string>{yosys, "-V"}));
  key.add(fpga_script);
  key.add(read_port);
  // The tables hold the resolved segments; a key on auto and its value are one machine.
  for (const ConfigKey& k : Config::keys())
    key.add(std::string(k.name) + "=" + std::to_string(config.resolved(k.name)));
  key.add(tables_package(config));
  for (const fs::path& source : rtl_sources(rtl_directory())) key.add_file(source);
  const std::string name = "fpga-" + key.hex();
  const auto build = [&](const fs::path& work) {
    const fs::path log = writable_cache_directory() / ("failed-" + name + ".log");  // stays if it does
    const FpgaReport report = run_fpga(config, work, log);
    for (const fs::directory_entry& entry : fs::directory_iterator(work)) fs::remove_all(entry.path());
    std::ostringstream text;
    for (const auto field : fpga_fields) text << report.*field << '\n';
    write_text(work / "report.txt", text.str());
    std::error_code ignored;
    fs::remove(log, ignored);
  };
  const auto stored = [&] {
    return read_report(cached(name, "synthesis of " + summary(config), build).path() / "report.txt");
  };
  std::optional<FpgaReport> report = stored();
  if (!report && remove_cached(name)) report = stored();  // a damaged entry is made again
  if (!report) throw EnvironmentError("entry " + name + " of the cache is damaged and in use");
  return *report;
}

}  // namespace quadrille::tb
