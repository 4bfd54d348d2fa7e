// Error against run time: the paper's formulas in single and double precision, the truth, and every form of the machine
// on the same snapped quads.
#pragma once

#include "model/port/config.hpp"
#include "model/port/performance_counters.hpp"
#include "model/port/records.hpp"
#include "model/untimed.hpp"
#include "tb/engines/engine.hpp"
#include "tb/support/error_stats.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// The bodies of `bench --error`, in the order of its report.
inline constexpr std::array error_engines{EngineKind::paper_single, EngineKind::paper_float, EngineKind::truth,
                                          EngineKind::model_plain,  EngineKind::model,       EngineKind::model_clocked,
                                          EngineKind::rtl};

/// One body on one input.
struct BodyResult {
  /// Looked at, undefined and missing ones included. Of a machine also those that the truth neither draws nor refuses:
  /// |sum(M w)| near 0, or z near the ends of its interval; the references are not asked there.
  std::uint64_t fragments = 0;
  std::uint64_t undefined = 0;  ///< a division by zero or a result that is not finite; in no statistic
  /// In no statistic. Of a machine: pixels that it draws and the truth does not, the reverse (as `cosim` judges), and
  /// those with another facing or other flags. Of the paper's formulas: pixels that model and truth draw and they do
  /// not.
  std::uint64_t missing = 0;
  /// Absolute errors against the truth on the same snapped quads: per fragment the largest of the four weights and of
  /// the attributes, and window z. As in `cosim`, weights and attributes leave out what the bound does not speak of
  /// (perspective off and a vertex behind the eye). With fewer than four attribute slots the machine's weights come in
  /// several draws, each of which counts.
  ErrorStats lambda, attribute, depth;
  double seconds_per_fragment = 0;
  PerformanceCounters counters;  ///< of the clocked model, over the quads that are timed
  LanePixels lanes;              ///< of the model in lanes, over the same
};

/// The fragments of one draw of a machine, in its order.
using DrawBody =
    std::function<std::vector<Fragment>(EngineKind, std::span<const SnappedQuad>, const Config&, const DrawState&)>;
std::vector<Fragment> draw_body(EngineKind body, std::span<const SnappedQuad> quads, const Config& config,
                                const DrawState& state);

/// Where two draws differ first, for a person; empty when they are equal.
std::string first_difference(std::span<const Fragment> expected, std::span<const Fragment> actual);

/// All bodies on one input.
class ErrorBench {
 public:
  struct Settings {
    Config config;
    DrawState state;  ///< its `attributes` is ignored
    std::uint64_t limit_fragments = 16'000;
    bool rtl = true;
    DrawBody draw = draw_body;  ///< a test puts faults here
  };
  static constexpr std::size_t least_quads = 16;

  /// The quads are drawn in order until there are limit_fragments fragments and least_quads quads; none is cut off.
  /// Throws SnapError, and UsageError when there are more quads than ids.
  ErrorBench(const Settings& settings, std::span<const WindowQuad> quads, int attributes);

  /// Fills everything but the times. The same for every call and on every machine with the same C library.
  void compare();

  /// Fills the times and the counters: median of `repeat` runs, the bodies one after the other in each round. On one
  /// core; quads until limit_fragments are drawn, of the truth about 2000 fragments, spread over them. Seconds per
  /// fragment (of CPU time, of the RTL and the clocked model of wall time) of set-up, weights, attributes (as many as
  /// the first weight pass has slots) and depth; the machine's bodies also walk and find the covered pixels, the
  /// truth's coverage is a part of its sample, the paper's formulas are asked for covered pixels only.
  void time(int repeat);

  std::size_t quads() const { return quads_.size(); }
  const BodyResult& result(EngineKind body) const { return results_[body]; }
  bool has(EngineKind body) const { return body != EngineKind::rtl || settings_.rtl; }
  /// What must not be: a bound exceeded, machines that differ, no fragments. Empty when all is well.
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  struct Pixel {
    std::uint32_t quad;
    std::uint16_t x, y;
  };
  struct Run {
    std::uint64_t fragments = 0;
    double seconds = 0;
    PerformanceCounters counters{};  ///< of the clocked model
    LanePixels lanes{};              ///< of the untimed one
  };

  DrawState pass_state(const Pass& pass) const;
  std::vector<SnappedQuad> snap(const Pass& pass) const;
  void choose_quads(std::span<const WindowQuad> quads);
  void compare_machine();
  void compare_paper();
  Run run_once(EngineKind body) const;
  Run run_machine(EngineKind body) const;
  template <class Quad, class Visit>
  Run run_reference(std::size_t stride, Visit&& visit) const;

  Settings settings_;
  int attributes_;
  std::vector<WindowQuad> quads_;
  Pass first_pass_;
  std::vector<SnappedQuad> timed_;  ///< for the first pass
  std::vector<Pixel> pixels_;       ///< of all quads, in the order of the model
  std::size_t timed_pixels_ = 0;    ///< of them, those of timed_
  PerEngine<BodyResult> results_{};
  std::vector<std::string> failures_;
};

}  // namespace quadrille::tb
