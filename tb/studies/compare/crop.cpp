#include "tb/studies/compare/crop.hpp"

#include <algorithm>

namespace quadrille::compare {

Crop::Crop(const AttributeImage& a, const AttributeImage& b) : x1(a.width), y1(a.height) {
  int left = a.width, top = a.height, right = 0, bottom = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (!a.covered(a.pixel(x, y)) && !b.covered(b.pixel(x, y))) continue;
      left = std::min(left, x), right = std::max(right, x + 1);
      top = std::min(top, y), bottom = std::max(bottom, y + 1);
    }
  }
  const int margin = 4 + std::max(right - left, bottom - top) / 10;
  left = std::max(0, left - margin), right = std::min(a.width, right + margin);
  top = std::max(0, top - margin), bottom = std::min(a.height, bottom + margin);
  if (left >= right || (right - left) * 2 > a.width || (bottom - top) * 2 > a.height) return;
  x0 = left, y0 = top, x1 = right, y1 = bottom;
}

golden::Image8 Crop::of(const golden::Image8& picture) const {
  golden::Image8 part;
  part.width = x1 - x0;
  part.height = y1 - y0;
  for (int y = y0; y < y1; ++y) {
    const auto row = picture.rgba.begin() + (static_cast<std::ptrdiff_t>(y) * picture.width + x0) * 4;
    part.rgba.insert(part.rgba.end(), row, row + static_cast<std::ptrdiff_t>(part.width) * 4);
  }
  return part;
}

}  // namespace quadrille::compare
