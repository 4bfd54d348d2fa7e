// What the tests of stress share.
#pragma once

#include "golden/scenes/test_support.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden {
namespace {

struct Point {
  double x, y;
};

inline Point at(const WindowQuad& quad, std::size_t i) {
  const WindowVertex& v = quad.vertex[i & 3];
  return {v.x / v.w, v.y / v.w};
}

inline double cross(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }
inline double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }
inline bool at_centre(Point p) { return p.x - std::floor(p.x) == 0.5 && p.y - std::floor(p.y) == 0.5; }
inline double from_centre(Point p) { return distance(p, {std::floor(p.x) + 0.5, std::floor(p.y) + 0.5}); }
inline bool equal(const WindowVertex& a, const WindowVertex& b) { return a.x == b.x && a.y == b.y && a.w == b.w; }
inline bool all_in_front(const WindowQuad& q) {
  return std::all_of(q.vertex.begin(), q.vertex.end(), [](const WindowVertex& v) { return v.w > 0; });
}

inline double thickness(const WindowQuad& q) {  // area over longest side or diagonal
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, distance(at(q, i), at(q, j)));
  }
  return (std::abs(cross(at(q, 0), at(q, 1), at(q, 2))) + std::abs(cross(at(q, 0), at(q, 2), at(q, 3)))) / 2 / longest;
}

}  // namespace
}  // namespace quadrille::golden
