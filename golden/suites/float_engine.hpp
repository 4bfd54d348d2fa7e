// Golden vectors against floating point: every response evaluated from its stimulus by the mathematics of the stage in
// long double, without the functions of the model, and held against the stage's bound. Integers and signs are exact
// wherever long double holds them; significand numbers must lie where truncations as in rtl/README.md section 2 can
// leave them. Clocks (of fragments and of beats) and stall patterns are not looked at: only the clocked model and the
// RTL have them.
#pragma once

#include "golden/reference/paper_float.hpp"
#include "golden/suites/machine_suite.hpp"
#include "golden/suites/stage_suite.hpp"

#include <array>
#include <cmath>
#include <string_view>

namespace quadrille::vectors {

/// Every response of a suite; vectors are undefined where floating point has no answer to a field: a decision within
/// rounding of its threshold, a division by zero of the paper's formulas, an input that snapping refuses. The other
/// fields are compared (of a fragment always quad, x, y). Throws golden::InputError when the records are not those of
/// the suite.
VerifyResult verify_float(const Suite& suite, const SuiteReader& reader, unsigned threads);

/// One vector of the stage suite of that name. Of an undefined one, all that has an answer agrees.
VectorOutcome check_float(std::string_view suite, const Stage& stage, const Record& stimulus, const Record& response);

/// The fragments of one quad against the paper's formulas in double.
class FloatQuad {
 public:
  FloatQuad(const SnappedQuad& quad, const Config& config, const DrawState& state);

  /// That the machine may draw this fragment, and its values; undefined at singular pixels, where rounding in double
  /// is beyond the machine's bound, and where visibility by pixel is as close as that.
  VectorOutcome check(const Fragment& fragment) const;

  /// The machine draws this pixel of the scissor, as far as that is certain without weights: not where visibility is
  /// decided by pixel or z near its limits.
  bool must_draw(int x, int y) const;

 private:
  VectorOutcome check_values(const Fragment& fragment) const;

  SnappedQuad quad_;
  Config config_;
  DrawState state_;
  golden::PaperFp64Quad paper_;
  unsigned visible_ = 0;
  bool visible_decided_ = true, homogeneous_ = false, hull_ = false, behind_ = false;
  std::array<double, 2> lowest_{HUGE_VAL, HUGE_VAL}, highest_{-HUGE_VAL, -HUGE_VAL};  ///< X, Y of the vertices
  std::array<double, 4> place_{}, k_over_w_{}, z_over_w_{};
  std::array<std::array<double, 4>, max_attribute_slots> b_over_w_{};
};

}  // namespace quadrille::vectors
