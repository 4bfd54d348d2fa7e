#include "tb/studies/compare/slopes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace quadrille::compare {

std::vector<float> slope_changes(const AttributeImage& image) {
  const double side = std::max(image.width, image.height);
  std::vector<float> changes;
  changes.reserve(image.quad.size());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      double largest = -1;
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
        if (x < dx || y < dy || x + dx >= image.width || y + dy >= image.height) continue;
        const std::size_t at = image.pixel(x, y), before = image.pixel(x - dx, y - dy),
                          after = image.pixel(x + dx, y + dy);
        if (image.quad[before] != image.quad[at] || image.quad[after] != image.quad[at]) continue;
        if (!image.defined(before) || !image.defined(at) || !image.defined(after)) continue;
        for (std::size_t c = 0; c < static_cast<std::size_t>(image.channels); ++c)
          largest = std::max(
              largest, side * std::abs(image.values(before)[c] - 2 * image.values(at)[c] + image.values(after)[c]));
      }
      changes.push_back(largest < 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(largest));
    }
  return changes;
}

}  // namespace quadrille::compare
