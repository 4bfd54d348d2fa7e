// Speeds of all bodies in one run, as ratios, so that the machine it runs on falls out.
#pragma once

#include "tb/options/options.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::tb {

struct SpeedOptions {
  CommonOptions common;
  int repeat = 5, quad_size = 64;
  std::uint64_t fragments = 2'000'000;
  bool no_rtl = false;
  std::string verilator;  ///< a second one for the RTL alone
};

/// Returns the exit status.
int run_speed_bench(const SpeedOptions& options, const std::vector<std::string>& arguments);

}  // namespace quadrille::tb
