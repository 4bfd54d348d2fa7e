// Snapping: floating-point vertices in, the integers of the machine's port out, exactly rounded. X, Y, W and k depend
// on the vertex and the draw's configuration alone, so two quads that share a vertex see the same integers. Depth and
// attributes are differences to a base of their quad.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <stdexcept>

namespace quadrille {

/// A vertex that is no point of the machine's input space. vertex: 0-3.
struct SnapError : std::runtime_error {
  SnapError(std::uint32_t quad, int vertex, const std::string& what);
  std::uint32_t quad;
  int vertex;
};

/// x, y, w in units of 2^-FRAC relative to pixel centres. Ordinary (w > 0 and inside the guard band after rounding):
/// position to nearest on the 2^-subpixel_bits grid, W = 1, k = 1/w. Otherwise k > 0 such that max(|X|/2^pos_int,
/// |Y|/2^pos_int, |W|) = 1, rounded to nearest on the 2^-FRAC grid.
///
/// Base of an attribute: vertex 0's, to nearest. Base of depth: z of the first vertex with w > 0, clamped to [0, 1], to
/// nearest. Differences times k (before rounding) have S significant bits; an attribute equal to vertex 0's has 0. Ties
/// go to even; corner depths round halves up, as znear and zfar do (rtl/SPEC.md, Snapping).
///
/// Throws ConfigError for a configuration that cannot be built, SnapError for NaN, infinity, (0,0,0), magnitudes
/// outside 2^±80 and attributes that do not fit attribute_int_bits.
SnappedQuad snap_quad(const WindowQuad& quad, const Config& config, const DrawState& state);

/// All four W are exactly 1: the machine's narrow case.
bool is_ordinary(const SnappedQuad& quad, const Config& config);

/// All four vertices are ordinary: W exactly 1, and the position on the 2^-subpixel_bits grid. A vertex in the last
/// half step of the guard band is not, though its W may be 1.
bool has_ordinary_vertices(const SnappedQuad& quad, const Config& config);

}  // namespace quadrille
