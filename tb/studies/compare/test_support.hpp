// Frames made of formulas.
#pragma once

#include "tb/studies/compare/attribute_image.hpp"

#include <cstdint>

namespace quadrille::compare::test {

/// Shows quad `quad(x, y)` everywhere, with the channels `value(x, y)`, a vector or an array; both at pixel centres, in
/// pixels.
template <class QuadAt, class ValueAt>
AttributeImage paint(int width, int height, int channels, QuadAt&& quad, ValueAt&& value) {
  AttributeImage image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint32_t shown = quad(x + 0.5, y + 0.5);
      if (shown == AttributeImage::no_quad) continue;
      const auto values = value(x + 0.5, y + 0.5);
      image.set(x, y, shown, values);
    }
  }
  return image;
}

/// One quad everywhere.
template <class ValueAt>
AttributeImage paint(int width, int height, int channels, ValueAt&& value) {
  return paint(
      width, height, channels, [](double, double) { return 0u; }, value);
}

inline void erase(AttributeImage& image, int x, int y) {
  image.quad[image.pixel(x, y)] = AttributeImage::no_quad;
  image.state[image.pixel(x, y)] = PixelState::empty;
}

}  // namespace quadrille::compare::test
