#include "tb/device/verilate.hpp"

#include "model/tables.hpp"
#include "tb/support/environment_error.hpp"
#include "tb/support/process.hpp"
#include "tb/support/source_paths.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <thread>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

constexpr const char* package_verilator = "verilator";
constexpr const char* package_compiler = "g++";

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw EnvironmentError("cannot read " + file.string() + ": " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write_text(const fs::path& file, std::string_view text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw EnvironmentError("cannot write " + file.string() + ": " + std::strerror(errno));
}

/// An exclusive lock on a file, held for the scope; other processes and other threads wait.
class FileLock {
 public:
  explicit FileLock(const fs::path& file) : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (descriptor_ < 0) throw EnvironmentError("cannot write " + file.string() + ": " + std::strerror(errno));
    while (flock(descriptor_, LOCK_EX) != 0) {
      if (errno != EINTR) {
        close(descriptor_);
        throw EnvironmentError("cannot lock " + file.string() + ": " + std::strerror(errno));
      }
    }
  }
  ~FileLock() { close(descriptor_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

/// The tools, found once per call of verilate().
struct Tools {
  std::string verilator, compiler;
  std::string verilator_version, compiler_version;

  Tools() {
    verilator = find_program("verilator", package_verilator);
    const char* chosen = std::getenv("CXX");
    compiler = find_program(chosen != nullptr && *chosen != '\0' ? chosen : "g++", package_compiler);
    verilator_version = run_captured(std::vector<std::string>{verilator, "--version"});
    compiler_version = run_captured(std::vector<std::string>{compiler, "--version"});
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
};

/// Finds or builds the cache entry `name`: `build(directory)` fills an empty directory, which then gets its final name.
fs::path cached(const std::string& name, const std::function<void(const fs::path&)>& build) {
  const fs::path cache = cache_directory();
  const fs::path place = cache / name;
  if (fs::exists(place)) return place;
  const FileLock lock(cache / (name + ".lock"));
  if (fs::exists(place)) return place;  // another process was faster
  static std::atomic<unsigned> serial{0};
  const fs::path work = cache / ("tmp." + name + "." + std::to_string(getpid()) + "." + std::to_string(serial++));
  fs::remove_all(work);
  fs::create_directories(work);
  try {
    build(work);
    fs::rename(work, place);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(work, ignored);
    throw;
  }
  return place;
}

/// Keeps the log of a failed build beside the cache's entries and reports it.
[[noreturn]] void fail(const std::string& what, const fs::path& log, const std::string& name) {
  const fs::path kept = cache_directory() / ("failed-" + name + ".log");
  std::error_code ignored;
  fs::copy_file(log, kept, fs::copy_options::overwrite_existing, ignored);
  throw VerilateError(what + "; log " + kept.string() + ", which ends:\n" + tail_of(kept, 25));
}

/// Verilator's run time compiled once for all configurations: objects in a cache entry.
std::vector<fs::path> runtime_objects(const Tools& tools, const fs::path& include, const fs::path& glue, bool trace,
                                      unsigned jobs) {
  std::vector<std::string> stems{"verilated", "verilated_threads"};
  if (trace) stems.push_back("verilated_fst_c");
  Fingerprint key;
  key.add("runtime 1");
  key.add(tools.verilator_version);
  key.add(tools.compiler_version);
  key.add_file(glue / "device_print.h");
  for (const std::string& stem : stems) key.add_file(include / (stem + ".cpp"));
  const std::string name = "runtime-" + key.hex();
  const fs::path place = cached(name, [&](const fs::path& work) {
    std::vector<std::vector<std::string>> commands;
    for (const std::string& stem : stems) {
      commands.push_back({tools.compiler,
                          "-std=c++17",
                          "-O2",
                          "-fPIC",
                          "-fvisibility=hidden",
                          "-fno-gnu-unique",
                          "-w",
                          "-I" + include.string(),
                          "-I" + (include / "vltstd").string(),
                          "-DVM_COVERAGE=0",
                          "-DVM_SC=0",
                          trace ? "-DVM_TRACE=1" : "-DVM_TRACE=0",
                          trace ? "-DVM_TRACE_FST=1" : "-DVM_TRACE_FST=0",
                          "-DVL_USER_FINISH",
                          "-DVL_USER_STOP",
                          "-DVL_USER_FATAL",
                          "-DVL_PRINTF=quadrille_device_print",
                          "-include",
                          (glue / "device_print.h").string(),
                          "-c",
                          (include / (stem + ".cpp")).string(),
                          "-o",
                          (work / (stem + ".o")).string()});
    }
    const fs::path log = work / "build.log";
    if (run_parallel(commands, work, log, jobs) != 0) {
      if (trace && read_text(log).find("zlib.h") != std::string::npos) {
        throw EnvironmentError("waveforms need zlib's headers; on Debian: apt-get install zlib1g-dev");
      }
      fail("compiling Verilator's run time failed", log, name);
    }
  });
  std::vector<fs::path> objects;
  for (const std::string& stem : stems) objects.push_back(place / (stem + ".o"));
  return objects;
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
  text << "const quadrille_constant quadrille_constants[] = {\n" << list.str() << "    {nullptr, 0}};\n";
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
  sources.insert(sources.end(), options.extra.begin(), options.extra.end());
  return sources;
}

}  // namespace

void Fingerprint::byte(unsigned char b) {
  constexpr unsigned __int128 prime = (static_cast<unsigned __int128>(1) << 88) | 0x13bu;
  hash_ = (hash_ ^ b) * prime;
}

void Fingerprint::add(std::string_view piece) {
  for (std::uint64_t length = piece.size(), i = 0; i < 8; ++i) byte(static_cast<unsigned char>(length >> (8 * i)));
  for (const char c : piece) byte(static_cast<unsigned char>(c));
}

void Fingerprint::add_file(const fs::path& file) {
  add(file.filename().string());
  add(read_text(file));
}

std::string Fingerprint::hex() const {
  std::string text;
  for (int shift = 124; shift >= 0; shift -= 4) text += "0123456789abcdef"[static_cast<unsigned>(hash_ >> shift) & 15u];
  return text;
}

fs::path cache_directory() {
  const auto value = [](const char* name) -> std::string {
    const char* text = std::getenv(name);
    return text == nullptr ? "" : text;
  };
  fs::path directory = QUADRILLE_FALLBACK_CACHE_DIR;
  if (const std::string cache = value("QUADRILLE_CACHE"); !cache.empty()) {
    directory = cache;
  } else if (const std::string xdg = value("XDG_CACHE_HOME"); !xdg.empty()) {
    directory = fs::path(xdg) / "quadrille";
  } else if (const std::string home = value("HOME"); !home.empty()) {
    directory = fs::path(home) / ".cache" / "quadrille";
  }
  std::error_code error;
  fs::create_directories(directory, error);
  if (error || access(directory.c_str(), W_OK) != 0) {
    throw EnvironmentError("cannot write to the cache directory " + directory.string() +
                           "; set QUADRILLE_CACHE to a directory that can be written");
  }
  return fs::absolute(directory);
}

std::vector<std::string> key_defines(const Config& config) {
  std::vector<std::string> defines;
  for (const ConfigKey& key : Config::keys()) {
    std::string define = "-DQUADRILLE_";
    for (const char c : key.name) define += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    defines.push_back(define + "=" + std::to_string(config.get(key.name)));
  }
  return defines;
}

fs::path verilate(const Config& config, const VerilateOptions& options) {
  config.validate();
  const Tools tools;
  const fs::path glue = glue_directory();
  const std::vector<fs::path> sources = sources_of(options);
  const bool one_file = !options.source.empty() && !fs::is_directory(options.source);
  const std::string tables = one_file ? "" : tables_package(config);

  // 1. Everything that decides the result.
  Fingerprint key;
  key.add("device 1");
  key.add(tools.verilator_version);
  key.add(tools.compiler_version);
  for (const std::string& define : key_defines(config)) key.add(define);
  key.add(tables);
  for (const fs::path& source : sources) key.add_file(source);
  for (const char* file : {"device_glue.cpp", "device_abi.h", "device_print.h"}) key.add_file(glue / file);
  key.add({options.probes ? "p" : "-"});
  key.add({options.trace ? "t" : "-"});
  key.add({options.assertions ? "a" : "-"});
  key.add(std::to_string(options.optimise));
  for (const std::string& argument : options.arguments) key.add(argument);
  const std::string name = "device-" + key.hex();
  if (const fs::path ready = cache_directory() / name / "device.so"; fs::exists(ready)) return ready;

  const unsigned jobs = options.jobs != 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
  const fs::path include = tools.include();
  const fs::path place = cached(name, [&](const fs::path& work) {
    const fs::path log = work / "build.log";
    const fs::path generated = work / "verilated";
    fs::create_directories(generated);

    // 2. SystemVerilog to C++.
    std::vector<std::string> command{tools.verilator, "--cc",           "--prefix", "Vquadrille",
                                     "--top-module",  "quadrille",      "--Mdir",   generated.string(),
                                     "-O3",           "--x-assign",     "fast",     "--x-initial",
                                     "unique",        "--output-split", "12000",    "--no-timing"};
    if (options.assertions) command.push_back("--assert");
    command.push_back("-Wall");
    if (!options.source.empty()) command.push_back("-Wno-fatal");  // lint is for the project's own sources
    if (options.trace) command.push_back("--trace-fst");
    if (options.probes) command.push_back("-DQUADRILLE_PROBES=1");
    for (const std::string& define : key_defines(config)) command.push_back(define);
    command.insert(command.end(), options.arguments.begin(), options.arguments.end());
    if (!one_file) {
      write_text(work / "quadrille_tables_pkg.sv", tables);
      command.push_back((work / "quadrille_tables_pkg.sv").string());
    }
    for (const fs::path& source : sources) command.push_back(fs::absolute(source).string());
    if (run_logged(command, work, log) != 0) fail("Verilator failed", log, name);

    const std::vector<fs::path> runtime = runtime_objects(tools, include, glue, options.trace, jobs);

    // 3. C++ to objects. Code that runs once (…__Slow.cpp) is not worth the optimiser's time.
    write_text(generated / "device_constants.inc", device_constants(generated));
    std::vector<std::string> objects;
    std::vector<std::pair<std::uintmax_t, std::vector<std::string>>> work_list;
    const auto compile = [&](const fs::path& file, const std::string& level) {
      const std::string object = (work / (file.stem().string() + ".o")).string();
      objects.push_back(object);
      work_list.push_back({fs::file_size(file),
                           {tools.compiler,
                            "-std=c++20",
                            level,
                            "-fPIC",
                            "-fvisibility=hidden",
                            "-fno-gnu-unique",
                            "-w",
                            "-I" + generated.string(),
                            "-I" + include.string(),
                            "-I" + (include / "vltstd").string(),
                            "-I" + glue.string(),
                            "-DVM_COVERAGE=0",
                            "-DVM_SC=0",
                            options.trace ? "-DVM_TRACE=1" : "-DVM_TRACE=0",
                            options.trace ? "-DVM_TRACE_FST=1" : "-DVM_TRACE_FST=0",
                            options.trace ? "-DQUADRILLE_TRACE=1" : "-DQUADRILLE_TRACE=0",
                            options.probes ? "-DQUADRILLE_PROBES=1" : "-DQUADRILLE_NO_PROBES=1",
                            "-c",
                            file.string(),
                            "-o",
                            object}});
    };
    const std::string fast = "-O" + std::to_string(options.optimise);
    for (const fs::directory_entry& entry : fs::directory_iterator(generated)) {
      if (entry.path().extension() != ".cpp") continue;
      const bool slow = entry.path().stem().string().find("__Slow") != std::string::npos ||
                        entry.path().stem().string().find("__Trace") != std::string::npos;
      compile(entry.path(), slow ? "-O0" : fast);
    }
    compile(glue / "device_glue.cpp", fast);
    std::sort(work_list.begin(), work_list.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::vector<std::string>> commands;
    for (auto& [size, one] : work_list) commands.push_back(std::move(one));
    if (run_parallel(commands, work, log, jobs) != 0) fail("compiling the Verilated machine failed", log, name);

    // 4. Objects to one shared object that shows a single symbol.
    std::sort(objects.begin(), objects.end());
    std::vector<std::string> link{tools.compiler,
                                  "-shared",
                                  "-fPIC",
                                  "-Wl,-Bsymbolic",
                                  "-Wl,--no-undefined",
                                  "-o",
                                  (work / "device.so").string()};
    link.insert(link.end(), objects.begin(), objects.end());
    for (const fs::path& object : runtime) link.push_back(object.string());
    link.insert(link.end(), {"-lpthread", "-latomic"});
    if (options.trace) link.push_back("-lz");
    if (run_logged(link, work, log) != 0) fail("linking the Verilated machine failed", log, name);

    // 5. Keep the object and its log.
    for (const std::string& object : objects) fs::remove(object);
    for (const fs::directory_entry& entry : fs::directory_iterator(work)) {
      if (entry.path().extension() == ".log" && entry.path() != log) fs::remove(entry.path());
    }
    fs::remove_all(generated);
  });
  return place / "device.so";
}

}  // namespace quadrille::tb
