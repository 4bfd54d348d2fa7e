// What every pixel of a frame shows, as numbers: the quad and its attributes, before any shading.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace quadrille::compare {

enum class PixelState : std::uint8_t {
  empty,      ///< nothing is drawn
  drawn,      ///< the values are the attributes
  undefined,  ///< the method covers the pixel and has no number for it; the values are not to be used
};

/// Pixels in rows from the top; the centre of pixel (x, y) is the window position (x + 0.5, y + 0.5).
struct AttributeImage {
  static constexpr std::uint32_t no_quad = 0xffffffff;

  int width, height, channels;
  std::vector<std::uint32_t> quad;  ///< position in the draw of the quad that is shown; no_quad where empty
  std::vector<PixelState> state;
  std::vector<double> value;  ///< the channels of a pixel one after the other

  /// Empty everywhere. Throws std::invalid_argument for a size or a number of channels below 1.
  AttributeImage(int columns, int rows, int values_per_pixel)
      : width(columns), height(rows), channels(values_per_pixel) {
    if (columns < 1 || rows < 1 || values_per_pixel < 1)
      throw std::invalid_argument("an attribute image needs pixels and channels");
    const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    quad.assign(pixels, no_quad);
    state.assign(pixels, PixelState::empty);
    value.assign(pixels * static_cast<std::size_t>(values_per_pixel), 0.0);
  }

  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  std::span<const double> values(std::size_t pixel) const {
    const auto n = static_cast<std::size_t>(channels);
    return std::span(value).subspan(pixel * n, n);
  }
  std::span<double> values(std::size_t pixel) {
    const auto n = static_cast<std::size_t>(channels);
    return std::span(value).subspan(pixel * n, n);
  }

  void set(int x, int y, std::uint32_t shown, std::span<const double> attributes) {
    const std::size_t p = pixel(x, y);
    quad[p] = shown;
    state[p] = PixelState::drawn;
    std::ranges::copy(attributes.first(static_cast<std::size_t>(channels)), values(p).begin());
  }
  void set_undefined(int x, int y, std::uint32_t shown) {
    quad[pixel(x, y)] = shown;
    state[pixel(x, y)] = PixelState::undefined;
  }

  bool covered(std::size_t pixel) const { return state[pixel] != PixelState::empty; }
  /// Drawn with finite numbers. A covered pixel that is not defined counts as undefined, whatever its state says.
  bool defined(std::size_t pixel) const {
    return state[pixel] == PixelState::drawn &&
           std::ranges::all_of(values(pixel), [](double v) { return std::isfinite(v); });
  }
};

}  // namespace quadrille::compare
