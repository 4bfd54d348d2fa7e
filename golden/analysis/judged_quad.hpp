// One quad with its truths, and how far the machine may be from them: the bounds of error_bound.hpp, and the pixels at
// which the machine's result is exact by its specification (rtl/SPEC.md).
#pragma once

#include "golden/reference/truth.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstdint>
#include <optional>

namespace quadrille {

/// The arithmetic bound |error of a weight| <= 2^-(s-3) of a configuration, weights 1 to 3.
double weight_bound(const Config& config);

/// What a configuration's bounds are: of a weight 1 to 3, and of a value of spread 1 (golden/analysis: c 2^-(s-3),
/// beside half a code). `of_cut_w`: by a sum of M W with some W of more than S bits.
struct Bounds {
  explicit Bounds(const Config& config);

  double weight, value, value_of_cut_w;
};

/// What the machine writes for a real number: to nearest on a grid, clamped below a limit.
struct FixedPoint {
  int int_bits, frac_bits;

  double unit() const;                ///< value of one code
  double limit() const;               ///< the least magnitude that is clamped
  std::int64_t largest_code() const;  ///< what it is clamped to
  /// How far `value` is from the numbers that are rounded to `code`, both counted from the same base; 0 for one of
  /// them.
  double distance(std::int64_t code, double value) const;
  /// Whether `code` can stand for a real number within `tolerance` of `value`, if that was not clamped.
  bool may_stand_for(std::int64_t code, double value, double tolerance) const;
};

FixedPoint attribute_format(const Config& config);
FixedPoint depth_format(const Config& config);

/// sig 2^exponent in units of 2^-frac_bits, to nearest, halves up; nothing where it is 2^int_bits or more.
std::optional<std::int64_t> nearest_code(std::uint64_t sig, int exponent, int int_bits, int frac_bits);

/// The largest minus the least of a slot's differences at the corners; that of vertex 0 is 0, which is the base's too.
double attribute_spread(const SnappedQuad& quad, std::size_t slot, const Config& config, bool perspective);
/// The same of window z at the corners and the base. Every W > 0.
double depth_spread(const SnappedQuad& quad, const Config& config);
/// Some W has more than S significant bits: the machine's sum of M W is of others.
bool cuts_w(const SnappedQuad& quad, const Config& config);

class JudgedQuad {
 public:
  /// `snapped`, `config` and `bounds` must outlive this. `state` is that of the truth, which may leave out attributes.
  JudgedQuad(const SnappedQuad& snapped, const Config& config, const Bounds& bounds, const DrawState& state);

  const SnappedQuad& quad() const { return quad_; }
  const golden::TruthQuad& truth() const { return truth_; }
  const Bounds& bounds() const { return bounds_; }

  /// The bounds are statements about exact D and R²: where the configuration drops bits of them, depth and sums that
  /// may cancel have no tolerance, and the sign of sum(M w) is the machine's own.
  bool bounded() const { return config_.qdrop() == 0; }

  /// Without perspective and with a vertex behind the eye the sums of M W may cancel: the weights' bound does not hold,
  /// but what is left of it.
  bool may_cancel() const { return may_cancel_; }

  /// Of window z: some w is not positive.
  bool depth_may_cancel() const { return depth_may_cancel_; }

  /// Whether a machine may disagree about a covered pixel being in front of the eye: the eye is in the hull of the
  /// vertices and |sum(M w)| below the bound; but a sum of zeros is 0 in any arithmetic.
  bool tolerates_visibility(const golden::ReferenceSample& truth) const;

  /// How far window z may be off before the output is rounded: the bound of its spread, which does not depend on the
  /// pixel. Where some w is not positive each M carries the weights' relative error: infinite where sum(M w) cancels to
  /// what that error leaves of it.
  double depth_tolerance(int x, int y) const;
  /// The same of an attribute: pixels matter where sum(M W) may cancel.
  double attribute_tolerance(std::size_t slot, int x, int y) const;
  /// Of a quotient `above` by a sum that may cancel: `numerator` is the sum of |M D|, `denominator` that of |M W|, both
  /// relative to |sum(M W)|.
  double cancelled_tolerance(double above, double numerator, double denominator) const;

  /// At a corner M is 1 for it and 0 for the others, and the reciprocal of a power of two is exact: the code that the
  /// machine must give, where k_eff (W for depth) is one, or where there is no difference to the base. `corner`:
  /// corner_at() of the pixel.
  std::optional<std::int64_t> exact_attribute(int corner, std::size_t slot) const;
  std::optional<std::int64_t> exact_depth(int corner) const;
  /// The corner at a pixel of class on_vertex.
  int corner_at(int x, int y) const;

 private:
  double quotient_tolerance(int x, int y, const std::array<double, 4>& numerator) const;

  const SnappedQuad& quad_;
  const Config& config_;
  const Bounds& bounds_;
  golden::TruthQuad truth_;
  bool perspective_, may_cancel_, depth_may_cancel_;
  std::array<double, 4> w_{};  ///< real values
  double depth_tolerance_ = 0;
  std::array<double, max_attribute_slots> attribute_tolerance_{};
};

}  // namespace quadrille
