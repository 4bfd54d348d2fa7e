// Twin of rtl/quad_setup.sv: four snapped vertices to initial values and increments of the linear functions, lengths of
// sides and diagonals, visibility.
#pragma once

#include "model/stages.hpp"

namespace quadrille {

/// Exact. Linear forms in units 2^-2FRAC (VAL_BITS, GRAD_BITS); squared lengths in units 2^-quadratic_frac (floor of
/// the exact values by QDROP bits). `slot` of the result is 0. Source: Hormann & Tarini section 4.2, in the homogeneous
/// form of Olano & Greer.
SetupResult quad_setup(const SnappedQuad& quad, const Config& config, const DrawState& state);

/// Clocks in RUN, and those from the last of them until its result is there: rtl/README.md section 4.
int quad_setup_steps(bool homogeneous);
inline constexpr int quad_setup_result_clocks = 6;

}  // namespace quadrille
