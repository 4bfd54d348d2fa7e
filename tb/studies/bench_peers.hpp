// The model beside what would be used instead of it: the papers' fp32 shader on OpenGL, on one thread each.
#pragma once

#include "tb/options/options.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::tb {

struct PeerBenchOptions {
  CommonOptions common;
  int repeat = 9;                       ///< alternating runs; medians count
  std::uint64_t fragments = 2'000'000;  ///< about, of a point of the series
  bool no_rtl = false;
};

/// Returns the exit status; throws EnvironmentError where there is no OpenGL.
int run_peer_bench(const PeerBenchOptions& options, const std::vector<std::string>& arguments);

}  // namespace quadrille::tb
