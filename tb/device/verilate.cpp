#include "tb/device/verilate.hpp"

#include "model/port/boundaries.hpp"
#include "model/port/config_text.hpp"
#include "model/port/tables.hpp"
#include "tb/device/build_notice.hpp"
#include "tb/device/ninja_file.hpp"
#include "tb/device/probes.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

/// Whether simulators count what runs: in the build for coverage alone (scripts/coverage.sh).
constexpr bool coverage = QUADRILLE_COVERAGE;

/// Toggles are thirty times the code of the machine and its branches next to nothing, so they are asked for.
bool count_toggles() { return coverage && std::getenv("QUADRILLE_COVERAGE_TOGGLE") != nullptr; }

/// The tools and their versions.
struct Tools {
  std::string verilator, compiler;
  std::string verilator_version, compiler_version;

  explicit Tools(const std::string& program) {
    verilator = program.empty() ? find_program("verilator", "verilator").string() : fs::absolute(program).string();
    const char* chosen = std::getenv("CXX");
    compiler = find_program(chosen != nullptr && *chosen != '\0' ? chosen : "g++", "g++");
    verilator_version = version_of(verilator);
    compiler_version = version_of(compiler);
  }

  /// Directory of Verilator's C++ headers and run time.
  fs::path include() const {
    std::string root = run_captured(std::vector<std::string>{verilator, "--getenv", "VERILATOR_ROOT"});
    while (!root.empty() && std::isspace(static_cast<unsigned char>(root.back()))) root.pop_back();
    const fs::path directory = fs::path(root) / "include";
    if (!fs::exists(directory / "verilated.h")) {
      throw EnvironmentError("Verilator's headers are not in " + directory.string() +
                             "; on Debian: apt-get install --reinstall verilator");
    }
    return directory;
  }

 private:
  /// Asked once for each program: starting Verilator takes longer than loading a simulator.
  static std::string version_of(const std::string& program) {
    static std::mutex mutex;
    static std::map<std::string, std::string> versions;
    const std::scoped_lock lock(mutex);
    std::string& version = versions[program];
    if (version.empty()) version = run_captured(std::vector<std::string>{program, "--version"});
    return version;
  }
};

/// A log beside the cache's entries that stays when the build fails.
[[noreturn]] void fail(const std::string& what, const fs::path& log, const std::string& name) {
  const fs::path kept = writable_cache_directory() / ("failed-" + name + ".log");
  std::error_code ignored;
  fs::copy_file(log, kept, fs::copy_options::overwrite_existing, ignored);
  throw VerilateError(what + "; log " + kept.string() + ", which ends:\n" + tail_of(kept, 25));
}

/// Flags of everything that is compiled with Verilator's headers.
std::vector<std::string> common_flags(const fs::path& include, bool trace) {
  return {"-fPIC",
          "-fvisibility=hidden",
          "-fno-gnu-unique",
          "-w",
          "-I" + include.string(),
          "-I" + (include / "vltstd").string(),
          coverage ? "-DVM_COVERAGE=1" : "-DVM_COVERAGE=0",
          "-DVM_SC=0",
          trace ? "-DVM_TRACE=1" : "-DVM_TRACE=0",
          trace ? "-DVM_TRACE_FST=1" : "-DVM_TRACE_FST=0"};
}

/// Verilator's run time, compiled once for all configurations.
struct Runtime {
  CacheEntry entry;
  std::vector<fs::path> objects;
};

Runtime runtime(const Tools& tools, const fs::path& include, const fs::path& glue, bool trace, unsigned jobs) {
  std::vector<std::string> stems{"verilated", "verilated_threads"};
  if (coverage) stems.push_back("verilated_cov");
  if (trace) stems.push_back("verilated_fst_c");
  std::vector<std::string> flags = common_flags(include, trace);
  flags.insert(flags.end(), {"-std=c++17", "-DVL_USER_FINISH", "-DVL_USER_STOP", "-DVL_USER_FATAL",
                             "-DVL_PRINTF=quadrille_device_print", "-include", (glue / "device_print.h").string()});
  Fingerprint key;
  key.add("runtime 2");
  key.add(tools.verilator_version);
  key.add(tools.compiler_version);
  for (const std::string& flag : flags) key.add(flag);
  for (const char* file : {"device_print.h", "device_trace.h"}) key.add_file(glue / file);
  for (const std::string& stem : stems) key.add_file(include / (stem + ".cpp"));
  const std::string name = "runtime-" + key.hex();

  BuildNotice notice(trace ? "Verilator's run time with waveforms" : "Verilator's run time");
  Runtime result;
  result.entry = cached(
      name, trace ? "Verilator's run time with waveforms" : "Verilator's run time",
      [&](const fs::path& work) {
        NinjaFile ninja(tools.compiler, flags);
        for (const std::string& stem : stems)
          ninja.object(
              stem + ".o", include / (stem + ".cpp"),
              stem == "verilated_fst_c" ? "-O2 -include " + shell_quoted((glue / "device_trace.h").string()) : "-O2");
        notice.start(ninja.steps());
        const fs::path log = work / "build.log";
        if (ninja.run(work, log, jobs, notice, 0) != 0) {
          if (trace && read_text(log).find("zlib.h") != std::string::npos)
            throw EnvironmentError("waveforms need zlib's headers; on Debian: apt-get install zlib1g-dev");
          fail("compiling Verilator's run time failed", log, name);
        }
        notice.finished();
      },
      [&](long pid) { notice.waiting(pid); });
  for (const std::string& stem : stems) result.objects.push_back(result.entry.path() / (stem + ".o"));
  return result;
}

/// What the glue has to know of the Verilated class: the width of every vector port and the constants of the package,
/// both read from the headers that Verilator wrote, so that they are the RTL's own and no copy of the C++ side's.
std::string device_constants(const fs::path& generated) {
  std::ostringstream text, list;
  std::istringstream top(read_text(generated / "Vquadrille.h"));
  for (std::string line; std::getline(top, line);) {  // VL_OUTW(&fragment_o,177,0,6);
    const std::size_t macro = std::min(line.find("VL_IN"), line.find("VL_OUT")), name_at = line.find("(&");
    if (macro == std::string::npos || name_at == std::string::npos) continue;
    std::istringstream fields(line.substr(name_at + 2));
    std::string name;
    int msb = 0, lsb = 0;
    char comma = 0;
    if (!std::getline(fields, name, ',') || !(fields >> msb >> comma >> lsb)) continue;
    if (name.starts_with("probe_")) name = name.substr(6);
    if (name.ends_with("_valid_o") || name.ends_with("_valid_i")) continue;
    if (name.ends_with("_i") || name.ends_with("_o")) name.resize(name.size() - 2);
    text << "constexpr uint32_t QUADRILLE_WIDTH_" << name << " = " << msb - lsb + 1 << ";\n";
  }
  const fs::path package = generated / "Vquadrille_quadrille_pkg.h";
  if (fs::exists(package)) {
    text << "#include \"Vquadrille_quadrille_pkg.h\"\n";
    std::istringstream header(read_text(package));
    for (std::string line; std::getline(header, line);) {  // static constexpr IData/*31:0*/ S = 0x12U;
      const std::size_t equals = line.find(" =");
      if (line.find("static constexpr") == std::string::npos || equals == std::string::npos) continue;
      const std::size_t name_at = line.rfind(' ', equals - 1) + 1;
      const std::string name = line.substr(name_at, equals - name_at);
      list << "    {\"" << name << "\", static_cast<int32_t>(Vquadrille_quadrille_pkg::" << name << ")},\n";
    }
  }
  text << "const quadrille_constant quadrille_constants[] = {\n"
       << list.str() << "    {nullptr, 0}};\n"
       << "#define QUADRILLE_FOR_EACH_PROBE(f)";
  for (std::size_t i = 0; i < static_cast<std::size_t>(Boundary::fragment); ++i)
    text << " f(" << i << ", " << boundary_name(static_cast<Boundary>(i)) << ", "
         << (has_lanes(static_cast<Boundary>(i)) ? "lanes" : "1") << ")";
  text << "\n";
  return text.str();
}

std::vector<fs::path> sources_of(const VerilateOptions& options) {
  std::vector<fs::path> sources;
  if (options.source.empty()) {
    sources = rtl_sources(rtl_directory());
  } else if (fs::is_directory(options.source)) {
    sources = rtl_sources(options.source);
  } else {
    sources = {options.source};
  }
  if (options.probes) sources.push_back(glue_directory() / "quadrille_probed.sv");
  sources.insert(sources.end(), options.extra.begin(), options.extra.end());
  return sources;
}

/// The sources as Verilator 5.006 can be told them, run in `work`: it cuts names off at a blank, so folders with one
/// are reached through links.
std::vector<std::string> source_arguments(const std::vector<fs::path>& sources, const fs::path& work) {
  std::vector<std::string> arguments;
  std::map<fs::path, std::string> links;
  for (const fs::path& source : sources) {
    const fs::path file = fs::absolute(source), folder = file.parent_path();
    if (folder.string().find_first_of(" \t\n") == std::string::npos) {
      arguments.push_back(file.string());
      continue;
    }
    const auto [link, added] = links.emplace(folder, "sources" + std::to_string(links.size()));
    if (added) fs::create_directory_symlink(folder, work / link->second);
    arguments.push_back(link->second + "/" + file.filename().string());
  }
  return arguments;
}

/// Keys that differ from their defaults, and what else tells one simulator from another.
std::string description(const Config& config, const VerilateOptions& options) {
  std::string text = summary(config) + (options.probes ? " with probes" : " without probes");
  if (options.trace) text += ", waveforms";
  if (!options.assertions) text += ", no assertions";
  if (!options.verilator.empty()) text += ", by " + options.verilator;
  if (options.optimise != VerilateOptions{}.optimise) text += ", -O" + std::to_string(options.optimise);
  if (!options.source.empty()) text += ", RTL " + fs::absolute(options.source).string();
  for (const fs::path& file : options.extra) text += ", " + file.filename().string();
  if (coverage) text += count_toggles() ? ", counts lines and toggles" : ", counts lines";
  for (const std::string& argument : options.arguments) text += " " + argument;
  return text;
}

/// Writes files that include Verilator's, so that its headers, most of what a small file costs, are read in few
/// compilations: code that runs once in one file, the simulated clock in as few as a compiler digests well.
/// Returns their names, the slow ones first.
std::vector<std::string> write_groups(const fs::path& work, const fs::path& generated) {
  constexpr std::uintmax_t group_bytes = 3'000'000;
  struct Part {
    std::uintmax_t bytes;
    std::string name;
  };
  std::vector<Part> slow, fast;
  std::uintmax_t slow_total = 0, total = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(generated)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".cpp") continue;
    const bool once = stem.find("__Slow") != std::string::npos || stem.find("__Trace") != std::string::npos;
    (once ? slow : fast).push_back({entry.file_size(), entry.path().filename().string()});
    (once ? slow_total : total) += entry.file_size();
  }
  const auto larger = [](const Part& a, const Part& b) {
    return a.bytes != b.bytes ? a.bytes > b.bytes : a.name < b.name;
  };
  std::sort(slow.begin(), slow.end(), larger);
  std::sort(fast.begin(), fast.end(), larger);
  // Toggle coverage alone makes so much code that runs once that it wants more than one file.
  const std::size_t once = count_toggles() ? slow_total / group_bytes + 1 : 1;
  const std::size_t groups = std::max<std::size_t>(1, (total + group_bytes / 2) / group_bytes);
  std::vector<std::string> texts(once + groups), names;
  for (std::size_t i = 0; i < slow.size(); ++i) texts[i % once] += "#include \"" + slow[i].name + "\"\n";
  for (std::size_t i = 0; i < fast.size(); ++i) texts[once + i % groups] += "#include \"" + fast[i].name + "\"\n";
  texts[once] += "#include \"device_glue.cpp\"\n";
  for (std::size_t i = 0; i < texts.size(); ++i) {
    names.push_back(i == 0 ? "slow" : i < once ? "slow" + std::to_string(i) : "fast" + std::to_string(i - once + 1));
    write_text(work / (names.back() + ".cpp"), texts[i]);
  }
  return names;
}

}  // namespace

std::vector<std::string> key_defines(const Config& config) {
  std::vector<std::string> defines;
  for (const ConfigKey& key : Config::keys()) {
    std::string define = "-DQUADRILLE_";
    for (const char c : key.name) define += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    defines.push_back(define + "=" + std::to_string(config.get(key.name)));
  }
  return defines;
}

std::string summary(const Config& config) {
  const std::string text = changed_keys(config, " ");
  return text.empty() ? "default" : text.substr(1);
}

Simulator verilate(const Config& config, const VerilateOptions& options) {
  config.validate();
  const Tools tools(options.verilator);
  const fs::path glue = glue_directory();
  const std::vector<fs::path> sources = sources_of(options);
  const bool one_file = !options.source.empty() && !fs::is_directory(options.source);
  if (one_file && options.probes)
    throw std::invalid_argument("a machine in one file has no probes; expected the directory rtl/");
  std::vector<fs::path> headers;
  if (!one_file) headers = rtl_headers(rtl_includes(options.source.empty() ? rtl_directory() : options.source));
  const std::string tables = one_file ? "" : tables_package(config), probes = options.probes ? probes_header() : "";

  // 1. Everything that decides the result.
  Fingerprint key;
  key.add("device 3");
  key.add(tools.verilator_version);
  key.add(tools.compiler_version);
  for (const std::string& define : key_defines(config)) key.add(define);
  key.add(tables);
  key.add(probes);
  for (const fs::path& source : sources) key.add_file(source);
  for (const fs::path& header : headers) key.add_file(header);
  for (const char* file : {"device_glue.cpp", "device_abi.h", "device_print.h", "device_trace.h"})
    key.add_file(glue / file);
  key.add({options.probes ? "p" : "-"});
  key.add({options.trace ? "t" : "-"});
  key.add({options.assertions ? "a" : "-"});
  key.add(std::to_string(options.optimise));
  for (const std::string& argument : options.arguments) key.add(argument);
  if (coverage) key.add(count_toggles() ? "lines and toggles" : "lines");
  const std::string name = "device-" + key.hex();

  const unsigned jobs = options.jobs != 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
  const std::string what = description(config, options);
  BuildNotice notice("the simulator of " + what);
  const auto build = [&](const fs::path& work) {
    constexpr std::size_t usual_steps = 4;  // Verilator, slow, fast, link
    notice.start(usual_steps);
    const fs::path log = work / "build.log";
    const fs::path generated = work / "verilated";
    fs::create_directories(generated);

    // 2. SystemVerilog to C++.
    const std::string top_module = options.probes ? "quadrille_probed" : "quadrille";
    std::vector<std::string> command{tools.verilator, "--cc",           "--prefix", "Vquadrille",
                                     "--top-module",  top_module,       "--Mdir",   generated.filename().string(),
                                     "-O3",           "--x-assign",     "fast",     "--x-initial",
                                     "unique",        "--output-split", "12000",    "--no-timing"};
    command.insert(command.end(), {"--expand-limit", "256"});  // wide expressions in words
    if (options.assertions) command.push_back("--assert");
    command.push_back("-Wall");
    if (!options.source.empty()) command.push_back("-Wno-fatal");  // lint is for the project's own sources
    if (options.trace) {
      command.push_back("--trace-fst");
    } else if (!coverage) {  // which both name signals
      write_text(work / "split.vlt", "`verilator_config\nsplit_var -module \"*\" -var \"*\"\n");
      command.insert(command.end(), {"-Wno-SPLITVAR", "split.vlt"});
    }
    if (coverage) command.push_back("--coverage-line");
    if (count_toggles()) command.push_back("--coverage-toggle");
    for (const std::string& define : key_defines(config)) command.push_back(define);
    command.insert(command.end(), options.arguments.begin(), options.arguments.end());
    if (!one_file) {
      write_text(work / "quadrille_tables_pkg.sv", tables);
      command.push_back("quadrille_tables_pkg.sv");
    }
    if (options.probes) write_text(work / "quadrille_probes_pkg.svh", probes);
    for (const fs::path& header : headers) fs::copy_file(header, work / header.filename());
    for (const std::string& source : source_arguments(sources, work)) command.push_back(source);
    if (run_watched(
            command, work, log, [](std::string_view) {}, [&] { notice.tick(); }) != 0)
      fail("Verilator failed", log, name);

    // 3. C++ to one shared object that shows a single symbol. Code that runs once is not worth the optimiser's time.
    const fs::path include = tools.include();
    const Runtime shared = runtime(tools, include, glue, options.trace, jobs);
    write_text(generated / "device_constants.inc", device_constants(generated));
    std::vector<std::string> flags = common_flags(include, options.trace);
    flags.insert(flags.end(), {"-std=c++20", "-Iverilated", "-I" + glue.string(),
                               options.trace ? "-DQUADRILLE_TRACE=1" : "-DQUADRILLE_TRACE=0",
                               options.probes ? "-DQUADRILLE_PROBES=1" : "-DQUADRILLE_NO_PROBES=1"});
    NinjaFile ninja(tools.compiler, flags);
    for (const std::string& group : write_groups(work, generated))
      ninja.object(group + ".o", group + ".cpp",
                   group.starts_with("slow") ? "-O0"
                   : count_toggles()         ? "-O1"
                                             : "-O" + std::to_string(options.optimise));
    ninja.link("device.so", shared.objects, options.trace ? "-lz" : "");
    notice.done(1, 1 + ninja.steps());
    if (ninja.run(work, log, jobs, notice, 1) != 0) fail("compiling the Verilated machine failed", log, name);

    // 4. Keep the object and its log.
    for (const fs::directory_entry& entry : fs::directory_iterator(work))
      if (entry.path() != log && entry.path().filename() != "device.so") fs::remove_all(entry.path());
    notice.finished();
  };
  return {cached(name, what, build, [&](long pid) { notice.waiting(pid); })};
}

}  // namespace quadrille::tb
