#include "tb/judge/check.hpp"

#include "model/skips/hierarchical_z.hpp"
#include "tb/judge/judged_quad.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <tuple>

namespace quadrille::tb {
namespace {

using golden::Coverage;
using golden::ReferenceSample;
using golden::TruthQuad;

// Sizes of jobs. Without threads of their own they stand in the lockstep's way: while one is done the device must not
// run out of room to go on (DeviceAhead keeps 768 clocks).
constexpr std::size_t fragments_per_job = 512;
constexpr std::size_t quads_per_job = 256;
constexpr std::size_t pixels_per_job = 4096;

constexpr double near_edge_distance = 1.0 / 16;  // pixels
constexpr double near_vertex_distance = 1;

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

auto order(const Place& p) { return std::tuple(p.index, p.y, p.x); }

std::string text_of(const Place& place, const std::string& what) {
  char head[96];
  std::snprintf(head, sizeof head, "quad %u, pixel (%d, %d): ", place.quad, place.x, place.y);
  return head + what;
}

/// Distances of pixel centres to edges and corners of a quad, in double: for counting only.
class Vicinity {
 public:
  explicit Vicinity(const SnappedQuad& quad) {
    for (std::size_t i = 0; i < 4; ++i) {
      x_[i] = quad.vertex[i].x;
      y_[i] = quad.vertex[i].y;
      w_[i] = quad.vertex[i].w;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      slope_[i] = std::hypot(y_[i] * w_[j] - w_[i] * y_[j], w_[i] * x_[j] - x_[i] * w_[j]);
    }
  }

  struct Near {
    bool edge = false, vertex = false;
  };
  Near at(int px, int py) const {
    Near near;
    std::array<double, 4> x, y;
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = x_[i] - w_[i] * px;
      y[i] = y_[i] - w_[i] * py;
      // Squares of integers: what is as near as the limit stays exact.
      const double square = x[i] * x[i] + y[i] * y[i], limit = w_[i] * w_[i];
      near.vertex = near.vertex || (w_[i] != 0 && square <= limit * (near_vertex_distance * near_vertex_distance));
      near.edge = near.edge || (w_[i] != 0 && square <= limit * (near_edge_distance * near_edge_distance));
    }
    for (std::size_t i = 0; i < 4 && !near.edge; ++i) {
      const std::size_t j = (i + 1) % 4;
      if (x[i] * x[j] + y[i] * y[j] > 0) continue;  // beside the edge, not on its line beyond the ends
      near.edge = std::fabs(x[i] * y[j] - y[i] * x[j]) <= slope_[i] * near_edge_distance;
    }
    return near;
  }

 private:
  std::array<double, 4> x_{}, y_{}, w_{}, slope_{};
};

}  // namespace

void QuantityErrors::merge(const QuantityErrors& other) {
  lambda.merge(other.lambda);
  attribute.merge(other.attribute);
  depth.merge(other.depth);
}

bool CheckResult::ok() const { return compared > 0 && faults() == 0; }

void CheckResult::merge(const CheckResult& other) {
  for (const CheckCounter& counter : check_counters) this->*counter.value += other.*counter.value;
  weight.merge(other.weight);
  attribute.merge(other.attribute);
  depth.merge(other.depth);
  arithmetic.merge(other.arithmetic);
  snapping.merge(other.snapping);
  if (other.worst.ratio > worst.ratio ||
      (other.worst.ratio == worst.ratio && order(other.worst.place) < order(worst.place)))
    worst = other.worst;
  if (other.first.any && (!first.any || order(other.first.place) < order(first.place))) first = other.first;
}

bool is_eye_crossing(const SnappedQuad& quad) {
  const auto in_front = [](const SnappedVertex& v) { return v.w > 0; };
  return std::any_of(quad.vertex.begin(), quad.vertex.end(), in_front) &&
         !std::all_of(quad.vertex.begin(), quad.vertex.end(), in_front);
}

bool has_antipodal_edge(const SnappedQuad& quad) {
  const auto antipodal = [](const SnappedVertex& a, const SnappedVertex& b) {
    using Wide = std::int64_t;
    const bool parallel =
        Wide{a.y} * b.w == Wide{a.w} * b.y && Wide{a.w} * b.x == Wide{a.x} * b.w && Wide{a.x} * b.y == Wide{a.y} * b.x;
    // Parallel vectors: the sign of any product of two components is the sign of the scale.
    const __int128 dot =
        static_cast<__int128>(a.x) * b.x + static_cast<__int128>(a.y) * b.y + static_cast<__int128>(a.w) * b.w;
    return parallel && dot < 0;
  };
  for (std::size_t i = 0; i < 4; ++i)
    if (antipodal(quad.vertex[i], quad.vertex[(i + 1) % 4])) return true;
  return false;
}

bool is_tiny(const SnappedQuad& quad, const Config& config) {
  const std::int32_t one = 1 << config.frac();
  const auto [left, right] = std::minmax_element(quad.vertex.begin(), quad.vertex.end(),
                                                 [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [top, bottom] = std::minmax_element(quad.vertex.begin(), quad.vertex.end(),
                                                 [](const auto& a, const auto& b) { return a.y < b.y; });
  return std::all_of(quad.vertex.begin(), quad.vertex.end(), [&](const SnappedVertex& v) { return v.w == one; }) &&
         std::int64_t{right->x} - left->x < std::int64_t{4} * one &&
         std::int64_t{bottom->y} - top->y < std::int64_t{4} * one;
}

/// One quad as it is judged, with what the counters need.
class FragmentChecker::Reference : public JudgedQuad {
 public:
  Reference(const FragmentChecker& checker, std::size_t index)
      : JudgedQuad(checker.snapped_[index], checker.settings_.config, checker.bounds_, truth_state(checker)),
        eye_crossing(is_eye_crossing(quad())),
        tiny(is_tiny(quad(), checker.settings_.config)),
        vicinity(quad()) {
    if (checker.settings_.snapping)
      given.emplace(pass_quad(checker.given_[index], checker.settings_.pass), truth_state(checker));
  }

  std::optional<TruthQuad> given;
  bool eye_crossing, tiny;
  Vicinity vicinity;

 private:
  /// The weights come with every sample; only true attributes are asked for.
  static DrawState truth_state(const FragmentChecker& checker) {
    DrawState state = checker.settings_.state;
    const std::vector<int>& columns = checker.settings_.pass.columns;
    if (std::all_of(columns.begin(), columns.end(), [](int column) { return column < 4; })) state.attributes = 0;
    return state;
  }
};

FragmentChecker::FragmentChecker(const Settings& settings, std::span<const WindowQuad> given,
                                 std::span<const SnappedQuad> snapped, WorkQueue& queue)
    : settings_(settings), given_(given), snapped_(snapped), queue_(queue), bounds_(settings.config) {
  covered_.emplace_back();
  if (settings.first_pass && skips_hidden(settings.config, settings.state))
    hidden_ = std::make_unique<HiddenCheck>(settings.config, settings.state, settings.depths);
}

void FragmentChecker::add(const CheckResult& part) {
  std::lock_guard lock(mutex_);
  result_.merge(part);
}

void FragmentChecker::fragment(const Fragment& fragment) {
  if (settings_.first_pass) {
    if (fragment.quad < current_ || fragment.quad >= snapped_.size()) {
      CheckResult part;
      part.mismatches = 1;
      part.first = {true, {fragment.quad, fragment.quad, fragment.x, fragment.y}, ""};
      part.first.text = text_of(part.first.place, "a fragment of a quad that is not being drawn");
      add(part);
      return;
    }
    if (fragment.quad != current_) quads_done(fragment.quad);
    covered_.back().push_back(static_cast<std::uint32_t>(fragment.y) << 16 | fragment.x);
    ++covered_pixels_;
    if (hidden_) hidden_->fragment(fragment);
  }
  batch_.push_back(fragment);
  if (batch_.size() >= fragments_per_job) flush_fragments();
}

void FragmentChecker::flush_fragments() {
  if (batch_.empty()) return;
  queue_.push([this, fragments = std::move(batch_)] { compare(fragments); });
  batch_ = {};
}

/// The quads before `end` are complete.
void FragmentChecker::quads_done(std::size_t end) {
  while (current_ < end) {
    if (hidden_) judge_hidden();
    ++current_;
    if (hidden_ || current_ - covered_first_ >= quads_per_job || covered_pixels_ >= pixels_per_job) flush_coverage();
    covered_.emplace_back();
  }
}

/// The quad current_ is complete: what of it is missing, against the depth buffer of the quads before.
void FragmentChecker::judge_hidden() {
  const auto fault = hidden_->quad_done(snapped_[current_]);
  if (!fault) return;
  CheckResult part;
  part.mismatches = 1;
  part.first = {true, {static_cast<std::uint32_t>(current_), given_[current_].id, fault->x, fault->y}, ""};
  part.first.text = text_of(part.first.place, fault->text);
  add(part);
}

/// Hands the complete quads covered_first_ … current_-1 over.
void FragmentChecker::flush_coverage() {
  if (current_ == covered_first_) return;
  const auto pixels = std::make_shared<const std::vector<std::vector<std::uint32_t>>>(std::move(covered_));
  if (hidden_) {  // in this thread: the depth buffer goes on with the next quad
    cover(covered_first_, *pixels, 0, settings_.state.height);
    covered_.clear();
    covered_first_ = current_;
    covered_pixels_ = 0;
    return;
  }
  // One quad over much of the viewport is worth several jobs.
  const int height = settings_.state.height;
  const int rows = current_ - covered_first_ == 1 ? std::max(1, settings_.state.height / 8) : height;
  for (int y = 0; y < height; y += rows)
    queue_.push(
        [this, first = covered_first_, pixels, y, end = std::min(height, y + rows)] { cover(first, *pixels, y, end); });
  covered_.clear();
  covered_first_ = current_;
  covered_pixels_ = 0;
}

void FragmentChecker::finish(bool complete) {
  flush_fragments();
  if (!settings_.first_pass) return;
  if (complete) {
    quads_done(snapped_.size());
    covered_.pop_back();
  } else if (!covered_.empty()) {
    covered_.pop_back();  // the last quad was cut off
  }
  flush_coverage();
}

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

/// Every pixel of rows y0 … y1-1 that the truth covers must have been drawn, once.
void FragmentChecker::cover(std::size_t first, const std::vector<std::vector<std::uint32_t>>& pixels, int y0, int y1) {
  CheckResult part;
  const DrawState& state = settings_.state;
  const DepthLimits limits(settings_.config, state);
  std::vector<std::uint32_t> drawn;
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    const std::size_t index = first + n;
    const auto differs = [&](int x, int y, const char* what) {
      const Place place{static_cast<std::uint32_t>(index), given_[index].id, x, y};
      ++part.mismatches;
      if (!part.first.any || order(place) < order(part.first.place)) part.first = {true, place, text_of(place, what)};
    };
    drawn.clear();
    for (const std::uint32_t pixel : pixels[n])
      if (const int y = static_cast<int>(pixel >> 16); y >= y0 && y < y1) drawn.push_back(pixel);
    std::sort(drawn.begin(), drawn.end());
    for (std::size_t i = 1; i < drawn.size(); ++i)
      if (drawn[i] == drawn[i - 1])
        differs(static_cast<int>(drawn[i] & 0xffff), static_cast<int>(drawn[i] >> 16), "drawn twice");

    const Reference reference(*this, index);
    const golden::PixelRect bounds = reference.truth().bounds();  // what is drawn beyond, compare() finds
    std::size_t next = 0;
    for (int y = std::max(y0, bounds.y0); y < std::min(y1, bounds.y1); ++y) {
      const golden::PixelSpan row = reference.truth().rows().row(y);
      for (int x = row.x0; x < row.x1; ++x) {
        const std::uint32_t pixel = static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
        while (next < drawn.size() && drawn[next] < pixel) ++next;
        if (next < drawn.size() && drawn[next] == pixel) continue;  // compare() judges what was drawn
        const Coverage coverage = reference.truth().cover(x, y);
        if (!coverage.covered || !coverage.visible || state.cull == (coverage.front ? Cull::front : Cull::back))
          continue;
        const ReferenceSample truth = reference.truth().sample(x, y);
        if (reference.tolerates_visibility(truth)) {
          ++part.tolerated_visible;
          continue;
        }
        // A quad whose depths are all within the limits loses no pixel to them.
        if (const QuadBase& base = reference.quad().base; state.depth && !limits.hold_all_of(base)) {
          // As far as the truth can tell it was discarded rightly, unless the machine is exact at this pixel.
          std::optional<std::int64_t> code;
          if ((truth.flags & flag_on_vertex) != 0 && settings_.config.qdrop() == 0)
            code = reference.exact_depth(reference.corner_at(x, y));
          if (limits.hold_none_of(base) || (code ? !limits.holds(*code) : limits.side(truth.z, 0) < 0)) {
            ++part.discarded;
            continue;
          }
          if (!code && limits.side(truth.z, reference.depth_tolerance(x, y)) == 0) {
            ++part.tolerated_depth;
            continue;
          }
        }
        if (hidden_) {
          if (hidden_->may_refuse(x, y, truth.z, reference.depth_tolerance(x, y))) {
            ++part.hidden;
            continue;
          }
          differs(x, y, "not drawn, but in front of the depth buffer in the truth");
          continue;
        }
        differs(x, y, "not drawn, but covered in the truth");
      }
    }
  }
  add(part);
}

CheckResult check_here(const FragmentChecker::Settings& settings, std::span<const WindowQuad> given,
                       std::span<const SnappedQuad> snapped,
                       const std::function<bool(const std::function<void(const Fragment&)>&)>& draw) {
  WorkQueue queue(0, 1);
  FragmentChecker checker(settings, given, snapped, queue);
  checker.finish(draw([&](const Fragment& fragment) { checker.fragment(fragment); }));
  queue.drain();
  CheckResult result = checker.result();
  if (!settings.first_pass) result.compared = 0;
  return result;
}

}  // namespace quadrille::tb
