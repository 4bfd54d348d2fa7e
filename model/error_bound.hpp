// Proofs beside the samples: intervals that no value can leave, and an error that no weight can exceed, for every input
// that the port accepts.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"

#include <string>
#include <vector>

namespace quadrille {

/// One signal with the interval of its values and the width that the configuration gives it.
struct SignalRange {
  std::string signal;  ///< as in rtl/README.md, e.g. "A", "D", "gx of r²", "exponent of M"
  double low = 0, high = 0;  ///< in units of the signal's least bit, rounded outward
  int bits = 0;              ///< width; signed when `is_signed`
  bool is_signed = true;
  bool fits = false;
};

/// Interval analysis from the port to the fragment.
struct RangeProof {
  std::vector<SignalRange> signals;
  bool proved = false;  ///< every signal fits
};
RangeProof prove_ranges(const Config& config);

/// Bound of an absolute error, or the best that can be said.
struct ErrorBound {
  double value = 0;     ///< rounded up; infinity where nothing is claimed
  bool proved = false;  ///< else estimated: the rule of thumb 2^-(s-3), where the proof's assumptions do not hold
  std::string reason;   ///< what the proof rests on, or which assumption fails
};

/// max |Δλ'| against exact arithmetic on the same snapped quad, with perspective (or every W = 1 without), by analysis
/// of the accumulated relative errors of t, M and the sums; see model/README.md for the derivation.
ErrorBound bound_lambda(const Config& config);
/// The same of an attribute whose corner values lie in [-range, range] and that does not saturate.
ErrorBound bound_attribute(const Config& config, double range);
/// The same of window z of a quad of ordinary vertices with 0 <= z <= 1 at the corners.
ErrorBound bound_depth(const Config& config);

}  // namespace quadrille
