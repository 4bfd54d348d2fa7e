// Errors that no weight, attribute or depth can exceed, for every input that the port accepts. The derivation is in
// golden/analysis/README.md, "Error bound".
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <string>
#include <vector>

namespace quadrille {

/// Bound of an absolute error, or the best that can be said.
struct ErrorBound {
  double value = 0;     ///< rounded up; infinity where nothing is claimed
  bool proved = false;  ///< else estimated: the rule of thumb 2^-(s-3), where the proof's assumptions do not hold
  std::string reason;   ///< what the proof rests on, or which assumption fails
};

/// Least and largest relative error of a table with truncation of its argument to S bits (sqrt) or without
/// (reciprocal), as natural logarithms of result / exact result.
struct TableError {
  double low = 0, high = 0;
};
TableError sqrt_error(const Config& config);
TableError reciprocal_error(const Config& config);

/// max |Δλ'_i|, i = 1 to 3, against exact arithmetic on the same snapped quad, with perspective (or every W = 1
/// without), by analysis of the accumulated relative errors of t, M and the sums; half a code of the output included.
/// λ'_0 is what its base leaves of the others: a value of spread 1.
ErrorBound bound_lambda(const Config& config);

/// c of |Δa| <= c 2^-(s-3) spread + half a code. `spread`: the largest minus the least of the corners' values and the
/// base, of an attribute or of window z with every W > 0. Of the arithmetic with all bits of D and r². `w_is_cut`: the
/// denominator is a sum of M W and some W has more than S bits.
double value_bound_factor(const Config& config, bool w_is_cut = false);

/// The bound of an attribute of that spread that does not saturate, half a code included; with perspective, or every
/// W = 1.
ErrorBound bound_attribute(const Config& config, double spread);
/// The same of window z of a quad of ordinary vertices (snap.hpp).
ErrorBound bound_depth(const Config& config, double spread);

}  // namespace quadrille
