// The outputs of a fragment whose errors are measured.
#pragma once

#include <array>
#include <string_view>

namespace quadrille::tb {

/// colour: three 8-bit test channels, which `quadrille sweep` alone has.
enum class Output { weight, attribute, depth, colour };

struct OutputInfo {
  std::string_view name, column;  ///< column: in the names of columns of files
  std::string_view unit, meaning;
};
inline constexpr std::array<OutputInfo, 4> outputs{
    {{"weight", "lambda", "1", "the weights"},
     {"attribute", "attribute", "the attributes'", "the input's attributes"},
     {"depth", "depth", "1", "window z"},
     {"colour", "colour", "1", "three colour channels"}}};

/// Of those that a bound speaks of: all but colour.
inline constexpr std::array output_names{outputs[0].name, outputs[1].name, outputs[2].name};

}  // namespace quadrille::tb
