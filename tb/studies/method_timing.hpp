// How long a method takes to draw an input.
#pragma once

#include "tb/options/input.hpp"

#include <string>

namespace quadrille::tb {

struct MethodTime {
  double seconds = 0;         ///< of one draw of all quads on one thread, the quickest of the repeats
  std::uint64_t samples = 0;  ///< fragments that came out
  double ns_per_pixel = 0;    ///< NaN without fragments
};

/// Times the method alone: no depth test, no shading, no output.
MethodTime time_method(const std::string& method, const DrawInput& input, const DrawState& state, int repeats);

}  // namespace quadrille::tb
