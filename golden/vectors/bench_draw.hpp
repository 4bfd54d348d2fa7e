// A small draw for golden/examples/machine_bench.sv, as the files that it reads.
#pragma once

#include "model/port/config.hpp"

#include <string>

namespace quadrille::vectors {

/// One draw of quads with w = 1, w of any sign and across the eye, a few hundred fragments; every attribute slot is in
/// use. The lines are those of a machine suite's records (golden/vectors/README.md).
struct BenchDraw {
  std::string states, stimulus, response;
  std::size_t quads = 0, fragments = 0;
};

BenchDraw make_bench_draw(const Config& config);

}  // namespace quadrille::vectors
