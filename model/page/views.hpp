// What stands beside the machine's picture: the same quads by other methods, and what is to be known of the machine's.
#pragma once

#include "model/page/drawing.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace quadrille::page {

struct View {
  std::vector<std::uint8_t> rgba;
  std::string json;  ///< what a legend tells
};

/// By Request::view: exact, error, coverage, tiles, clocks, or a method of the papers (golden/methods). Throws
/// std::invalid_argument for any other.
View draw_view(const Drawing& drawing);
/// What a shader draws in single precision: of each quad x, y, w, k, z of its four corners, snapped, relative to pixel
/// centres, k times the vertex as given.
std::vector<float> shader_quads(const Drawing& drawing);
/// What it drew: of each pixel the weights, then of each the quad + 1 (0: none), window z, what is negative of a front,
/// and 0. As a picture; where Request::view ends in _error the errors against exact weights.
View shader_view(const Drawing& drawing, std::span<const float> pixels);
/// What the walk makes of each tile: left out with its block, left out by itself, entered in vain, drawn.
View tiles_view(const Drawing& drawing);

}  // namespace quadrille::page
