#include "golden/io/heat_scale.hpp"

#include "golden/io/image_diff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace quadrille::golden {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour paper{240, 240, 238}, ink{30, 30, 30}, equal_colour{0, 0, 0}, nan_colour{255, 255, 255};

/// Rows of 5 pixels, the left one in bit 4; only what the scale says.
using Glyph = std::array<std::uint8_t, 7>;
constexpr std::array<std::pair<char, Glyph>, 34> font{
    {{'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}}, {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
     {'2', {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}}, {'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
     {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}}, {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
     {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}}, {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
     {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}}, {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
     {'+', {0x00, 0x04, 0x04, 0x1f, 0x04, 0x04, 0x00}}, {'-', {0x00, 0x00, 0x00, 0x1f, 0x00, 0x00, 0x00}},
     {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}}, {',', {0x00, 0x00, 0x00, 0x00, 0x0c, 0x04, 0x08}},
     {'|', {0x04, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}}, {'A', {0x0e, 0x11, 0x11, 0x11, 0x1f, 0x11, 0x11}},
     {'B', {0x1e, 0x11, 0x11, 0x1e, 0x11, 0x11, 0x1e}}, {'N', {0x11, 0x11, 0x19, 0x15, 0x13, 0x11, 0x11}},
     {'a', {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f}}, {'c', {0x00, 0x00, 0x0e, 0x10, 0x10, 0x11, 0x0e}},
     {'d', {0x01, 0x01, 0x0d, 0x13, 0x11, 0x13, 0x0d}}, {'e', {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e}},
     {'f', {0x06, 0x09, 0x08, 0x1c, 0x08, 0x08, 0x08}}, {'g', {0x00, 0x0f, 0x11, 0x11, 0x0f, 0x01, 0x0e}},
     {'h', {0x10, 0x10, 0x16, 0x19, 0x11, 0x11, 0x11}}, {'i', {0x04, 0x00, 0x0c, 0x04, 0x04, 0x04, 0x0e}},
     {'l', {0x0c, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}}, {'n', {0x00, 0x00, 0x16, 0x19, 0x11, 0x11, 0x11}},
     {'o', {0x00, 0x00, 0x0e, 0x11, 0x11, 0x11, 0x0e}}, {'q', {0x00, 0x00, 0x0d, 0x13, 0x0f, 0x01, 0x01}},
     {'r', {0x00, 0x00, 0x16, 0x19, 0x10, 0x10, 0x10}}, {'s', {0x00, 0x00, 0x0e, 0x10, 0x0e, 0x01, 0x1e}},
     {'t', {0x08, 0x08, 0x1c, 0x08, 0x08, 0x09, 0x06}}, {'u', {0x00, 0x00, 0x11, 0x11, 0x11, 0x13, 0x0d}}}};

/// A picture to draw on.
class Canvas {
 public:
  Canvas(int width, int height, int pixel) : pixel_(pixel) {
    image.width = width;
    image.height = height;
    image.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 255);
    box(0, 0, width, height, paper);
  }

  void box(int x, int y, int width, int height, const Colour& colour) {
    for (int row = std::max(y, 0); row < std::min(y + height, image.height); ++row)
      for (int column = std::max(x, 0); column < std::min(x + width, image.width); ++column)
        std::ranges::copy(colour, image.rgba.begin() + (static_cast<std::ptrdiff_t>(row) * image.width + column) * 4);
  }

  int width_of(std::string_view text) const { return (static_cast<int>(text.size()) * 6 - 1) * pixel_; }

  void write(int x, int y, std::string_view text) {
    for (const char c : text) {
      const auto* const found = std::ranges::find(font, c, &std::pair<char, Glyph>::first);
      for (int row = 0; found != font.end() && row < 7; ++row)
        for (int column = 0; column < 5; ++column)
          if ((found->second[static_cast<std::size_t>(row)] >> (4 - column) & 1) != 0)
            box(x + column * pixel_, y + row * pixel_, pixel_, pixel_, ink);
      x += 6 * pixel_;
    }
  }

  Image8 image;

 private:
  int pixel_;  ///< side of a letter's pixel
};

/// Three digits at most, exponents without leading zeros: 0.0312, 1e-5.
std::string short_number(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
  std::string text = buffer.data();
  if (const std::size_t e = text.find('e'); e != std::string::npos)
    while (text.size() > e + 3 && text[e + 2] == '0') text.erase(e + 2, 1);
  return text;
}

}  // namespace

Image8 with_heat_scale(const Image8& map, double most, int octaves) {
  constexpr std::string_view title = "largest |A-B|, unit of the channel", none = "no difference";
  constexpr int narrowest = 230, wide = 460;  // the title in small and in large letters
  const int width = std::max(map.width, narrowest), p = width >= wide ? 2 : 1, margin = 6 * p, line = 10 * p;
  const int bar = 10 * p, height = map.height + margin + (most > 0 ? 2 * line + bar + 4 * p : 0) + line + margin;
  Canvas canvas(width, height, p);
  for (int y = 0; y < map.height; ++y)
    std::copy_n(map.rgba.begin() + static_cast<std::ptrdiff_t>(y) * map.width * 4, map.width * 4,
                canvas.image.rgba.begin() + static_cast<std::ptrdiff_t>(y) * width * 4);
  int y = map.height + margin;
  if (most > 0) {
    canvas.write(margin, y, title);
    y += line;
    const int length = width - 2 * margin;
    for (int i = 0; i < length; ++i)
      canvas.box(margin + i, y, 1, bar,
                 heat_colour(most * std::exp2(octaves * ((i + 0.5) / length - 1)), most, octaves));
    y += bar;
    const int labels = y + 3 * p;
    const std::string low = short_number(std::ldexp(most, -octaves)), high = short_number(most);
    canvas.write(margin, labels, low);
    canvas.write(width - margin - canvas.width_of(high), labels, high);
    int free_from = margin + canvas.width_of(low) + 6 * p;
    const int free_to = width - margin - canvas.width_of(high) - 6 * p;
    for (int power = static_cast<int>(std::ceil(std::log10(std::ldexp(most, -octaves)))); std::pow(10, power) < most;
         ++power) {
      const double value = std::pow(10, power);
      const int x = margin + static_cast<int>(std::lround(length * (1 + std::log2(value / most) / octaves)));
      canvas.box(x, y, p, 2 * p, ink);
      const std::string text = short_number(value);
      const int half = canvas.width_of(text) / 2;
      if (x - half < free_from || x + half > free_to) continue;
      canvas.write(x - half, labels, text);
      free_from = x + half + 6 * p;
    }
    y += line + 4 * p;
  } else {
    canvas.write(width - margin - canvas.width_of(none), y, none);
  }
  int x = margin;
  for (const auto& [colour, text] : {std::pair{equal_colour, "equal"}, std::pair{nan_colour, "NaN"}}) {
    canvas.box(x, y, 7 * p, 7 * p, ink);
    canvas.box(x + 1, y + 1, 7 * p - 2, 7 * p - 2, colour);
    canvas.write(x + 10 * p, y, text);
    x += 20 * p + canvas.width_of(text);
  }
  return std::move(canvas.image);
}

}  // namespace quadrille::golden
