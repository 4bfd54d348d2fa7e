// The points of a sweep: axes given as text, and the configurations that they span.
#pragma once

#include "model/port/config.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::sweep {

/// One axis: a configuration key and its values, in the order given, without repetition.
struct Axis {
  std::string key;
  std::vector<int> values;  ///< −1: auto, where the key allows it
};

/// "KEY=A:B[:STEP]" (both ends included if the step hits them; STEP may be negative), "KEY=A,B,C", "KEY=auto", or these
/// mixed: "KEY=10:20:2,26"; notch_exact also takes true and false.
/// Throws ConfigError: unknown key (nearest named), empty range, not a whole number, a value outside the key's range, a
/// value twice, step 0.
Axis parse_axis(const std::string& text);

/// The configuration with every "auto" replaced by its value: two that build the same machine are equal.
Config resolved(const Config& config);

struct GridPoint {
  Config config;
  std::string refused;  ///< not empty: Config::validate() refuses it, with this message
};

class Grid {
 public:
  enum class Kind { full, one_at_a_time };

  /// Full: every combination, the last axis fastest. One at a time: the base, then for each axis its values with the
  /// rest as in the base; values that build the machine of the base, or of an earlier value of the axis, are left out.
  /// Throws ConfigError for no axis, an axis given twice or without values, an unknown key, a value outside its range.
  Grid(const Config& base, std::vector<Axis> axes, Kind kind);

  /// May be huge: known before any point is made. Saturates at 2^64 − 1.
  std::uint64_t size() const;
  /// Throws std::out_of_range for row >= size().
  GridPoint point(std::uint64_t row) const;
  const std::vector<Axis>& axes() const { return axes_; }
  Kind kind() const { return kind_; }
  const Config& base() const { return base_; }

 private:
  Config base_;
  std::vector<Axis> axes_;
  Kind kind_;
  std::uint64_t size_ = 0;
  std::vector<Config> singles_;  ///< one at a time: the points
};

/// Axes of `quadrille sweep` without --axis: one at a time around the base, in the order of Config::keys(). Around the
/// default configuration every point can be built.
std::vector<Axis> default_axes();
/// The grid of 1,000 points on which the search is compared with full evaluation: what decides error and cost. Around
/// the default configuration every point can be built.
std::vector<Axis> thousand_point_axes();

}  // namespace quadrille::sweep
