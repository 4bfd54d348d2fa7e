// Where the program finds what it compiles or calls on demand: the RTL, the device glue, plot scripts.
//
// Looked up in this order: `../share/quadrille` beside the directory of the running executable, which is where `cmake
// --install` puts them, then the source tree that the program was built from (compile definition QUADRILLE_SOURCE_DIR).
#pragma once

#include <filesystem>
#include <vector>

namespace quadrille::tb {

/// Directory with quadrille.sv; throws EnvironmentError when there is none.
std::filesystem::path rtl_directory();
/// Directory with device_glue.cpp, device_abi.h and device_print.h.
std::filesystem::path glue_directory();
/// Directory with machine_bench.sv.
std::filesystem::path bench_directory();
/// Directory with the scripts that the program calls (compare_plot.py).
std::filesystem::path scripts_directory();
/// Every *.sv of a directory: packages first, then the rest by name. Throws SystemError when there is none.
std::vector<std::filesystem::path> rtl_sources(const std::filesystem::path& directory);

/// Folder of the files that the sources include: `directory`/include, or the project's where there is none.
std::filesystem::path rtl_includes(const std::filesystem::path& directory);

/// The files of such a folder, by name.
std::vector<std::filesystem::path> rtl_headers(const std::filesystem::path& includes);

}  // namespace quadrille::tb
