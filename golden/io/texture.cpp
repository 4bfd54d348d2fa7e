#include "golden/io/texture.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace quadrille::golden {
namespace {

/// The two texels around a coordinate, and how far it is from the first to the second.
struct Tap {
  std::size_t first, second;
  double fraction;
};

/// `turns`: texture coordinate, one turn per picture.
Tap tap(double turns, int size) {
  const double inside = turns - std::floor(turns);  // may round up to 1, which the wrap below takes as 0
  const double texel = inside * size - 0.5;
  const double base = std::floor(texel);
  const int first = (static_cast<int>(base) + size) % size;
  return {static_cast<std::size_t>(first), static_cast<std::size_t>((first + 1) % size), texel - base};
}

}  // namespace

Texture::Texture(Image8 image) : image_(std::move(image)) {
  if (image_.width < 1 || image_.height < 1 ||
      image_.rgba.size() != 4 * static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height)) {
    throw std::logic_error("Texture: a picture with at least one pixel and 4 bytes per pixel is needed");
  }
}

std::array<double, 4> Texture::sample(double u, double v) const {
  if (!std::isfinite(u) || !std::isfinite(v)) return {};
  const Tap x = tap(u, image_.width);
  const Tap y = tap(v, image_.height);  // rows counted from the bottom
  const auto height = static_cast<std::size_t>(image_.height);
  const auto width = static_cast<std::size_t>(image_.width);
  const auto texel = [&](std::size_t i, std::size_t j, std::size_t channel) {
    return static_cast<double>(image_.rgba[4 * ((height - 1 - j) * width + i) + channel]);
  };
  std::array<double, 4> result{};
  for (std::size_t c = 0; c < 4; ++c) {
    const double lower = texel(x.first, y.first, c) * (1 - x.fraction) + texel(x.second, y.first, c) * x.fraction;
    const double upper = texel(x.first, y.second, c) * (1 - x.fraction) + texel(x.second, y.second, c) * x.fraction;
    result[c] = (lower * (1 - y.fraction) + upper * y.fraction) / 255;
  }
  return result;
}

}  // namespace quadrille::golden
