// The pixels of a whole quad: expression (12) of Hormann & Tarini (2004) on homogeneous edge functions.
#pragma once

#include "golden/methods/homogeneous.hpp"

#include <algorithm>

namespace quadrille::golden::methods {

/// Coverage of a quad at (x, y): 1 where (12) holds, -1 where it holds with all edge functions negated (front-facing,
/// as y points down), 0 outside. Any sign of w. Signs and ties are those of side(), so a pixel on a shared
/// edge or corner is drawn once; an edge whose coefficients are all zero is false in (12) and in its negated form.
inline int quad_orientation(const std::array<WindowVertex, 4>& vertex, double x, double y) {
  const PixelVector s0(vertex[0], x, y), s1(vertex[1], x, y), s2(vertex[2], x, y), s3(vertex[3], x, y);
  const int e01 = side(s0, s1), e12 = side(s1, s2), e23 = side(s2, s3), e30 = side(s3, s0), e20 = side(s2, s0);
  for (const int o : {1, -1}) {
    if (e20 == o && e01 == o && e12 == o && (e23 == o || e30 == o)) return o;
    if (e20 == -o && e23 == o && e30 == o && (e01 == o || e12 == o)) return o;
  }
  return 0;
}

/// Calls visit(x, y, front) for every pixel of the view whose centre the quad covers, behind the eye too.
template <class Visit>
void raster_quad(const std::array<WindowVertex, 4>& vertex, const View& view, Visit&& visit) {
  for_each_pixel(vertex, view, CoverageRows::Eye::anywhere, [&](int x, int y) {
    const int orientation = quad_orientation(vertex, x + 0.5, y + 0.5);
    if (orientation != 0) visit(x, y, orientation < 0);
  });
}

/// Nothing of the quad is behind the eye: every covered pixel is visible.
inline bool all_in_front(const std::array<WindowVertex, 4>& vertex) {
  return std::ranges::all_of(vertex, [](const WindowVertex& v) { return v.w > 0; });
}

}  // namespace quadrille::golden::methods
