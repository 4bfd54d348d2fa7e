// Throughput of the machine on a folder of meshes: clocks of the clocked model, which are the RTL's.
#pragma once

#include "tb/options/options.hpp"

#include <string>
#include <vector>

namespace quadrille::tb {

struct MeshBenchOptions {
  CommonOptions common;
  std::string folder;  ///< its *.obj are drawn, each by the default camera
};

/// Returns the exit status. Throws UsageError for a folder without a mesh and for what is wrong with one.
int run_mesh_bench(const MeshBenchOptions& options, const std::vector<std::string>& arguments);

}  // namespace quadrille::tb
