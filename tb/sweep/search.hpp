// The cheapest configuration of a grid that meets an error target, without evaluating the whole grid.
//
// Costs are known beforehand, errors are not. Widths act in one direction: with more bits the error does not grow, up to
// the noise of a sampled maximum. So a point that misses the target clearly (by more than the factor `slack`) rules out
// every point that is nowhere better, and one that meets it rules out everything that costs more. The search evaluates
// the point that rules out most in the worse of its two outcomes, and ends when only the winner is left.
#pragma once

#include "model/config.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::sweep {

/// +1: a larger (resolved) value never makes errors larger, up to noise; −1: the reverse; 0: no order is known, points
/// with different values do not rule each other out.
int error_direction(std::string_view key);

struct SearchPoint {
  Config config;
  double cost = 0;
};

struct SearchResult {
  std::optional<std::size_t> winner;   ///< position of the cheapest point that meets the target; of equal cost the first
  std::size_t evaluations = 0;
  std::vector<std::size_t> evaluated;  ///< in order
  double closest = 0;                  ///< smallest error / target seen
  std::size_t closest_point = 0;
};

/// `miss(i)` evaluates point i and returns error / target (<= 1: met; NaN or infinity: missed). slack >= 1.
SearchResult cheapest_meeting(std::span<const SearchPoint> points, const std::function<double(std::size_t)>& miss,
                              double slack);

}  // namespace quadrille::sweep
