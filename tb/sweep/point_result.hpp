// What a sweep knows about one configuration on one input.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace quadrille::sweep {

/// What errors are measured of. lambda: the weights λ' (unit 1). attribute: the input's own attributes (their units).
/// depth: window z (unit 1). colour: three 8-bit test channels in [0, 1], the corners of the quad coloured
/// v0 (1, 0, 1), v1 (1, 1, 0), v2 (0, 1, 1), v3 (0, 0, 0): R runs across the quad, G along it, B is a saddle.
enum class Quantity { lambda, attribute, depth, colour };
inline constexpr std::array<std::string_view, 4> quantity_names{"lambda", "attribute", "depth", "colour"};
inline constexpr std::array<std::array<double, 3>, 4> corner_colour{
    {{1, 0, 1}, {1, 1, 0}, {0, 1, 1}, {0, 0, 0}}};

/// Absolute errors over all fragments and components of a quantity. count 0: not measured (depth off, no attributes).
struct ErrorSummary {
  std::uint64_t count = 0;
  double max = 0, p999 = 0, rms = 0, mean = 0;  ///< p999: upper edge of a 1/16-octave bin, at most max
};

/// The fragment whose weights are furthest off.
struct WorstPixel {
  bool any = false;
  std::uint32_t index = 0;  ///< position of the quad in the input
  int x = 0, y = 0;
  double error = 0;  ///< max over the four weights of |Δλ'|, arithmetic
};

struct PointResult {
  std::string refused;  ///< not empty: the configuration cannot draw this input, for this reason; the rest is unset
  std::uint64_t fragments = 0;  ///< drawn by the machine
  std::array<ErrorSummary, 4> snapping, arithmetic;  ///< by Quantity
  std::uint64_t coverage_gained = 0;  ///< pixels drawn though the given, unsnapped quad does not cover them
  std::uint64_t coverage_lost = 0;    ///< pixels that the given quad covers (visible, in the z interval), not drawn
  std::uint64_t discard_differs = 0;  ///< covered pixels whose visibility or z interval the machine decides otherwise
                                      ///< than exact arithmetic on the same snapped quad
  std::uint64_t colour_codes = 0;     ///< 8-bit channels (round to nearest) that differ from the snapped truth's
  std::uint64_t saturated = 0;        ///< fragments with an attribute clamped to its format
  std::uint64_t cycles = 0;           ///< clocks of the whole draw, without stalls; 0: not asked for
  WorstPixel worst;
};

}  // namespace quadrille::sweep
