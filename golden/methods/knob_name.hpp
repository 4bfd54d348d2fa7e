// A method's name with a real number as its knob.
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>

namespace quadrille::golden::methods {

/// "adaptive:0.001": the shortest text that reads back as the same number.
inline std::string knob_name(std::string_view method, double knob) {
  std::array<char, 32> text{};
  const std::to_chars_result result = std::to_chars(text.data(), text.data() + text.size(), knob);
  return std::string(method) + ':' + std::string(text.data(), static_cast<std::size_t>(result.ptr - text.data()));
}

}  // namespace quadrille::golden::methods
