// What a sweep knows about one configuration on one input.
#pragma once

#include "tb/support/outputs.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace quadrille::sweep {

using tb::Output;
using tb::outputs;

/// Colours of a quad's corners v0 to v3, channels in [0, 1]: R runs across the quad, G along it, B is a saddle.
inline constexpr std::array<std::array<double, 3>, 4> corner_colour{{{1, 0, 1}, {1, 1, 0}, {0, 1, 1}, {0, 0, 0}}};

/// Absolute errors over fragments and all components of an output. Arithmetic: fragments that the machine draws and
/// that exact arithmetic on the same snapped quad sees in front of the eye. Snapping: pixels that exact arithmetic
/// draws on the snapped as on the given quad. Neither counts quads with a vertex behind the eye drawn without
/// perspective, whose weights may cancel without limit. count 0: not measured (depth off, no attributes).
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
  std::uint64_t fragments = 0;                                    ///< drawn by the machine
  std::array<ErrorSummary, outputs.size()> snapping, arithmetic;  ///< by Output
  // Pixels of a quad; "draws": covers, visible, not culled, window z in the interval.
  std::uint64_t coverage_gained = 0;  ///< drawn though exact arithmetic on the given, unsnapped quad does not
  std::uint64_t coverage_lost = 0;    ///< that exact arithmetic on the given quad draws, not drawn
  std::uint64_t discard_differs = 0;  ///< covered pixels whose visibility or z interval the machine decides otherwise
                                      ///< than exact arithmetic on the same snapped quad
  std::uint64_t colour_codes = 0;     ///< 8-bit channels (round to nearest) that differ from the snapped truth's
  std::uint64_t saturated = 0;        ///< fragments with a weight, attribute or colour clamped to the output format
  // plane_quads: quads whose attributes and depth are drawn with areas for weights. Judged on the draw of all
  // the input's attributes; their errors stay those against mean values. Weights and colours keep mean values.
  std::uint64_t quads = 0;            ///< that cover a pixel, in front of the eye
  std::uint64_t plane_quads = 0;      ///< of these taken
  std::uint64_t plane_fragments = 0;  ///< of these drawn
  std::uint64_t cycles = 0;           ///< clocks of the whole draw, without stalls; 0: not asked for
  WorstPixel worst;
  // How far values are apart at the corners of a quad, largest of the quads that cover a pixel: errors are
  // bounded by it.
  double attribute_spread = 0;
  double depth_spread = 0;  ///< infinity: some quad has a vertex that is not before the eye
};

}  // namespace quadrille::sweep
