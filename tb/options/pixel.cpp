#include "tb/options/pixel.hpp"

#include "tb/support/errors.hpp"

#include <charconv>

namespace quadrille::tb {

PixelOption parse_pixel(const std::string& text, const DrawState& state) {
  PixelOption pixel;
  const char* end = text.data() + text.size();
  const auto [comma, error] = std::from_chars(text.data(), end, pixel.x);
  const bool first = error == std::errc{} && comma != end && *comma == ',';
  const auto [last, second] =
      first ? std::from_chars(comma + 1, end, pixel.y) : std::from_chars_result{end, std::errc::invalid_argument};
  if (!first || second != std::errc{} || last != end || pixel.x < 0 || pixel.y < 0 || pixel.x >= state.width ||
      pixel.y >= state.height)
    throw UsageError("--pixel " + text + ": expected X,Y inside the viewport, such as --pixel 10,20");
  return pixel;
}

}  // namespace quadrille::tb
