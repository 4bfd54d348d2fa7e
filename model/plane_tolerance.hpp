// Twin of rtl/plane_tolerance.sv: convex quads whose values are so nearly plane that areas of triangles are good enough
// weights.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"

namespace quadrille {

/// The configuration has a tolerance, of 2^-plane_tolerance_bits of a value's range; else quads are exactly plane or
/// not at all.
inline bool has_plane_tolerance(const Config& config) {
  return config.plane_tolerance_bits >= 1 && config.plane_tolerance_bits <= 16;
}

/// Bits of the significands that the test multiplies (quadrille_pkg::PLANE_SIG_BITS): those of the port, and at least
/// six more than the tolerance, so that the limit of a parallelogram is twice what truncation may have taken.
inline int plane_sig_bits(const Config& config) {
  const int least = config.plane_tolerance_bits + 6;
  return config.significand_bits > least ? config.significand_bits : least;
}

/// An ordinary, strictly convex quad over which every attribute in use and the depth in use change by at most
/// 2^-plane_tolerance_bits of their largest magnitude at a corner when areas stand for mean value weights.
///
/// With c_i the area of the triangle of the other three corners, Σ ±c_i V_i = 0 (signs + - + -), and D = Σ ±c_i f_i is
/// 0 for a plane function. Any two sets of weights >= 0 that reproduce linear functions give results that differ by
/// |D| / c_i at most, whichever corner i is taken (rtl/README.md section 5); the largest c_i is at least
/// (c_1 + c_3) / 2. D is formed of truncated numbers, which can be off by 2^(P+3): the test errs by refusing.
/// Source: the affine dependency of four points; the bound is derived there. Never without takes_plane_quads.
bool plane_tolerance(const SnappedQuad& quad, const Config& config, const DrawState& state);

/// Quads that plane_tolerance looks at: where there is a tolerance, ordinary ones that are not exactly plane.
bool plane_tolerance_tests(const SnappedQuad& quad, const Config& config, const DrawState& state);
/// The corners turn all to one side; only of such quads values are looked at.
bool strictly_convex(const SnappedQuad& quad);

/// plane_quad or plane_tolerance: its weights are areas.
bool takes_areas(const SnappedQuad& quad, const Config& config, const DrawState& state);

}  // namespace quadrille
