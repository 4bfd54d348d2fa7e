#include "tb/support/source_paths.hpp"

#include "tb/support/environment_error.hpp"

#include <algorithm>
#include <string>

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

/// The directory `name` of the installed data, or of the source tree, that holds `file`.
fs::path locate(const char* name, const char* file) {
  std::error_code error;
  // The data installed beside the program first: an installed program must not change with a source tree.
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = executable.parent_path().parent_path() / "share" / "quadrille" / name;
  if (fs::exists(installed / file, error)) return installed;
  const fs::path source = fs::path(QUADRILLE_SOURCE_DIR) / name;
  if (fs::exists(source / file, error)) return source;
  throw EnvironmentError("cannot find " + std::string(name) + "/" + file + ": looked in " + source.string() + " and " +
                         installed.string() + "; run cmake --install, or keep the source tree");
}

/// In their order; throws SystemError without any: no SystemVerilog `what`.
std::vector<fs::path> files_of(const fs::path& directory, const char* extension, const char* what) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  if (files.empty()) throw SystemError("no SystemVerilog " + std::string(what) + " in " + directory.string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

fs::path rtl_directory() { return locate("rtl", "quadrille.sv"); }

fs::path bench_directory() { return locate("golden/examples", "machine_bench.sv"); }

fs::path scripts_directory() { return locate("scripts", "compare_plot.py"); }

fs::path glue_directory() { return locate("tb/device", "device_glue.cpp"); }

std::vector<fs::path> rtl_sources(const fs::path& directory) {
  std::vector<fs::path> files = files_of(directory, ".sv", "files");
  std::stable_partition(files.begin(), files.end(),
                        [](const fs::path& p) { return p.stem().string().ends_with("_pkg"); });
  return files;
}

fs::path rtl_includes(const fs::path& directory) {
  std::error_code error;
  const fs::path own = directory / "include";
  return fs::is_directory(own, error) ? own : rtl_directory() / "include";
}

std::vector<fs::path> rtl_headers(const fs::path& includes) { return files_of(includes, ".svh", "headers"); }

}  // namespace quadrille::tb
