// A pixel as an option's value.
#pragma once

#include "model/port/records.hpp"

#include <string>

namespace quadrille::tb {

struct PixelOption {
  int x = -1, y = -1;
};
/// --pixel X,Y inside the viewport; throws UsageError.
PixelOption parse_pixel(const std::string& text, const DrawState& state);

}  // namespace quadrille::tb
