#include "golden/reference/coverage_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille::golden {

namespace {

constexpr std::array<std::array<std::size_t, 2>, 5> edge_ends{{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}}};

/// A triangle abc that a clause of (12) asks for: the edges ab, bc, ca, with the sense in which they are stored.
struct Clause {
  std::array<std::size_t, 3> corner;
  std::array<std::size_t, 3> edge;
  std::array<int, 3> sense;
};
constexpr std::array<Clause, 2> clauses{{{{0, 1, 2}, {0, 1, 4}, {1, 1, 1}}, {{0, 2, 3}, {4, 2, 3}, {-1, 1, 1}}}};

/// Of the magnitudes behind a sum: a sign that is not in doubt. With S rounded, products and their difference an edge
/// function in double is within some 2^-50 of them, here and elsewhere.
constexpr double certain = 0x1p-48;
constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr std::array<int, 2> orientations{1, -1};

struct Interval {
  double low = -infinity, high = infinity;
};

/// Bounds of v over the points with w = 1 of { sum(c_i (v_i, w_i)) : -certain most_i <= c_i <= most_i }: v >= L where
/// v_i - L w_i >= 0 for all i.
Interval quotients(const std::array<double, 3>& v, const std::array<double, 3>& w, const std::array<double, 3>& most) {
  const auto lowest = [&](double sign) {
    double low = infinity, slack = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (w[i] > 0) low = std::min(low, sign * v[i] / w[i]);
    for (std::size_t i = 0; i < 3; ++i) {
      if (w[i] <= 0 && !(sign * v[i] - low * w[i] >= 0)) return -infinity;
      slack += 2 * certain * most[i] * (std::fabs(v[i]) + std::fabs(low * w[i]));
    }
    return low - slack;
  };
  return {lowest(1), -lowest(-1)};
}

/// Of the pixels first <= x < end those with low <= x + centre <= high, and what the quotients behind the bounds may
/// have lost. A bound that is no number bounds nothing.
void clip(const Interval& x, double centre, int& first, int& end) {
  constexpr double margin = 0x1p-10;
  const double low = std::ceil(x.low - centre - margin), high = std::floor(x.high - centre + margin) + 1;
  if (low >= end)
    first = end;
  else if (low > first)
    first = static_cast<int>(low);
  if (high <= first)
    end = first;
  else if (high < end)
    end = static_cast<int>(high);
}

PixelRect hull(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

CoverageRows::CoverageRows(const std::array<Vertex, 4>& vertex, double centre, const PixelRect& within, Eye eye)
    : vertex_(vertex), centre_(centre) {
  if (within.empty()) return;
  const auto farthest = [centre](int first, int end) {
    return std::max(std::fabs(first + centre), std::fabs(end - 1 + centre));
  };
  const double px = farthest(within.x0, within.x1), py = farthest(within.y0, within.y1);
  Reach reach;
  for (std::size_t i = 0; i < 4; ++i) {
    reach.x[i] = std::fabs(vertex[i][0]) + std::fabs(vertex[i][2]) * px;
    reach.y[i] = std::fabs(vertex[i][1]) + std::fabs(vertex[i][2]) * py;
  }
  for (std::size_t j = 0; j < edge_ends.size(); ++j) {
    const auto [a, b] = edge_ends[j];
    // The least normal numbers have no 53 bits left: of products that are as small nothing is certain.
    tolerance_[j] = certain * (reach.x[a] * reach.y[b] + reach.y[a] * reach.x[b]) + 0x1p-960;
  }
  for (std::size_t clause = 0; clause < clauses.size(); ++clause)
    for (std::size_t o = 0; o < orientations.size(); ++o) {
      const PixelRect box = triangle_box(clause, orientations[o], within, reach, eye);
      possible_[clause][o] = !box.empty();
      bounds_ = hull(bounds_, box);
    }
}

/// Where the clause may hold: p = sum(E_i V_i) / det by Cramer's rule, with E_i the edge functions of the sides
/// opposite to the corners. They have the orientation's sign, but for the tolerance.
PixelRect CoverageRows::triangle_box(std::size_t clause, int orientation, const PixelRect& within, const Reach& reach,
                                     Eye eye) const {
  const auto& corner = clauses[clause].corner;
  const Vertex &a = vertex_[corner[0]], &b = vertex_[corner[1]], &c = vertex_[corner[2]];
  if (a == b || b == c || c == a) return {};  // the edge between them is 0 everywhere, which no clause accepts
  double det = 0, size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t m = (k + 1) % 3, n = (k + 2) % 3;
    det += a[k] * (b[m] * c[n] - b[n] * c[m]);
    size += std::fabs(a[k]) * (std::fabs(b[m] * c[n]) + std::fabs(b[n] * c[m]));
  }
  std::array<double, 3> x, y, w, most{};
  const auto take = [&](double sense) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex& v = vertex_[corner[i]];
      x[i] = sense * v[0], y[i] = sense * v[1], w[i] = sense * v[2];
    }
  };
  const double least = std::fabs(det) - certain * size;
  const bool side_known = least > 0x1p-900;
  if (side_known) {
    const double sense =
        det > 0 ? orientation : -orientation;  // 1: c_i = E_i / det are those of a point before the eye
    take(sense);
    double lost = 0;  // of sum(c_i w_i) = 1
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = corner[(i + 1) % 3], k = corner[(i + 2) % 3];
      most[i] = (reach.x[j] * reach.y[k] + reach.y[j] * reach.x[k] + 0x1p-900) / least;
      lost += certain * most[i] * std::fabs(w[i]);
    }
    if (lost < 0.5 && ((sense < 0 && eye == Eye::in_front) || std::ranges::all_of(w, [](double v) { return v <= 0; })))
      return {};
  }
  // A triangle on one side of the eye lies between its corners, however thin it is.
  const bool before = a[2] > 0 && b[2] > 0 && c[2] > 0, behind = a[2] < 0 && b[2] < 0 && c[2] < 0;
  if (behind && eye == Eye::in_front) return {};
  if (before || behind) {
    take(before ? 1 : -1);
    most = {};
  } else if (!side_known) {
    return within;
  }
  PixelRect box = within;
  clip(quotients(x, w, most), centre_, box.x0, box.x1);
  clip(quotients(y, w, most), centre_, box.y0, box.y1);
  return box.empty() ? PixelRect{} : box;
}

PixelSpan CoverageRows::row(int y) const {
  constexpr int narrow = 8;  // pixels; looking at them all takes less
  if (bounds_.x1 - bounds_.x0 <= narrow) return {bounds_.x0, bounds_.x1};
  // Along the row an edge function is constant - slope x.
  const double py = y + centre_;
  std::array<double, 5> constant, slope;
  for (std::size_t j = 0; j < edge_ends.size(); ++j) {
    const Vertex &a = vertex_[edge_ends[j][0]], &b = vertex_[edge_ends[j][1]];
    const double ya = a[1] - a[2] * py, yb = b[1] - b[2] * py;
    constant[j] = a[0] * yb - b[0] * ya;
    slope[j] = a[2] * yb - b[2] * ya;
  }
  PixelSpan span{bounds_.x1, bounds_.x0};
  for (std::size_t clause = 0; clause < clauses.size(); ++clause)
    for (std::size_t o = 0; o < orientations.size(); ++o) {
      if (!possible_[clause][o]) continue;
      Interval x;
      for (std::size_t e = 0; e < 3; ++e) {
        const std::size_t j = clauses[clause].edge[e];
        const double sign = clauses[clause].sense[e] * orientations[o];
        const double most = sign * constant[j] + tolerance_[j], per_pixel = sign * slope[j];  // per_pixel x <= most
        const double end = most / per_pixel;
        if (per_pixel > 0 && end < x.high)
          x.high = end;
        else if (per_pixel < 0 && end > x.low)
          x.low = end;
        else if (per_pixel == 0 && most < 0)
          x = {infinity, -infinity};
      }
      int first = bounds_.x0, end = bounds_.x1;
      clip(x, centre_, first, end);
      if (first >= end) continue;
      span.x0 = std::min(span.x0, first);
      span.x1 = std::max(span.x1, end);
    }
  return span;
}

}  // namespace quadrille::golden
