#include "tb/sweep/pareto.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <tuple>

namespace quadrille::sweep {
namespace {

struct Place {
  double x, y;
  std::size_t point;
};

/// Twice the area of the triangle a b c, positive when it turns left; c's distance from the line ab times its length.
double cross(const Place& a, const Place& b, const Place& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Lower convex hull of places with rising x (Andrew's monotone chain).
std::vector<Place> lower_hull(const std::vector<Place>& places) {
  constexpr double straight = 1e-12;  // what rounding makes of points on one line of the unit square
  std::vector<Place> hull;
  for (const Place& p : places) {
    while (hull.size() >= 2 && cross(hull[hull.size() - 2], hull.back(), p) <= straight) hull.pop_back();
    hull.push_back(p);
  }
  return hull;
}

/// Scales [lo, hi] to [0, 1]; an interval without length to 0.
double to_unit(double value, double lo, double hi) { return hi > lo ? (value - lo) / (hi - lo) : 0; }

/// Ranks from 1, equal values sharing the average of theirs.
std::vector<double> average_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> rank(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) rank[order[i]] = static_cast<double>(first + 1 + end) / 2;
    first = end;
  }
  return rank;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const CostError> points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isnan(points[i].cost) && !std::isnan(points[i].error)) order.push_back(i);
  }
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::tuple(points[i].cost, points[i].error, i); });
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
  }
  return front;
}

Knees knees(std::span<const CostError> points, std::span<const std::size_t> front, std::size_t count) {
  std::vector<Place> curve;
  for (const std::size_t i : front) {
    const Place p{std::log(points[i].cost), std::log(points[i].error), i};
    if (std::isfinite(p.x) && std::isfinite(p.y)) curve.push_back(p);
  }
  if (count == 0) return {};
  if (curve.size() < 3) return {{}, "the front has fewer than three points with an error above 0"};
  const Place first = curve.front(), last = curve.back();  // x rises, y falls
  if (first.y - last.y < std::numbers::ln2)
    return {{}, "the front is flat: from its cheapest to its dearest point the error falls by less than one bit"};
  for (Place& p : curve) {
    p.x = to_unit(p.x, first.x, last.x);
    p.y = to_unit(p.y, last.y, first.y);
  }
  const std::vector<Place> hull = lower_hull(curve);

  std::vector<std::size_t> line{0, hull.size() - 1};  // positions on the hull, rising
  while (line.size() < count + 2 && line.size() < hull.size()) {
    double farthest = -1;
    std::size_t chosen = 0;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Place &a = hull[line[k]], &b = hull[line[k + 1]];
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      for (std::size_t i = line[k] + 1; i < line[k + 1]; ++i) {
        const double distance = std::fabs(cross(a, b, hull[i])) / length;
        if (distance > farthest) {
          farthest = distance;
          chosen = i;
        }
      }
    }
    line.insert(std::ranges::upper_bound(line, chosen), chosen);
  }
  Knees result;
  for (std::size_t k = 1; k + 1 < line.size(); ++k) result.points.push_back(hull[line[k]].point);
  if (result.points.empty())
    result.none = "the front bends nowhere: its dear end gains as much accuracy for more cost as its cheap end";
  return result;
}

double rank_correlation(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) throw std::invalid_argument("rank correlation of lists of different lengths");
  std::vector<double> kept_a, kept_b;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) || std::isnan(b[i])) continue;
    kept_a.push_back(a[i]);
    kept_b.push_back(b[i]);
  }
  const std::vector<double> rank_a = average_ranks(kept_a), rank_b = average_ranks(kept_b);
  const double middle = (static_cast<double>(kept_a.size()) + 1) / 2;
  double together = 0, alone_a = 0, alone_b = 0;
  for (std::size_t i = 0; i < rank_a.size(); ++i) {
    together += (rank_a[i] - middle) * (rank_b[i] - middle);
    alone_a += (rank_a[i] - middle) * (rank_a[i] - middle);
    alone_b += (rank_b[i] - middle) * (rank_b[i] - middle);
  }
  if (alone_a == 0 || alone_b == 0) return std::numeric_limits<double>::quiet_NaN();
  return together / std::sqrt(alone_a * alone_b);
}

}  // namespace quadrille::sweep
