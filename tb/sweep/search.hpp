// The cheapest configuration of a grid that meets an error target, without evaluating the whole grid.
//
// Costs are known beforehand, errors are not. Widths act in one direction: with more bits the error does not grow, up
// to the noise of a sampled maximum. So a point that misses the target clearly (by more than the factor `slack`) rules
// out every point that is nowhere better, and one that meets it rules out everything that costs more. The search
// evaluates the point that rules out most in the worse of these two outcomes, and ends when nothing is left that is
// cheaper than the best point that met. A point that misses within `slack` rules out itself alone: machines that differ
// in the format of an output have other bases and so other differences from the port on. Points that differ only in
// keys without any effect on errors have equal errors, so the cheapest of them stands for all; so do, on ordinary input
// (every W = 1), the values of quadratic_frac_bits from 2 subpixel_bits on, for products of two coordinates have no
// more fraction bits.
//
// The winner is that of full evaluation if no point's error exceeds `slack` times the error of a point that is nowhere
// better, and keys of output formats move no fragment across an end of the z interval.
#pragma once

#include "model/port/config.hpp"
#include "tb/sweep/point_result.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::sweep {

/// Whether `a` is not better than `b` in any key that acts on errors: errors of `a` are at least those of `b`, up to
/// noise. Compares resolved values.
bool nowhere_better(const Config& a, const Config& b);

struct SearchPoint {
  Config config;          ///< passes Config::validate()
  double cost = 0;        ///< not NaN
  bool ordinary = false;  ///< all that `miss` is measured on has snapped vertices with W = 1 alone
};

struct SearchResult {
  std::optional<std::size_t> winner;  ///< position of the cheapest point that meets the target; of equal cost the first
  std::size_t evaluations = 0;
  std::vector<std::size_t> evaluated;  ///< in order
  double closest = 0;                  ///< smallest error / target seen; infinity: none was finite
  std::size_t closest_point = 0;       ///< where, the first of equal ones; 0 if none was finite
};

/// `miss(i)` evaluates point i and returns error / target (<= 1: met; NaN or infinity: missed clearly). slack >= 1.
/// `idle_keys`: further keys that cannot change `miss`, such as depth_bits where no target is a depth.
SearchResult cheapest_meeting(std::span<const SearchPoint> points, const std::function<double(std::size_t)>& miss,
                              double slack, std::span<const std::string_view> idle_keys = {});

/// The factor `slack` for sampled errors of quads. Full evaluation of the grid of 1,000 points on six inputs shows
/// steps against the order of up to 1.51; with 1.35 some of 6,930 searches miss the winner, with 1.4 and more none.
inline constexpr double sampled_slack = 1.5;

/// Keys that cannot change errors of these quantities.
std::vector<std::string_view> idle_keys(std::span<const Output> measured);

}  // namespace quadrille::sweep
