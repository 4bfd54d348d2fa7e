// Approaches: one quad and one special case each, and a knob that is the distance between them: 2^-knob on either side,
// and the case itself. What the stress families draw at random, these walk towards step by step.
#pragma once

#include "model/port/records.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::golden {

struct Approach {
  std::string_view name;
  std::string_view special;  ///< the case that is approached
  std::string_view knob;     ///< what 2^-knob (long edges: 2^knob) is
  int first, last;           ///< knobs, both included
  bool both_sides;           ///< side -1 is another quad than side 1
  bool limit;                ///< side 0, the special case, is a quad
  int width, height;         ///< of the viewport
  double attribute = 1;      ///< none is larger
};

/// In the order in which they are drawn.
std::span<const Approach> approaches();
/// Null for an unknown name.
const Approach* find_approach(std::string_view name);

/// `count` quads, id = index; the same arguments give the same bits on every machine. Quad i is the same at every knob
/// and side but for what these say; its other corners, its place and its attributes follow from seed and i. side: 1,
/// -1, or 0 for the special case, which does not depend on the knob. Corners are multiples of 1/256 px, or of 2^-knob
/// px where that is finer, so that with subpixel_bits = 8 the special case is exact after snapping. The guard band is
/// that of the standard configuration. Throws std::invalid_argument for a knob or side that the approach does not have.
std::vector<WindowQuad> make_approach(const Approach& approach, int knob, int side, std::size_t count,
                                      std::uint64_t seed, int attributes);

/// Where in a quad of make_approach the special case is: a pixel centre that it happens at, a point that the special
/// corners are at, or the whole quad. The same at every knob and side.
struct ApproachPlace {
  /// In pixels of the window (pixel (x, y) has its centre at x + 0.5, y + 0.5).
  double near_x = 0, near_y = 0;
  /// The pixels whose centre is at most so far away are those near the case: 0 where it is of one pixel, infinite where
  /// it is of the whole quad.
  double near_radius = std::numeric_limits<double>::infinity();
  /// Which corner of the quad is the one that the definition (approach.cpp) calls 0, 1, 2, 3.
  std::array<std::size_t, 4> corner{0, 1, 2, 3};

  bool is_near(int x, int y) const;
};
/// Of the quads that make_approach gives for the same arguments.
std::vector<ApproachPlace> approach_places(const Approach& approach, int knob, int side, std::size_t count,
                                           std::uint64_t seed);

}  // namespace quadrille::golden
