// One quad with its truths, and how far the machine may be from them: tolerances that follow from the bound on the
// weights, and the pixels at which the machine's result is exact by its specification (rtl/README.md sections 2 and 5).
#pragma once

#include "golden/reference/truth.hpp"
#include "model/config.hpp"
#include "model/records.hpp"

#include <cstdint>
#include <optional>

namespace quadrille::cli {

/// What the machine writes for a real number: the magnitude truncated on a grid, clamped below a limit.
struct FixedPoint {
  int int_bits, frac_bits;

  double unit() const;                ///< value of one code
  double limit() const;               ///< the least magnitude that is clamped
  std::int64_t largest_code() const;  ///< what it is clamped to
  /// sig * 2^exponent on the grid, exactly.
  std::int64_t code_of(bool neg, std::uint64_t sig, int exponent) const;
  /// How far `value` is from the numbers that are truncated to `code`; 0 for one of them.
  double distance(std::int64_t code, double value) const;
  /// Whether `code` can stand for a real number within `tolerance` of `value`, if that was not clamped.
  bool may_stand_for(std::int64_t code, double value, double tolerance) const;
};

FixedPoint attribute_format(const Config& config);
FixedPoint depth_format(const Config& config);

/// Which depth codes are drawn: near_code to far_code, both included.
class DepthLimits {
 public:
  DepthLimits(const Config& config, const DrawState& state);

  bool holds(std::int64_t code) const { return code >= near_code_ && code <= far_code_; }
  /// 1: a window z within `tolerance` of z is drawn; -1: is not; 0: may be either.
  int side(double z, double tolerance) const;

 private:
  std::int64_t near_code_, far_code_;
  double lowest_, end_;  ///< window z is drawn from lowest_ to below end_
};

class JudgedQuad {
 public:
  /// `snapped` and `config` must outlive this. `state` is that of the truth, which may leave out attributes.
  JudgedQuad(const SnappedQuad& snapped, const Config& config, const DrawState& state);

  const SnappedQuad& quad() const { return quad_; }
  const golden::TruthQuad& truth() const { return truth_; }

  /// The bound on the weights is a statement about exact D and R²: where the configuration drops bits of them, sums
  /// that may cancel have no tolerance, and the sign of sum(M w) is the machine's own.
  bool bounded() const { return config_.qdrop() == 0; }

  /// Without perspective and with a vertex behind the eye the sums of M W may cancel: the weights' bound does not hold,
  /// but what is left of it.
  bool may_cancel() const { return may_cancel_; }

  /// Of window z: some w is not positive, or z differs in sign.
  bool depth_may_cancel() const { return depth_may_cancel_; }

  /// Whether a machine may disagree about a covered pixel being in front of the eye: the eye is in the hull of the
  /// vertices and |sum(M w)| below the bound; but a sum of zeros is 0 in any arithmetic.
  bool tolerates_visibility(const golden::ReferenceSample& truth, double bound) const;

  /// How far window z before the output's truncation may be off: each M carries the weights' relative error. Infinite
  /// where sum(M w) cancels to what that error leaves of it.
  double depth_tolerance(int x, int y, double bound) const;
  /// The same of sum(M b) / sum(M k_eff) = `value`, b of attribute slot `slot`. Where nothing can cancel: a =
  /// sum(lambda' a_i), each lambda' within `bound`.
  double attribute_tolerance(std::size_t slot, double value, int x, int y, double bound) const;

  /// At a corner M is 1 for it and 0 for the others, and the reciprocal of a power of two is exact: the code that the
  /// machine must give, where k_eff (W for depth) is one. `corner`: corner_at() of the pixel.
  std::optional<std::int64_t> exact_attribute(int corner, std::size_t slot) const;
  std::optional<std::int64_t> exact_depth(int corner) const;
  /// The corner at a pixel of class on_vertex.
  int corner_at(int x, int y) const;

 private:
  double quotient_tolerance(int x, int y, double bound, const std::array<double, 4>& numerator, double value) const;

  const SnappedQuad& quad_;
  const Config& config_;
  golden::TruthQuad truth_;
  bool perspective_, may_cancel_, depth_may_cancel_;
  std::array<double, 4> w_{};  ///< real values
};

}  // namespace quadrille::cli
