// A texture: bilinear samples of a picture.
#pragma once

#include "golden/io/png.hpp"

#include <array>

namespace quadrille::golden {

/// Repeats in both directions; v points up, so that (0, 0) is the lower left corner of the picture; the centre of texel
/// (i, j from the bottom) is at ((i + 0.5) / width, (j + 0.5) / height). Values as stored, without sRGB conversion.
class Texture {
 public:
  /// The picture must have at least one pixel.
  explicit Texture(Image8 image);

  /// R G B A in [0, 1] at (u, v); all zero where u or v is not finite.
  std::array<double, 4> sample(double u, double v) const;

 private:
  Image8 image_;
};

}  // namespace quadrille::golden
