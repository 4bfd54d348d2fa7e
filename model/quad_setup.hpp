// Twin of rtl/quad_setup.sv: four snapped vertices to initial values and increments of every linear and quadratic
// function.
#pragma once

#include "model/stages.hpp"

namespace quadrille {

/// Exact. Linear forms in units 2^-2FRAC (VAL_BITS, GRAD_BITS); quadratic forms in units 2^-quadratic_frac (floor of
/// the exact values by QDROP bits). `slot` of the result is 0. Source: Hormann & Tarini section 4.2, in the homogeneous
/// form of Olano & Greer.
SetupResult quad_setup(const SnappedQuad& quad, const Config& config, const DrawState& state);

/// Clocks from start to done, both excluded: PREP + RUN + DRAIN of rtl/README.md section 4.
int quad_setup_clocks(bool homogeneous);

}  // namespace quadrille
