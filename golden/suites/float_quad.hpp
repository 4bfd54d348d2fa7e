// Fragments of the machine against floating point.
#pragma once

#include "golden/reference/paper_float.hpp"
#include "golden/suites/suite.hpp"

#include <array>
#include <cmath>

namespace quadrille::vectors {

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
  /// Of the scissor; outside of them it draws nothing.
  const golden::CoverageRows& rows() const { return paper_.rows(); }

 private:
  VectorOutcome check_values(const Fragment& fragment) const;

  SnappedQuad quad_;
  Config config_;
  DrawState state_;
  golden::PaperFp64Quad paper_;
  unsigned visible_ = 0;
  bool visible_decided_ = true, homogeneous_ = false, hull_ = false, behind_ = false;
  std::array<double, 4> place_{}, k_over_w_{}, z_over_w_{};
  std::array<std::array<double, 4>, max_attribute_slots> b_over_w_{};
};

}  // namespace quadrille::vectors
