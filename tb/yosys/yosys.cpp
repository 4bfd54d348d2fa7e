#include "tb/yosys/yosys.hpp"

#include "model/port/tables.hpp"
#include "tb/device/verilate.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <type_traits>
#include <vector>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

/// `read_verilog` of tables, packages and modules with the configuration's defines, for Yosys run in `directory`, where
/// it looks for what they include: it takes no quotes around the folder of -I.
std::string read_commands(const Config& config, const fs::path& directory) {
  const fs::path tables = directory / "quadrille_tables_pkg.sv";
  std::ofstream out(tables);
  out << tables_package(config);
  out.close();
  if (!out) throw SystemError("cannot write " + tables.string());
  for (const fs::path& header : rtl_headers(rtl_includes(rtl_directory())))
    fs::copy_file(header, directory / header.filename(), fs::copy_options::overwrite_existing);
  std::string command = "read_verilog -sv -DSYNTHESIS=1";
  for (const std::string& define : key_defines(config)) command += " " + define;
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

fs::path yosys_verilog(const Config& config, const fs::path& directory) {
  fs::create_directories(directory);
  const fs::path verilog = directory / "quadrille_yosys.v";
  run(read_commands(config, directory) + "proc\nopt\nwrite_verilog -noattr \"" + verilog.string() + "\"\n", directory,
      "roundtrip", directory / "roundtrip.log");
  return verilog;
}

SynthesisReport yosys_synthesise(const Config& config, const fs::path& directory) {
  fs::create_directories(directory);
  const fs::path log = directory / "synth.log";
  run(read_commands(config, directory) + "synth -top quadrille\ncheck -assert\nstat\n", directory, "synth", log);
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

/// What runs for a target.
struct TargetFlow {
  const char* script;
  std::vector<std::string> arguments;
};

TargetFlow flow_of(SynthesisTarget target) {
  if (target == SynthesisTarget::cells) return {"timing.py", {"quadrille", "--target", "cells"}};
  return {"size.py", {"--target", std::string(synthesis_target_names[static_cast<std::size_t>(target)])}};
}

/// scripts/timing.py's library of cells, which says so where it is missing.
constexpr const char* cell_library = "/usr/share/qflow/tech/osu018/osu018_stdcells.lib";

HardwareSize read_size(const fs::path& file) {
  const nlohmann::json json = nlohmann::json::parse(read_text(file));
  HardwareSize size;
  json.at("flip_flops").get_to(size.flip_flops);
  const auto optional = [&](const char* key, auto& to) {
    if (json.contains(key)) to = json.at(key).get<typename std::remove_reference_t<decltype(to)>::value_type>();
  };
  optional("luts", size.luts);
  optional("dsps", size.dsps);
  optional("block_rams", size.block_rams);
  optional("longest_path", size.longest_path);
  optional("area_um2", size.area_um2);
  optional("nand2", size.nand2);
  optional("mhz", size.mhz);
  if (json.contains("critical_path")) json.at("critical_path").get_to(size.critical_path);
  return size;
}

/// The script's report.json in `directory`.
void run_flow(const Config& config, const TargetFlow& flow, const fs::path& directory, const fs::path& log) {
  const fs::path tables = directory / "quadrille_tables_pkg.sv";
  write_text(tables, tables_package(config));
  std::vector<std::string> command{find_program("/usr/bin/python3", "python3"), scripts_directory() / flow.script};
  command.insert(command.end(), flow.arguments.begin(), flow.arguments.end());
  for (const ConfigKey& key : Config::keys())
    command.push_back(std::string(key.name) + "=" + std::to_string(config.get(key.name)));
  command.insert(command.end(), {"--tables", tables, "--rtl", fs::absolute(rtl_directory()), "--json",
                                 directory / "report.json", "--quiet"});
  const int status = run_logged(command, directory, log);
  if (status == 3) throw EnvironmentError(tail_of(log, 1));
  if (status != 0) throw VerilateError("synthesis failed; log " + log.string() + ", which ends:\n" + tail_of(log, 25));
  fs::remove(tables);
}

}  // namespace

SynthesisTarget parse_synthesis_target(std::string_view name) {
  const auto found = std::ranges::find(synthesis_target_names, name);
  if (found == synthesis_target_names.end())
    throw ConfigError("\"" + std::string(name) + "\" is not a synthesis target; expected ecp5, ecp5-nodsp or cells");
  return static_cast<SynthesisTarget>(found - synthesis_target_names.begin());
}

HardwareSize synthesise_for(const Config& config, SynthesisTarget target) {
  config.validate();
  const TargetFlow flow = flow_of(target);
  Fingerprint key;
  key.add("synthesis 2");
  key.add(run_captured(std::vector<std::string>{find_program("yosys", "yosys"), "-V"}));
  if (target == SynthesisTarget::cells) {
    key.add(run_captured(std::vector<std::string>{find_program("sta", "opensta"), "-version"}));
    if (fs::exists(cell_library)) key.add_file(cell_library);
  }
  key.add(synthesis_target_names[static_cast<std::size_t>(target)]);
  key.add_file(scripts_directory() / flow.script);
  key.add_file(scripts_directory() / "report" / "synthesis.py");
  // The tables hold the resolved segments; a key on auto and its value are one machine.
  for (const ConfigKey& k : Config::keys())
    key.add(std::string(k.name) + "=" + std::to_string(config.resolved(k.name)));
  key.add(tables_package(config));
  for (const fs::path& source : rtl_sources(rtl_directory())) key.add_file(source);
  for (const fs::path& header : rtl_headers(rtl_includes(rtl_directory()))) key.add_file(header);
  const std::string name = "synthesis-" + key.hex();
  const auto build = [&](const fs::path& work) {
    const fs::path log = writable_cache_directory() / ("failed-" + name + ".log");  // stays if it does
    run_flow(config, flow, work, log);
    read_size(work / "report.json");
    std::error_code ignored;
    fs::remove(log, ignored);
  };
  const auto stored = [&]() -> std::optional<HardwareSize> {
    const CacheEntry entry = cached(name, "synthesis of " + summary(config), build);
    try {
      return read_size(entry.path() / "report.json");
    } catch (const nlohmann::json::exception&) {
      return std::nullopt;
    }
  };
  std::optional<HardwareSize> size = stored();
  if (!size && remove_cached(name)) size = stored();  // a damaged entry is made again
  if (!size) throw SystemError("entry " + name + " of the cache is damaged and in use");
  return *size;
}

}  // namespace quadrille::tb
