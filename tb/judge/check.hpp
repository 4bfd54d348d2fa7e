// Fragments of the machine against the truth, as they come: coverage, singular classes, weights, attributes, depth.
#pragma once

#include "golden/analysis/judged_quad.hpp"
#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/judge/hidden_check.hpp"
#include "tb/judge/metric.hpp"
#include "tb/passes/pass.hpp"
#include "tb/support/error_stats.hpp"
#include "tb/support/work_queue.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace quadrille::tb {

/// Where the fragments are, for counting and naming.
struct Place {
  std::uint32_t index = 0, quad = 0;  ///< position in the draw, and id
  int x = 0, y = 0;
};

/// Errors of one kind by quantity.
struct QuantityErrors {
  ErrorStats lambda, attribute, depth;
  void merge(const QuantityErrors& other);
};

/// Errors as parts of what the bound allows each of them, for comparison with recorded ones (error_limits.hpp): quads
/// with large attributes, or near the eye plane, do not drown the others. `max` counts where the output's rounding
/// ends; `mean` is signed, positive away from the base, and includes it.
struct RelativeErrors {
  double max = 0;
  MeanError mean;

  void add(double part) { add(std::fabs(part), part); }
  void add(double part, double signed_part) {
    raise(part);
    mean.add(signed_part);
  }
  void raise(double part) {
    if (!(part <= max)) max = part;
  }
  void merge(const RelativeErrors& other) {
    if (!(other.max <= max)) max = other.max;
    mean.merge(other.mean);
  }
};

/// What was found; merging does not depend on the order. check_counters says what each counter is.
struct CheckResult {
  std::uint64_t compared = 0, mismatches = 0, beyond_bound = 0, beyond_attribute = 0, beyond_depth = 0,
                coverage_flips = 0, tolerated_visible = 0, tolerated_depth = 0, hidden = 0, discarded = 0,
                bound_exempt = 0, eye_crossing = 0, homogeneous = 0, on_edge = 0, on_vertex = 0, two_corner = 0,
                two_edge = 0, tie = 0, notch = 0, saturated = 0, near_edge = 0, near_vertex = 0, tiny = 0;

  RelativeErrors weight, attribute, depth;

  QuantityErrors arithmetic;  ///< the machine against the truth on snapped quads
  QuantityErrors snapping;    ///< the truth on snapped against the truth on given quads

  /// The fragment nearest to (or farthest beyond) the bound.
  struct Worst {
    double ratio = -1;  ///< error / bound
    double error = 0, bound = 0, condition = 1;
    int weight = 0;
    Place place;
  } worst;

  /// The first pixel that differs.
  struct Difference {
    bool any = false;
    Place place;
    std::string text;
  } first;

  void merge(const CheckResult& other);
  bool within_bound() const { return beyond_bound + beyond_attribute + beyond_depth == 0; }
  std::uint64_t faults() const { return mismatches + beyond_bound + beyond_attribute + beyond_depth; }
  bool ok() const;
};

struct CheckCounter : Metric {
  std::uint64_t CheckResult::*value;
};

/// Every counter of a check: faults, then what the fragments were and legitimate differences, then how much was seen.
inline constexpr CheckCounter check_counters[]{
    {{"reference_mismatches", MetricGroup::faults, "pixels",
      "drawn by the machine and not by the truth, or the reverse, or with other flags or facing", MetricLine::reference,
      ", {reference_mismatches} differ\n"},
     &CheckResult::mismatches},
    {{"beyond_bound", MetricGroup::faults, "fragments", "with a weight beyond its bound"}, &CheckResult::beyond_bound},
    {{"beyond_attribute", MetricGroup::faults, "fragments", "with an attribute beyond its bound, or saturated wrongly"},
     &CheckResult::beyond_attribute},
    {{"beyond_depth", MetricGroup::faults, "fragments", "with window z beyond its bound"}, &CheckResult::beyond_depth},

    {{"eye_crossing", MetricGroup::counts, "fragments", "of quads with vertices before and behind the eye",
      MetricLine::fragments, "\n  fragments of   eye-crossing quads {eye_crossing} ({eye_crossing_quads} quads), "},
     &CheckResult::eye_crossing},
    {{"homogeneous", MetricGroup::counts, "fragments", "of quads with some w other than 1"}, &CheckResult::homogeneous},
    {{"on_edge", MetricGroup::counts, "fragments", "on one edge", MetricLine::singular,
      "                 on an edge {on_edge}, "},
     &CheckResult::on_edge},
    {{"on_vertex", MetricGroup::counts, "fragments", "on one vertex", MetricLine::singular, "a vertex {on_vertex}, "},
     &CheckResult::on_vertex},
    {{"two_corner", MetricGroup::counts, "fragments", "on two corners", MetricLine::singular,
      "two corners {two_corner}, "},
     &CheckResult::two_corner},
    {{"two_edge", MetricGroup::counts, "fragments", "on two edges", MetricLine::singular, "two edges {two_edge}, "},
     &CheckResult::two_edge},
    {{"tie", MetricGroup::counts, "fragments", "decided by the tie rule", MetricLine::singular, "ties {tie}\n"},
     &CheckResult::tie},
    {{"near_edge", MetricGroup::counts, "fragments", "within 1/16 px of an edge", MetricLine::near,
      "                 within 1/16 px of an edge {near_edge}, "},
     &CheckResult::near_edge},
    {{"near_vertex", MetricGroup::counts, "fragments", "within 1 px of a vertex", MetricLine::near,
      "within 1 px of a vertex {near_vertex}\n"},
     &CheckResult::near_vertex},
    {{"tiny", MetricGroup::counts, "fragments", "of quads under 4 px", MetricLine::fragments,
      "under-4-px quads {tiny}\n"},
     &CheckResult::tiny},
    {{"notch", MetricGroup::counts, "fragments", "where an edge turns backward", MetricLine::verbose,
      "                 notches {notch}, "},
     &CheckResult::notch},
    {{"saturated", MetricGroup::counts, "fragments", "with an attribute clamped to its format", MetricLine::verbose,
      "saturated {saturated}, "},
     &CheckResult::saturated},
    {{"hidden", MetricGroup::counts, "pixels", "covered and rightly left out: the depth buffer refuses them"},
     &CheckResult::hidden},
    {{"discarded", MetricGroup::counts, "pixels", "covered and rightly discarded by window z", MetricLine::verbose,
      "discarded by z {discarded}, "},
     &CheckResult::discarded},
    {{"coverage_flips", MetricGroup::counts, "pixels", "drawn that the given, unsnapped quad does not cover",
      MetricLine::verbose, "moved by snapping {coverage_flips}\n"},
     &CheckResult::coverage_flips},
    {{"tolerated_visible", MetricGroup::counts, "pixels",
      "with the eye in the hull and a sum of M W within its bound of 0: drawn or not, either is right",
      MetricLine::tolerated_visible,
      "                 {tolerated_visible} with the eye in the hull and a sum of M W within its bound of 0\n"},
     &CheckResult::tolerated_visible},
    {{"tolerated_depth", MetricGroup::counts, "pixels",
      "with window z within its bound of a limit that cuts the quad: drawn or not, either is right",
      MetricLine::tolerated_depth,
      "                 tolerated, either being right: {tolerated_depth} within a depth's bound of a limit that cuts "
      "the quad,\n"},
     &CheckResult::tolerated_depth},

    {{"compared", MetricGroup::none, "fragments", "compared with the truth"}, &CheckResult::compared},
    {{"exempt_fragments", MetricGroup::none, "fragments",
      "with a value that no bound speaks of: sum(M W) cancels to what the weights' errors leave of it"},
     &CheckResult::bound_exempt}};
inline constexpr std::span fault_counters(check_counters, 4);

/// Facts about a snapped quad that the counters need.
bool is_eye_crossing(const SnappedQuad& quad);
/// Two neighbouring vertices V and -c V, c > 0: the eye lies on the edge, which then has no direction and covers
/// nothing.
bool has_antipodal_edge(const SnappedQuad& quad);
/// All vertices ordinary and less than 4 pixels wide and high.
bool is_tiny(const SnappedQuad& quad, const Config& config);

/// Threads of a queue for judging beside a lockstep of `threads`: with two, one is the RTL's and the other compares and
/// judges.
constexpr unsigned judging_threads(unsigned threads) { return threads > 2 ? threads - 2 : 0; }

/// Takes the fragments of one pass of the machine in order, quads in order, and compares them on the queue's threads.
/// A configuration that drops bits of D and R² has no bound and approximate singular classes: the rest is compared.
/// Where hidden tiles are left out each missing fragment is held against a depth buffer, twice: by what the machine
/// draws with nothing hidden, exactly, and by the truth, within the tolerance of a depth.
class FragmentChecker {
 public:
  struct Settings {
    Config config;
    DrawState state;  ///< of the pass
    Pass pass;
    bool first_pass = true;          ///< also check coverage and count
    bool snapping = true;            ///< also compare with the given quads
    bool exact = true;               ///< the machine has the model's bits: what it hides is held against these too
    HiddenDepths* depths = nullptr;  ///< of earlier draws in the same machine, which go on; must outlive the checker
  };

  /// `given` and `snapped` (numbered by position) must outlive the checker.
  FragmentChecker(const Settings& settings, std::span<const WindowQuad> given, std::span<const SnappedQuad> snapped,
                  WorkQueue& queue);

  void fragment(const Fragment& fragment);
  /// No more fragments. `complete`: every quad was drawn to its end, otherwise the last one was cut off.
  void finish(bool complete);
  /// After WorkQueue::drain().
  const CheckResult& result() const { return result_; }

 private:
  class Reference;
  class FragmentJudge;

  void flush_fragments();
  void quads_done(std::size_t end);
  void judge_hidden();
  void flush_coverage();
  void compare(const std::vector<Fragment>& fragments);
  void cover(std::size_t first, const std::vector<std::vector<std::uint32_t>>& pixels, int y0, int y1);
  void add(const CheckResult& part);

  Settings settings_;
  std::span<const WindowQuad> given_;
  std::span<const SnappedQuad> snapped_;
  WorkQueue& queue_;
  Bounds bounds_;

  std::unique_ptr<HiddenCheck> hidden_;  ///< where the draw leaves hidden tiles out
  std::vector<Fragment> batch_;
  std::size_t current_ = 0;        ///< quad whose fragments are coming
  std::size_t covered_first_ = 0;  ///< first quad of covered_
  std::vector<std::vector<std::uint32_t>>
      covered_;  ///< pixels (y << 16 | x) of the quads from covered_first_ to current_
  std::size_t covered_pixels_ = 0;

  std::mutex mutex_;
  CheckResult result_;
};

/// A pass judged in this thread: `draw` hands every fragment to the sink that it is given and says whether every quad
/// was drawn to its end. Fragments compared count in the first pass alone: those of further passes are the same ones.
CheckResult check_here(const FragmentChecker::Settings& settings, std::span<const WindowQuad> given,
                       std::span<const SnappedQuad> snapped,
                       const std::function<bool(const std::function<void(const Fragment&)>&)>& draw);

}  // namespace quadrille::tb
