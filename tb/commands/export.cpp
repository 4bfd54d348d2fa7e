// quadrille export: the machine of one configuration as files for a project of one's own.
#include "golden/analysis/hardware_cost.hpp"
#include "golden/io/atomic_file.hpp"
#include "golden/io/config_file.hpp"
#include "golden/io/json_report.hpp"
#include "golden/vectors/bench_draw.hpp"
#include "model/port/boundaries.hpp"
#include "tb/commands/commands.hpp"
#include "tb/device/one_file.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/written_file.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/source_paths.hpp"
#include "tb/support/staged_directory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::tb {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  CommonOptions common;
  std::string prefix = "quadrille", out;
};

std::string read_source(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw SystemError(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Of the units of the default machine, each placed by itself.
struct SlowestUnit {
  std::string name, tools;
  double mhz = 0;  ///< median of the seeds
};

SlowestUnit slowest_unit(const fs::path& file) {
  const auto fail = [&](const std::string& what) { return SystemError(file.string() + ": " + what); };
  const nlohmann::json measured = nlohmann::json::parse(read_source(file), nullptr, false);
  if (measured.is_discarded() || !measured.contains("size") || !measured.contains("clock"))
    throw fail("has no sizes and clocks of units; expected what scripts/unit_table.py reads");
  SlowestUnit slowest{{}, measured.value("tools", ""), 0};
  for (const auto& [unit, clock] : measured["clock"].items()) {
    if (!measured["size"].contains(unit)) continue;  // of an option
    auto seeds = clock.at("mhz").get<std::vector<double>>();
    if (seeds.empty()) throw fail("no clock of " + unit);
    std::ranges::sort(seeds);
    const double median = seeds[seeds.size() / 2];
    if (slowest.name.empty() || median < slowest.mhz) slowest.name = unit, slowest.mhz = median;
  }
  if (slowest.name.empty()) throw fail("no clock of any unit");
  return slowest;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

/// The head of the file: what it is, its ports, its size.
std::string head(const ExportOptions& options, const Config& config, const HardwareCost& cost,
                 const SlowestUnit& unit) {
  const std::string& name = options.prefix;
  std::string text = "// SPDX-License-Identifier: Apache-2.0\n// Quadrille " + std::string(golden::program_version()) +
                     " in one file, top module `" + name + "`, written by\n//\n//     quadrille export" +
                     spelled(config) + " --prefix " + name + " --out DIR\n//\n// Ports: " + name +
                     "_tb.sv declares their fields and drives them.";
  for (const auto& [port, bits, fields] : describe_ports(config))
    text += "\n//   " + port + "  " + std::to_string(bits) + " bits";
  const auto pixels = config.pixels_per_clock;
  text += pixels == 1 ? "" : " for each of " + std::to_string(pixels) + " pixels a clock";
  text +=
      "\n// Size on a Lattice ECP5, estimated from the widths (golden/analysis/hardware_cost.hpp), not "
      "synthesized:\n//   " +
      rounded(lut_cost(cost, ecp5_weights)) + " LUTs, " + std::to_string(cost.dsps) + " DSP blocks, " +
      std::to_string(cost.block_rams) + " block RAMs, " + std::to_string(cost.state_bits) + " bits of state\n" +
      "// Clock: not estimated for a configuration. The slowest unit of the default one, " + unit.name +
      ", placed alone, reaches " + rounded(unit.mhz) + " MHz\n//   (rtl/units_measured.json: " + unit.tools + ").\n\n" +
      "/* verilator lint_off DECLFILENAME */  // all modules are in this file\n\n";
  return text;
}

int export_machine(const ExportOptions& options, const std::vector<std::string>& arguments) {
  if (options.out.empty()) throw UsageError("--out DIR is missing");
  const std::string& name = options.prefix;
  if (const std::string fault = prefix_fault(name); !fault.empty()) throw UsageError("--prefix " + name + ": " + fault);
  const Config config = options.common.config();
  check_outputs({options.common.json}, {options.common.config_file});
  const fs::path rtl = rtl_directory();
  const HardwareCost cost = hardware_cost(config);
  const SlowestUnit unit = slowest_unit(rtl / "units_measured.json");
  const vectors::BenchDraw draw = vectors::make_bench_draw(config);

  std::string bench = with_prefix(read_source(bench_directory() / "machine_bench.sv"), name);
  for (std::size_t at = 0; (at = bench.find("machine_bench", at)) != std::string::npos; at += name.size())
    bench.replace(at, std::string_view("machine_bench").size(), name + "_tb");
  char period[32];
  std::snprintf(period, sizeof period, "%.3f", 1000 / unit.mhz);
  const std::vector<std::pair<std::string, std::string>> files{
      {".sv", head(options, config, cost, unit) + with_prefix(one_file(rtl, config), name)},
      {"_tb.sv", bench},
      {".f", "// For synthesis and simulation; a simulation of " + name + " alone also takes " + name + "_tb.sv.\n" +
                 name + ".sv\n"},
      {".sdc", "# " + name +
                   " alone: one clock; rst_ni is synchronous. The period, in ns, is that of the slowest unit placed "
                   "alone,\n# " +
                   unit.name + " of the default configuration: put your own here.\ncreate_clock -name " + name +
                   "_clk -period " + period + " [get_ports clk_i]\n"},
      {"_states.hex", draw.states},
      {"_stimulus.hex", draw.stimulus},
      {"_response.hex", draw.response},
  };
  const StagedDirectory stage(options.out);
  for (const auto& [ending, text] : files)
    golden::write_file(stage.path(name + ending), text, golden::AtomicFile::Dash::refused);
  stage.commit({});

  if (std::FILE* text = options.common.text()) {
    std::fprintf(text, "%s: %s, estimated %s LUTs, %llu DSP blocks and %llu block RAMs of an ECP5; wrote\n",
                 options.out.c_str(), summary(config).c_str(), rounded(lut_cost(cost, ecp5_weights)).c_str(),
                 static_cast<unsigned long long>(cost.dsps), static_cast<unsigned long long>(cost.block_rams));
    for (const auto& [ending, content] : files) std::fprintf(text, "  %s%s\n", name.c_str(), ending.c_str());
  }
  if (!options.common.json.empty()) {
    nlohmann::ordered_json report = golden::begin_report(config, options.common.seed, arguments);
    for (const auto& [ending, content] : files) report["files"].push_back(name + ending);
    report["quads"] = draw.quads;
    report["fragments"] = draw.fragments;
    report["estimated"] = {{"lut", std::lround(lut_cost(cost, ecp5_weights))},
                           {"dsp", cost.dsps},
                           {"block_ram", cost.block_rams},
                           {"state_bits", cost.state_bits}};
    golden::save_json(options.common.json, report);
  }
  return exit_ok;
}

}  // namespace

void add_export_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("export", "Write the machine of a configuration as one SystemVerilog file");
  end_help(
      *command,
      "Modules, packages and macros begin with the prefix, so machines of different configurations fit in one design. "
      "Files of these names in DIR are replaced:\n"
      "  NAME.sv     the machine, top module NAME; any tool reads it alone\n"
      "  NAME.f      file list\n"
      "  NAME.sdc    clock\n"
      "  NAME_tb.sv  bench, which must print 0 missing, 0 differences\n"
      "  NAME_*.hex  what it reads in the folder where it runs\n\n"
      "In DIR: iverilog -g2012 -o tb NAME.sv NAME_tb.sv && vvp -N tb",
      "0 done; 2 usage or input error",
      {"export --prefix quads --out ip", "export --set depth_bits=16 --prefix small_quads --out ip"});
  const auto options = std::make_shared<ExportOptions>();
  options->common.add_to(*command, false);
  command->add_option("--prefix", options->prefix, "What every name begins with; lower case")
      ->type_name("NAME")
      ->capture_default_str()
      ->group(output_group);
  writes_folder(command->add_option("--out", options->out, "Directory of the files; made if missing"))
      ->group(output_group);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return export_machine(*options, invocation.arguments); };
  });
}

}  // namespace quadrille::tb
