// Golden vectors against floating point: every response evaluated from its stimulus by the mathematics of the stage in
// long double, without the functions of the model, and held against the stage's bound. Integers and signs are exact
// wherever long double holds them; significand numbers must lie where truncations as in rtl/SPEC.md, Numbers, can
// leave them. Clocks (of fragments and of beats) and stall patterns are not looked at: only the clocked model and the
// RTL have them.
#pragma once

#include "golden/suites/suite.hpp"

namespace quadrille::vectors {

/// Every response of a suite; vectors are undefined where floating point has no answer to a field: a decision within
/// rounding of its threshold, a division by zero of the paper's formulas, an input that snapping refuses. The other
/// fields are compared (of a fragment always quad, x, y). Throws golden::InputError when the records are not those of
/// the suite.
VerifyResult verify_float(const Suite& suite, const SuiteReader& reader, unsigned threads);

}  // namespace quadrille::vectors
