// Intervals that no value can leave, for every input that the port accepts. The derivation is in
// golden/analysis/README.md, "Error bound".
#pragma once

#include "model/port/config.hpp"

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

}  // namespace quadrille
