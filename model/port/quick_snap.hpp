// Snapping of ordinary quads in double precision: quick, and proved value by value.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstddef>

namespace quadrille {

/// What snap_quad gives of a quad, but for its id, to `out`, which holds nothing yet. Each vertex has `attributes`
/// attributes at least. False: the quad is refused, it has a vertex that is not ordinary, or a value lies so near to a
/// tie that doubles do not prove its rounding; what `out` holds then is nobody's.
///
/// A value is off by fewer than a dozen roundings of 2^-52, in whatever mode the processor rounds or treats subnormal
/// numbers: that is less than half of each distance from a tie that is asked for.
bool quick_snap(const WindowQuad& quad, std::size_t attributes, const Config& config, const DrawState& state,
                SnappedQuad& out);

}  // namespace quadrille
