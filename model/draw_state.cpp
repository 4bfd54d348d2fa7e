#include "model/stages.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille {

// znear rounds up and zfar down would cut valid fragments apart by rounding alone; nearest is what a register write
// does.
std::uint32_t depth_code(double z, const Config& c) {
  return static_cast<std::uint32_t>(std::llround(std::ldexp(std::clamp(z, 0.0, 1.0), c.depth_bits)));
}

}  // namespace quadrille
