// What each skip saves on each scene: clocks, pixels, products, model time; and a picture of where.
#pragma once

#include "tb/options/input.hpp"
#include "tb/options/options.hpp"

#include <string>
#include <vector>

namespace quadrille::tb {

struct SkipBenchOptions {
  CommonOptions common;
  InputOptions input;    ///< none: all loads
  int repeat = 3;        ///< of the untimed model; the median counts
  std::string pictures;  ///< folder for NAME.png and NAME.exr; empty: none
};

/// Returns the exit status: 1 when a skip that keeps the list of fragments changed it.
int run_skip_bench(const SkipBenchOptions& options, const std::vector<std::string>& arguments);

}  // namespace quadrille::tb
