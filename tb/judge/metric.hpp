// A number that `quadrille cosim` counts: all that is said of it stands in one entry.
#pragma once

#include <string_view>

namespace quadrille::tb {

/// Where it is in the JSON report, in this order; `counts` is an object. none: not by itself.
enum class MetricGroup { draw, faults, cycles, counts, none };

/// The line of the summary that shows it.
enum class MetricLine {
  none,
  draws,
  lockstep,
  left_out,
  fanned,
  mismatches,
  reference,
  tolerated_depth,
  tolerated_visible,
  fragments,
  near,
  singular,
  verbose
};

struct Metric {
  const char* key;
  MetricGroup group;
  std::string_view unit, meaning;
  MetricLine line = MetricLine::none;
  std::string_view shown = {};  ///< its part of the line; {key} is the number of a metric
};

}  // namespace quadrille::tb
