// Which points of a sweep matter: the Pareto front of cost against error, its knees, the corners of the grid.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace quadrille::sweep {

struct CostError {
  double cost = 0, error = 0;  ///< smaller is better; NaN: the point does not take part
};

/// Positions of the points that no other beats (not worse in both and better in one), by rising cost. Of equal points
/// the first counts.
std::vector<std::size_t> pareto_front(std::span<const CostError> points);

/// The `count` points of a front (as pareto_front() gives it) where the curve of log error over log cost bends most, by
/// distance from the chord of the hull, in the order of the front; never its ends.
std::vector<std::size_t> knees(std::span<const CostError> points, std::span<const std::size_t> front,
                               std::size_t count);

/// Spearman's rank correlation with average ranks for ties; NaN for fewer than two points or a constant list.
double rank_correlation(std::span<const double> a, std::span<const double> b);

}  // namespace quadrille::sweep
