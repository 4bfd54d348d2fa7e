// A small sweep over one key: what bits cost and what they gain on the quads that are drawn.
#pragma once

#include "model/page/drawing.hpp"

#include <string>

namespace quadrille::page {

/// JSON: for each value of significand_bits that the configuration may have, cost, the bound of a weight and its worst
/// error over a quarter of the pixels that are shown.
std::string sweep_json(const Drawing& drawing);

}  // namespace quadrille::page
