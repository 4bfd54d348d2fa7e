// Proofs beside the samples: intervals that no value can leave, and an error that no weight can exceed, for every input
// that the port accepts. The derivation is in golden/analysis/README.md, "Error bound".
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <string>
#include <vector>

namespace quadrille {

/// One signal with the interval of its values and the width that the configuration gives it.
struct SignalRange {
  std::string signal;        ///< as in rtl/SPEC.md, e.g. "A", "D", "gx of r²", "exponent of M"
  double low = 0, high = 0;  ///< in units of the signal's least bit, rounded outward
  int bits = 0;              ///< width; signed when `is_signed`
  bool is_signed = true;
  bool fits = false;
};

/// Interval analysis from the port to the fragment. A signal is listed with the values that are used: a sum whose terms
/// pass through values outside its width modulo 2^width (forward differences, the extent test, determinants) is right
/// when its result fits.
struct RangeProof {
  std::vector<SignalRange> signals;
  bool proved = false;  ///< every signal fits
};

/// D and r² of ordinary vertices (snap.hpp) lose no bit: neither the functions of a tile, nor a squared length, nor
/// half of a sum by the law of cosines. The rule is QDROP <= 2 homogeneous_frac_bits; README.md, "Dropped bits".
bool keeps_ordinary_products(const Config& config);

/// The widths that the proof is about, apart from the configuration, so that others can be tried.
struct ProofWidths {
  int position, weight;          ///< T_BITS, W_BITS
  int value, grad;               ///< of linear functions
  int qvalue, qgrad, qcurv;      ///< of quadratic functions
  int length2;                   ///< LENGTH2_BITS, unsigned
  int tile;                      ///< TC_BITS, unsigned
  int dot_operand, dot_result;   ///< of the setup's dot units
  int determinant;               ///< DET_BITS
  int exponent, port_exponent;   ///< EXP_BITS, PORT_EXP_BITS
  int term;                      ///< an aligned term of a sum, unsigned
  int table_word, table_factor;  ///< C0; C1, C2 and the inner factor; unsigned
  int attribute, depth;          ///< at the fragment port; depth unsigned

  explicit ProofWidths(const Config& config);
};

/// Throws ConfigError when a table of the configuration cannot be made.
RangeProof prove_ranges(const Config& config);
RangeProof prove_ranges(const Config& config, const ProofWidths& widths);

/// Regular pixels keep within 2^±120 from A, D and r² to M, lengths in pixels: exponents of a single precision number,
/// with room. The sums have numbers of the port on top. Rounded outward; `bits` is 0.
inline constexpr int regular_exponent_limit = 120;
RangeProof prove_regular_range(const Config& config);

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
