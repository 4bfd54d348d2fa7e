// The geometry that a method draws, as lines of a sheet.
#pragma once

#include "model/port/records.hpp"
#include "tb/options/input.hpp"
#include "tb/studies/compare/crop.hpp"
#include "tb/studies/compare/sheet.hpp"

#include <string>
#include <vector>

namespace quadrille::tb {

/// Outlines of the method's triangles or cells in front of the eye, in pixels of the cropped pictures; those of the
/// quads where the method's edges are shorter than lines can show at `scale` sheet pixels a pixel.
std::vector<compare::Polyline> method_lines(const std::string& method, const DrawInput& input, const DrawState& state,
                                            const compare::Crop& crop, double scale);

}  // namespace quadrille::tb
