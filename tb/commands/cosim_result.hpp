// What came of one input of `quadrille cosim`, or of several together.
#pragma once

#include "model/port/performance_counters.hpp"
#include "tb/judge/check.hpp"
#include "tb/judge/metric.hpp"
#include "tb/judge/skip_check.hpp"
#include "tb/lockstep/scoreboard.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// All that an input counts, but for what check_counters has.
inline constexpr Metric cosim_metrics[]{
    {"quads", MetricGroup::draw, "quads", "of the input"},
    {"quads_drawn", MetricGroup::draw, "quads", "drawn", MetricLine::lockstep,
     "  lockstep       {quads_drawn} quads, "},
    {"triangles", MetricGroup::draw, "triangles", "of the mesh"},
    {"fanned_faces", MetricGroup::draw, "faces", "with more than four corners", MetricLine::fanned,
     "                 {fanned_faces} faces with more than four corners cut "},
    {"fan_primitives", MetricGroup::draw, "primitives", "made of these faces", MetricLine::fanned,
     "into {fan_primitives} primitives\n"},
    {"skipped_lines", MetricGroup::draw, "lines", "of the mesh's file skipped"},
    {"passes", MetricGroup::draw, "passes", "for different attributes"},
    {"fragments", MetricGroup::draw, "fragments", "of the first pass", MetricLine::lockstep, "{fragments} fragments, "},
    {"mismatches", MetricGroup::draw, "beats", "in which RTL and model differ", MetricLine::mismatches,
     "                 {mismatches} bit mismatches, "},

    {"cycles_all_passes", MetricGroup::cycles, "clocks", "of the RTL, all passes"},
    {"fragments_all_passes", MetricGroup::cycles, "fragments", "all passes"},
    {"cycles_rtl", MetricGroup::cycles, "clocks", "of the RTL, first pass", MetricLine::lockstep,
     "{cycles_rtl} cycles"},
    {"cycles_model", MetricGroup::cycles, "clocks", "of the model, first pass"},
    {"cycle_mismatches", MetricGroup::cycles, "clocks", "in which a valid, ready, mask or busy differs",
     MetricLine::mismatches, "{cycle_mismatches} cycle mismatches; "},
    {"compared_bits", MetricGroup::cycles, "bits", "of RTL and model compared", MetricLine::mismatches,
     "{compared_bits} bits compared\n"},
    {"covered_pixels", MetricGroup::cycles, "pixels", "first pass"},
    {"draws", MetricGroup::cycles, "draws", "with --draws", MetricLine::draws,
     "  draws          {draws} of one machine, each with its draw state; "},
    {"clears", MetricGroup::cycles, "clears", "of what is hidden, between draws", MetricLine::draws,
     "{clears} clears, "},
    {"resets", MetricGroup::cycles, "resets", "between draws", MetricLine::draws, "{resets} resets\n"},

    {"eye_crossing_quads", MetricGroup::counts, "quads", "with vertices before and behind the eye"},
    {"homogeneous_quads", MetricGroup::counts, "quads", "with some w other than 1"},
    {"antipodal_quads", MetricGroup::counts, "quads", "with the eye on an edge"},
    {"tiny_quads", MetricGroup::counts, "quads", "under 4 px"},
    {"at_depth_limit", MetricGroup::counts, "fragments", "with depth znear or zfar, where these are not 0 and 1"},
    {"left_out", MetricGroup::counts, "quads", "left out", MetricLine::left_out,
     "                 {left_out} quads left out: "},
    {"left_out_empty", MetricGroup::counts, "quads", "without a pixel centre", MetricLine::left_out,
     "{left_out_empty} without a pixel centre, "},
    {"left_out_behind", MetricGroup::counts, "quads", "behind the eye", MetricLine::left_out,
     "{left_out_behind} behind the eye, "},
    {"left_out_depth", MetricGroup::counts, "quads", "outside znear and zfar", MetricLine::left_out,
     "{left_out_depth} outside znear and zfar, "},
    {"left_out_line", MetricGroup::counts, "quads", "on a line", MetricLine::left_out, "{left_out_line} on a line, "},
    {"left_out_culled", MetricGroup::counts, "quads", "culled", MetricLine::left_out, "{left_out_culled} culled, "},
    {"left_out_outside", MetricGroup::counts, "quads", "homogeneous, outside the scissor", MetricLine::left_out,
     "{left_out_outside} outside the scissor\n"},

    {"alone_cycles", MetricGroup::none, "clocks", "of the RTL alone, timed"},
    {"limits_checked", MetricGroup::none, "inputs", "that have regression limits"}};

/// Its place in cosim_metrics; another key does not compile.
struct MetricKey {
  std::size_t index = 0;
  consteval MetricKey(const char* key) {
    while (std::string_view(cosim_metrics[index].key) != key) ++index;
  }
};

struct InputResult {
  std::string name, option;
  std::string state;       ///< the options that give the draw state
  std::string attributes;  ///< the option that gives the attributes in use per pass, where they are not all slots
  std::array<std::uint64_t, std::size(cosim_metrics)> counted{};
  PerformanceCounters counters;
  double alone_seconds = 0, seconds = 0, loop_seconds = 0;
  bool complete = true;
  std::optional<std::string> first_divergence;
  std::optional<DivergentPixel> first_pixel;  ///< that it is about, or the first difference from the truth
  std::uint64_t fragment_hash = 0;
  CheckResult check;
  SkipResult skips;                        ///< draws with and without the skips
  std::vector<std::string> beyond_limits;  ///< what is beyond regression limits, in words

  std::uint64_t& operator[](MetricKey key) { return counted[key.index]; }
  std::uint64_t operator[](MetricKey key) const { return counted[key.index]; }
  void add_hash(std::uint64_t hash) { fragment_hash = fragment_hash * 0x100000001b3u ^ hash; }

  bool lockstep_ok() const { return (*this)["mismatches"] + (*this)["cycle_mismatches"] == 0; }
  bool ok() const { return lockstep_ok() && check.ok() && skips.differences == 0 && beyond_limits.empty(); }
  void merge(const InputResult& part);
  /// Calls f(metric, number) for all of them, in the order of the report.
  template <class F>
  void for_each_metric(F&& f) const {
    for (std::size_t i = 0; i < counted.size(); ++i) f(cosim_metrics[i], counted[i]);
    for (const CheckCounter& counter : check_counters) f(counter, check.*counter.value);
  }
};

}  // namespace quadrille::tb
