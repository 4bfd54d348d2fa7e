// Quads whose values are plane over them, or nearly: for tests of plane_tolerance.
#pragma once

#include "model/records.hpp"
#include "model/support/prng.hpp"

namespace quadrille::golden {

struct NearlyPlane {
  double picture = 64;                  ///< pixels of a square picture; the rectangle's centre is in its middle third
  double half_low = 2, half_high = 20;  ///< of its sides, in pixels
  int attributes = 3;
  double bend = 0;  ///< added to one value at corner 3, relative to that value's size: 0 leaves all plane
  double tilt = 0;  ///< 0: all w are 1; 0.3: they differ by a third or so, as those of a plane quad in perspective
};

/// A rectangle turned by any angle about any point, or what is seen of one in perspective: window z and the attributes
/// are plane functions of the picture (over w), at any angle, but for `bend` of one of them.
WindowQuad nearly_plane_quad(Prng& rng, std::uint32_t id, const NearlyPlane& kind);

}  // namespace quadrille::golden
