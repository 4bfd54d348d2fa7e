// Which points of a sweep matter: the Pareto front of cost against error, its knees; and how far two measures agree.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace quadrille::sweep {

struct CostError {
  double cost = 0, error = 0;  ///< smaller is better; NaN: the point does not take part
};

/// Positions of the points that no other beats (not worse in both and better in one), by rising cost. Of equal points
/// the first counts.
std::vector<std::size_t> pareto_front(std::span<const CostError> points);

struct Knees {
  std::vector<std::size_t> points;  ///< in the order of the front
  std::string none;                 ///< why there is none, as a clause; empty where there is one or none was asked for
};

/// The `count` points of a front (as pareto_front() gives it) where the curve of log error over log cost bends most;
/// never its ends. They are vertices of the curve's lower convex hull, both axes scaled to [0, 1]: first the one
/// farthest from the chord between the ends, then always the one farthest from the line through those chosen. Fewer
/// where the hull has fewer. Points without finite logarithms (an error of 0) are no part of the curve. A curve that
/// falls by less than one bit from end to end is flat and has none: scaled to [0, 1] it would show bends of nothing.
Knees knees(std::span<const CostError> points, std::span<const std::size_t> front, std::size_t count);

/// Spearman's rank correlation of two lists of equal length, with average ranks for ties. Pairs with a NaN are left
/// out. NaN for fewer than two pairs or a constant list; throws std::invalid_argument for different lengths.
double rank_correlation(std::span<const double> a, std::span<const double> b);

}  // namespace quadrille::sweep
