// The part of a sheet's pictures that shows something.
#pragma once

#include "golden/io/png.hpp"
#include "tb/studies/compare/attribute_image.hpp"

namespace quadrille::compare {

/// Half-open rectangle of pixels: what either frame covers, with a margin; everything unless that is at most half as
/// wide and half as high.
struct Crop {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  Crop(int left, int top, int right, int bottom) : x0(left), y0(top), x1(right), y1(bottom) {}
  Crop(const AttributeImage& a, const AttributeImage& b);
  /// The part of a picture of the frames' size.
  golden::Image8 of(const golden::Image8& picture) const;
};

}  // namespace quadrille::compare
