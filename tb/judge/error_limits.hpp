// Regression limits: how large errors are with the arithmetic as it is, per stress family, significand width and
// output. The bound 2^-(s-3) leaves room for a fault of a bit or two; another seed stays within these limits, such a
// fault does not.
#pragma once

#include "golden/scenes/stress.hpp"
#include "model/port/config.hpp"
#include "model/untimed.hpp"
#include "tb/judge/check.hpp"
#include "tb/support/outputs.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::tb {

/// What the limits are about: so many quads of a family (fewer where each covers much) on a square viewport, at the
/// standard knob, in the default draw state and configuration, but for significand_bits.
std::size_t limit_quads(golden::StressFamily family);
inline constexpr int limit_extent = 64;

/// Draws that with the untimed model and compares it with the truth.
CheckResult judge_limit_draw(golden::StressFamily family, int significand_bits, std::uint64_t seed, PixelEngine engine);

/// The worst weight, in units of 2^-s, that short climbs out of a family find in the default configuration; −1: nothing
/// was drawn.
double limit_climb(golden::StressFamily family, int significand_bits, std::uint64_t seed);

/// Errors of one draw, as parts of what the bound allows each of them (RelativeErrors).
struct MeasuredErrors {
  std::array<double, output_names.size()> max{}, mean{};

  explicit MeasuredErrors(const CheckResult& result);
};

/// The interval of what was measured with several seeds, widened.
class LimitRange {
 public:
  LimitRange() = default;
  LimitRange(double low, double high) : low_(low), high_(high) {}
  /// `headroom` times the width of the interval of the values is added at either end.
  static LimitRange around(const std::vector<double>& values, double headroom);

  double low() const { return low_; }
  double high() const { return high_; }
  bool holds(double value) const { return value >= low_ && value <= high_; }

 private:
  double low_ = 0, high_ = 0;
};

class ErrorLimits {
 public:
  /// Of one family at one width. A largest error below `max` is no fault, a mean on either side of `mean` is.
  struct Family {
    std::array<LimitRange, output_names.size()> max, mean;
  };

  /// The file in the source tree as it was when the program was built (error_limits.json).
  static const ErrorLimits& recorded();
  /// Throws std::runtime_error for what is no such file.
  static ErrorLimits parse(std::string_view json);

  /// Limits around what was measured: one element of `draws` for each seed; `headroom` is for means, twice that for the
  /// largest errors, which scatter with a longer tail. Throws std::invalid_argument for fewer than two.
  void set(golden::StressFamily family, int significand_bits, const std::vector<MeasuredErrors>& draws,
           double headroom);
  /// `units`: the largest error that limit_climb() may find at this width, in units of 2^-s.
  void set_climb(int significand_bits, double units) { climb_[significand_bits] = units; }
  /// The file: a line for each family and width, sorted; for each output the largest error and the ends of the mean's
  /// interval.
  std::string text() const;

  /// Nothing for a family or width without limits.
  const Family* find(std::string_view family, int significand_bits) const;
  /// Infinity for a width without one.
  double climb(int significand_bits) const;

 private:
  std::map<std::string, std::map<int, Family>, std::less<>> families_;
  std::map<int, double> climb_;
};

/// Whether the limits are about such a draw of a family.
bool limits_apply(const Config& config, const DrawState& state, golden::StressFamily family, std::size_t quads);

/// What is beyond its limit, in words; empty when nothing is. Outputs that were not measured are left out.
std::vector<std::string> beyond_limits(const ErrorLimits::Family& limits, const CheckResult& result);

}  // namespace quadrille::tb
