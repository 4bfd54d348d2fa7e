// The scale below a picture of differences, for programs without a library that draws text.
#pragma once

#include "golden/io/png.hpp"

namespace quadrille::golden {

/// The map with its scale below it, on a canvas as wide as both need: a bar of heat_colour() from most·2^-octaves to
/// `most`, with numbers at its ends and at powers of ten; what black and white mean. `most` 0: no difference, no bar.
Image8 with_heat_scale(const Image8& map, double most, int octaves);

}  // namespace quadrille::golden
