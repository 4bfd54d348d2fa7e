// Whether a quad shows at all, for choosing inputs: the homogeneous form of the weights in double, without tie rules
// and without bounds. + − × ÷ √ only, so the answer is the same on every machine. It is no reference.
#pragma once

#include "model/port/records.hpp"

#include <array>

namespace quadrille::golden {

/// Number of visible samples among 16 × 16 pixel centres spread evenly over the viewport.
int visible_probes(const std::array<WindowVertex, 4>& quad, int width, int height);

}  // namespace quadrille::golden
