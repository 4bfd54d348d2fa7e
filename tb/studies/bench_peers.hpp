// The model beside what would be used instead of it: quads by fp32 shaders on OpenGL, on one thread each.
#pragma once

#include "tb/options/options.hpp"

#include <string>
#include <vector>

namespace quadrille::tb {

struct PeerBenchOptions {
  CommonOptions common;
  int repeat = 9;  ///< alternating runs; medians count
};

/// Returns the exit status; throws EnvironmentError where there is no OpenGL.
int run_peer_bench(const PeerBenchOptions& options, const std::vector<std::string>& arguments);

}  // namespace quadrille::tb
