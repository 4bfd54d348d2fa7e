// Cliffs in time: what a fragment takes in each engine on every kind of input, beside that engine's best.
#pragma once

#include "tb/options/options.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::tb {

struct CliffBenchOptions {
  CommonOptions common;
  int repeat = 3;                    ///< the quickest counts
  std::uint64_t fragments = 10'000;  ///< of an input, about; quads of more than a fifth of them are left out
};

/// Returns the exit status: 1 when an engine drew nothing at all.
int run_cliff_bench(const CliffBenchOptions& options, const std::vector<std::string>& arguments);

}  // namespace quadrille::tb
