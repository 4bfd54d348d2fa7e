// What stands beside the machine's picture: the same quads by other methods, and what is to be known of the machine's.
#pragma once

#include "model/page/drawing.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::page {

struct View {
  std::vector<std::uint8_t> rgba;
  std::string json;  ///< what a legend tells
};

/// By Request::view: exact, fp32, error, coverage, tiles, clocks, or a method of the papers (golden/methods). Throws
/// std::invalid_argument for any other.
View draw_view(const Drawing& drawing);
/// What the walk makes of each tile: left out with its block, left out by itself, entered in vain, drawn.
View tiles_view(const Drawing& drawing);

}  // namespace quadrille::page
