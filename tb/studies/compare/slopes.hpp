// Where a frame's attributes bend, pixel by pixel: what makes a crease visible on a sheet.
#pragma once

#include "tb/studies/compare/attribute_image.hpp"

#include <vector>

namespace quadrille::compare {

/// Of each pixel the largest change of a channel's slope from one pixel step to the next, along its row and its column,
/// in attribute per image side (max(width, height) pixels). NaN where neither the row nor the column has numbers of one
/// quad in the pixel and in both neighbours.
std::vector<float> slope_changes(const AttributeImage& image);

}  // namespace quadrille::compare
