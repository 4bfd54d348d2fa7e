// Fragments of a job against the truth.
#include "tb/judge/drawn_depths.hpp"
#include "tb/judge/fragment_reference.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace quadrille::tb {
namespace {

using golden::ReferenceSample;

/// Flags that D and R² decide, which are exact only with all of their bits.
constexpr std::uint8_t flags_of_quadratics =
    flag_on_edge | flag_on_vertex | flag_two_corner | flag_two_edge | flag_notch;

constexpr std::pair<std::uint8_t, std::uint64_t CheckResult::*> counted_flags[]{
    {flag_on_edge, &CheckResult::on_edge},
    {flag_on_vertex, &CheckResult::on_vertex},
    {flag_two_corner, &CheckResult::two_corner},
    {flag_two_edge, &CheckResult::two_edge},
    {flag_tie, &CheckResult::tie},
    {flag_homogeneous, &CheckResult::homogeneous},
    {flag_notch, &CheckResult::notch},
    {flag_saturated, &CheckResult::saturated}};

}  // namespace

/// Judges fragment after fragment of one job; what it finds is added up in result().
class FragmentChecker::FragmentJudge {
 public:
  explicit FragmentJudge(const FragmentChecker& checker)
      : checker_(checker),
        config_(checker.settings_.config),
        state_(checker.settings_.state),
        columns_(checker.settings_.pass.columns),
        first_pass_(checker.settings_.first_pass),
        exact_(config_.qdrop() == 0),
        limits_(config_, state_) {}

  void judge(std::span<const Fragment> fragments) {
    while (!fragments.empty()) {
      const std::uint32_t quad = fragments.front().quad;
      const auto other = std::ranges::find_if(fragments, [&](const Fragment& f) { return f.quad != quad; });
      const auto count = static_cast<std::size_t>(other - fragments.begin());
      judge_quad(quad, fragments.first(count));
      fragments = fragments.subspan(count);
    }
  }

  const CheckResult& result() const { return part_; }

 private:
  /// Fragments of one quad, which the truths take together.
  void judge_quad(std::uint32_t quad, std::span<const Fragment> fragments) {
    const Reference reference(checker_, quad);
    reference_ = &reference;
    pixels_.clear();
    for (const Fragment& fragment : fragments) pixels_.push_back({fragment.x, fragment.y});
    truths_.resize(pixels_.size());
    reference.truth().samples(pixels_, truths_);
    if (reference.given) {
      givens_.resize(pixels_.size());
      reference.given->samples(pixels_, givens_);
    }
    for (std::size_t i = 0; i < fragments.size(); ++i) {
      place_ = {quad, checker_.given_[quad].id, fragments[i].x, fragments[i].y};
      truth_ = truths_[i];
      given_ = reference.given ? &givens_[i] : nullptr;
      judge_fragment(fragments[i]);
    }
  }

  void judge_fragment(const Fragment& fragment) {
    corner_ = exact_ && (truth_.flags & flag_on_vertex) != 0 ? reference_->corner_at(fragment.x, fragment.y) : -1;
    cancelled_ = false;
    ++part_.compared;
    if (!judge_presence(fragment)) return;
    judge_depth(fragment);
    const bool saturated = judge_slots(fragment);
    judge_flags(fragment, saturated);
    if (first_pass_ && cancelled_) ++part_.bound_exempt;
    measure_snapping();
    if (first_pass_) count(fragment);
  }

  void differs(const std::string& what) {
    ++part_.mismatches;
    if (!part_.first.any || order(place_) < order(part_.first.place))
      part_.first = {true, place_, text_of(place_, what)};
  }

  /// Whether it should be there at all. False: nothing more can be said of it. The first pass says what is wrong.
  bool judge_presence(const Fragment& fragment) {
    if (!first_pass_) return truth_.covered && truth_.visible;
    if (fragment.x < state_.scissor_x0 || fragment.x >= state_.scissor_x1 || fragment.y < state_.scissor_y0 ||
        fragment.y >= state_.scissor_y1) {
      differs("drawn outside the scissor rectangle");
      return false;
    }
    if (!truth_.covered) {
      differs("drawn, but not covered in the truth");
      return false;
    }
    if (!truth_.visible) {
      if (reference_->tolerates_visibility(truth_))
        ++part_.tolerated_visible;
      else
        differs("drawn, but behind the eye in the truth");
      return false;
    }
    if (truth_.front != fragment.front) differs(fragment.front ? "drawn as front face" : "drawn as back face");
    if (state_.cull == (truth_.front ? Cull::front : Cull::back)) differs("drawn, but culled");
    return true;
  }

  /// The code itself decides whether it may be drawn; the truth says what it stands for.
  void judge_depth(const Fragment& fragment) {
    if (!state_.depth) {
      if (fragment.depth != 0) differs("depth is off, but the depth code is " + std::to_string(fragment.depth));
      return;
    }
    if (!limits_.holds(fragment.depth))
      differs("drawn with depth code " + std::to_string(fragment.depth) + ", outside znear and zfar");
    if (corner_ >= 0)
      if (const auto code = reference_->exact_depth(corner_); code && *code != std::int64_t{fragment.depth})
        differs("depth code " + std::to_string(fragment.depth) + " at a corner, expected " + std::to_string(*code));

    const double tolerance = reference_->depth_tolerance(fragment.x, fragment.y);
    const QuadBase& base = reference_->quad().base;
    if (first_pass_ && limits_.side(truth_.z, 0) < 0) {
      if (!limits_.cut(base) || limits_.side(truth_.z, tolerance) < 0)
        differs("drawn, but window z is outside znear and zfar");
      else
        ++part_.tolerated_depth;
    }
    // Counted from the base, beside which the tolerance may be small.
    const FixedPoint format = depth_format(config_);
    const std::int64_t above = std::int64_t{fragment.depth} - base.depth;
    if (exact_ && !format.may_stand_for(above, truth_.z_above, tolerance)) ++part_.beyond_depth;
    if (!first_pass_) return;
    const double error = static_cast<double>(above) * format.unit() - truth_.z_above;
    part_.arithmetic.depth.add(error);
    if (!reference_->depth_may_cancel() && exact_)
      part_.depth.add(part_of(format.distance(above, truth_.z_above), tolerance),
                      (truth_.z_above < 0 ? -error : error) / (tolerance + format.unit() / 2));
  }

  /// An error of 0 is no part of a bound that is 0 too.
  static double part_of(double error, double bound) { return error == 0 ? 0 : error / bound; }

  /// Every slot of the port. Returns whether an attribute may be saturated and one is at its limit.
  bool judge_slots(const Fragment& fragment) {
    const FixedPoint format = attribute_format(config_);
    const double rounding = format.unit() / 2, weight_bound = checker_.bounds_.weight;
    double lambda_error = 0, attribute_error = 0, lambda_sum = 0;
    bool attributes_hold = true, weights_hold = true, may_saturate = false, must_saturate = false;
    int weights = 0, differences = 0, attributes = 0;
    CheckResult::Worst worst;
    for (std::size_t slot = columns_.size(); slot < fragment.attribute.size(); ++slot)
      if (fragment.attribute[slot] != 0) differs("slot " + std::to_string(slot) + " is unused, but not 0");

    for (std::size_t slot = 0; slot < columns_.size(); ++slot) {
      const std::int64_t code = fragment.attribute[slot], base = reference_->quad().base.attribute[slot];
      const bool is_weight = columns_[slot] < 4;
      const double base_value = static_cast<double>(base) * format.unit();
      const double wanted =
          is_weight ? truth_.lambda[static_cast<std::size_t>(columns_[slot])] : truth_.attribute[slot];
      const double above = is_weight ? wanted - base_value : truth_.attribute_above[slot];
      const double signed_error = static_cast<double>(code - base) * format.unit() - above,
                   error = std::fabs(signed_error);
      if (corner_ >= 0)
        if (const auto exact = reference_->exact_attribute(corner_, slot); exact && *exact != code)
          differs("slot " + std::to_string(slot) + " is " + std::to_string(code) + " at a corner, expected " +
                  std::to_string(*exact));

      const double tolerance = reference_->attribute_tolerance(slot, fragment.x, fragment.y);
      if (tolerance == std::numeric_limits<double>::infinity()) {
        cancelled_ = true;
        may_saturate = true;
        continue;
      }
      const bool at_limit = std::abs(code) == format.largest_code();
      // Counted from the base, where the limit is exact: far from zero a tolerance is less than the last bit of
      // `wanted`.
      const double sign = wanted < 0 ? -1 : 1, outside = sign * above - (format.limit() - sign * base_value);
      const bool beyond = outside >= tolerance;  // whatever the errors are
      const bool clamped = at_limit && outside + tolerance >= 0 && (wanted < 0) == (code < 0);
      may_saturate = may_saturate || clamped;
      must_saturate = must_saturate || beyond;
      const bool holds = beyond ? clamped : clamped || format.may_stand_for(code - base, above, tolerance);

      if (is_weight) {
        ++weights;
        if (reference_->may_cancel()) {
          weights_hold = weights_hold && holds;
          continue;
        }
        // Weight 0 is what its base of 1 leaves of the others.
        const double allowed = columns_[slot] == 0 ? tolerance + rounding : weight_bound, ratio = error / allowed;
        if (!(ratio <= worst.ratio)) worst = {ratio, error, allowed, truth_.condition, columns_[slot], place_};
        lambda_error = std::max(lambda_error, error);
        if (columns_[slot] == 0) continue;
        ++differences;
        lambda_sum += signed_error;
      } else {
        ++attributes;
        attributes_hold = attributes_hold && holds;
        if (clamped) continue;
        if (!(error <= attribute_error)) attribute_error = error;
        if (!reference_->may_cancel())
          part_.attribute.add(part_of(format.distance(code - base, above), tolerance),
                              (above < 0 ? -signed_error : signed_error) / (tolerance + rounding));
      }
    }
    if (weights > 0 && !reference_->may_cancel()) {
      part_.arithmetic.lambda.add(lambda_error);
      part_.weight.raise(worst.ratio);
      if (differences > 0) part_.weight.mean.add(lambda_sum / (differences * weight_bound));
      weights_hold = worst.ratio <= 1;
      if (!(worst.ratio <= part_.worst.ratio) ||
          (worst.ratio == part_.worst.ratio && order(place_) < order(part_.worst.place)))
        part_.worst = worst;
    }
    if (attributes > 0 && !reference_->may_cancel()) part_.arithmetic.attribute.add(attribute_error);
    if (exact_) {
      part_.beyond_bound += !weights_hold;
      part_.beyond_attribute += !attributes_hold;
      if (must_saturate && (fragment.flags & flag_saturated) == 0)
        differs("an attribute is clamped, but not flagged saturated");
    }
    return may_saturate;
  }

  void judge_flags(const Fragment& fragment, bool may_saturate) {
    unsigned known = flag_tie | flag_homogeneous, expected = truth_.flags;
    if (exact_) known |= flags_of_quadratics;
    if (config_.notch_exact && truth_.notch) expected |= flag_notch;
    if (((expected ^ fragment.flags) & known) != 0) {
      char text[80];
      std::snprintf(text, sizeof text, "flags 0x%02x, expected 0x%02x", fragment.flags & known, expected & known);
      differs(text);
    }
    if (exact_ && (fragment.flags & flag_saturated) != 0 && !may_saturate)
      differs("flagged as saturated, but no attribute is");
  }

  void measure_snapping() {
    if (given_ == nullptr) return;
    const ReferenceSample& given = *given_;
    if (!given.covered || !given.visible) {
      if (first_pass_) ++part_.coverage_flips;
      return;
    }
    if (reference_->may_cancel()) return;
    double lambda_shift = 0, attribute_shift = 0;
    bool weights = false, attributes = false;
    for (std::size_t i = 0; i < 4; ++i)
      lambda_shift = std::max(lambda_shift, std::fabs(truth_.lambda[i] - given.lambda[i]));
    for (std::size_t slot = 0; slot < columns_.size(); ++slot) {
      (columns_[slot] < 4 ? weights : attributes) = true;
      if (columns_[slot] >= 4)
        attribute_shift = std::max(attribute_shift, std::fabs(truth_.attribute[slot] - given.attribute[slot]));
    }
    if (weights) part_.snapping.lambda.add(lambda_shift);
    if (attributes) part_.snapping.attribute.add(attribute_shift);
    if (first_pass_ && state_.depth) part_.snapping.depth.add(truth_.z - given.z);
  }

  void count(const Fragment& fragment) {
    for (const auto& [flag, counter] : counted_flags) part_.*counter += (fragment.flags & flag) != 0;
    part_.eye_crossing += reference_->eye_crossing;
    part_.tiny += reference_->tiny;
    const Vicinity::Near near = reference_->vicinity.at(fragment.x, fragment.y);
    part_.near_edge += near.edge;
    part_.near_vertex += near.vertex;
  }

  const FragmentChecker& checker_;
  const Config& config_;
  const DrawState& state_;
  const std::vector<int>& columns_;
  const bool first_pass_;
  const bool exact_;  ///< D and R² have all of their bits
  const DepthLimits limits_;
  CheckResult part_;

  // The quad that is being judged.
  const Reference* reference_ = nullptr;
  std::vector<golden::PixelPlace> pixels_;
  std::vector<ReferenceSample> truths_, givens_;

  // The fragment.
  Place place_;
  ReferenceSample truth_;
  const ReferenceSample* given_ = nullptr;  ///< the truth on the given quad; null when snapping is not measured
  int corner_ = -1;                         ///< the corner at the pixel, where that makes the machine exact
  bool cancelled_ = false;                  ///< a value about which nothing can be said
};

void FragmentChecker::compare(const std::vector<Fragment>& fragments) {
  FragmentJudge judge(*this);
  judge.judge(fragments);
  add(judge.result());
}

}  // namespace quadrille::tb
