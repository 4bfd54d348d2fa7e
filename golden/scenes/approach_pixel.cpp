// Approaches to special cases of a pixel, an edge or two corners.
#include "golden/scenes/approach_step.hpp"

namespace quadrille::golden::approach {

/// The edge from corner 0 to corner 1 passes a pixel centre, which is about in its middle. Up to 2^-8 px the edge is
/// moved; below the grid it is a long one from (-N, -J) to (N + 1, J) units of the grid, whose distance is J/(2N) of
/// one. The pixel is inside on one of the two sides.
Vertices edge_distance(Step& s) {
  const Point c = centre(s);
  s.happens_at(c);
  Point from, to;
  const double left = pick(s.rng, 6, 20), right = pick(s.rng, 6, 20), slope = s.rng.chance(0.5) ? 1 : 0;
  if (s.knob <= 8) {
    from = c + Point{-left, -left * slope + s.offset()};
    to = c + Point{right, right * slope + s.offset()};
  } else {
    const double n = std::ldexp(1.0, std::max(12, s.knob - 9)), j = std::ldexp(1.0, std::max(0, 21 - s.knob));
    from = c + 1 / window_grid * Point{-n, -j};
    to = c + 1 / window_grid * Point{n + s.side, j};
  }
  const double h0 = pick(s.rng, 8, 20), h1 = pick(s.rng, 8, 20);
  Points p{from, to, to + Point{-pick(s.rng, 0, 4), h1}, from + Point{pick(s.rng, 0, 4), h0}};
  if (s.rng.chance(0.5))  // the other two corners on the other side
    for (std::size_t i = 2; i < 4; ++i) p[i].y = 2 * c.y - p[i].y;
  return ordinary(s, p);
}

/// The edge from corner 0 to corner 1 ends before the pixel that its line passes: corner 1 is reflex, and the pixel
/// inside on both sides. Below the grid the corners are at -(2N + 1, 2J) and -(N, J) units of it, whose line is J/N of
/// one away.
Vertices edge_line(Step& s) {
  const Point c = centre(s);
  s.happens_at(c);
  Point from, to;
  const double near = pick(s.rng, 4, 12), length = pick(s.rng, 4, 16), slope = s.rng.chance(0.5) ? 1 : 0;
  if (s.knob <= 8) {
    from = c + Point{-near - length, -(near + length) * slope + s.offset()};
    to = c + Point{-near, -near * slope + s.offset()};
  } else {
    const double n = std::ldexp(1.0, std::max(12, s.knob - 8)), j = std::ldexp(1.0, std::max(0, 20 - s.knob));
    from = c - 1 / window_grid * Point{2 * n + s.side, 2 * j};
    to = c - 1 / window_grid * Point{n, j};
  }
  // Steeper than the line, so that corner 1 is reflex whatever its slope.
  const double x2 = pick(s.rng, 2, 6), y2 = pick(s.rng, 10, 20), x3 = pick(s.rng, 4, 12), y3 = pick(s.rng, 8, 20);
  return ordinary(s, {from, to, c + Point{x2, y2}, c + Point{x3, -y3}});
}

namespace {

/// The corners `first` and `second` as seen from a pixel: S and S' with S . S' = J, of a right angle but for that.
/// S = (N, 1) units of the grid and S' = (1 + J div N, -N + J mod N); J / N^2 is 2^-knob, down to J = 1.
Points right_angle(Step& s, Point c, std::size_t first, std::size_t second) {
  constexpr int n_log2 = 11;  // 8 px
  const double n = std::ldexp(1.0, n_log2);
  const int j_log2 = 2 * n_log2 - s.knob;
  Point other{1, -n};
  (j_log2 >= n_log2 ? other.x : other.y) += s.side * std::ldexp(1.0, j_log2 >= n_log2 ? j_log2 - n_log2 : j_log2);
  const double long0 = static_cast<double>(s.rng.integer(1, 3)), long1 = static_cast<double>(s.rng.integer(1, 2));
  Points p{c, c, c, c};
  p[first] = c + long0 / window_grid * Point{n, 1};
  p[second] = c + long1 / window_grid * other;
  return p;
}

}  // namespace

/// Corners 0 and 1 at a right angle as seen from a pixel inside.
Vertices right_angle_edge(Step& s) {
  const Point c = centre(s);
  s.happens_at(c);
  Points p = right_angle(s, c, 0, 1);
  const double x2 = pick(s.rng, 6, 16), y2 = pick(s.rng, 0, 6), x3 = pick(s.rng, 0, 6), y3 = pick(s.rng, 6, 16);
  p[2] = c + Point{-x2, -y2};
  p[3] = c + Point{-x3, y3};
  return ordinary(s, p);
}

/// Corners 0 and 2 at a right angle as seen from a pixel inside: what the notch cure looks at.
Vertices right_angle_diagonal(Step& s) {
  const Point c = centre(s);
  s.happens_at(c);
  Points p = right_angle(s, c, 0, 2);
  const double x1 = pick(s.rng, 20, 28), y1 = pick(s.rng, 20, 28), x3 = pick(s.rng, 10, 16), y3 = pick(s.rng, 4, 9);
  p[1] = c + Point{x1, -y1};
  p[3] = c + Point{-x3, y3};
  return ordinary(s, p);
}

/// Corner 0 beside a pixel centre, which is inside on both sides of a reflex corner and on one of a convex one.
Vertices vertex_distance(Step& s) {
  const Point c = centre(s), d = direction(s), across{-d.y, d.x};
  s.happens_at(c);
  const double a = pick(s.rng, 8, 10), b = pick(s.rng, 8, 10), e = pick(s.rng, 8, 10), t1 = pick(s.rng, 4, 8),
               t3 = pick(s.rng, 4, 8), f = pick(s.rng, -1, 1);
  const double inward = s.rng.sign();
  const Point corner = c + s.offset() * d;
  if (s.rng.chance(0.5))  // reflex, its notch to one side of the way
    return ordinary(s, {corner, c + t1 * d + a * across, c + f * d - e * across, c - t3 * d + b * across});
  return ordinary(s, {corner, c + inward * a * d + t1 * across, c + inward * (a + e) * d + f * across,
                      c + inward * b * d - t3 * across});
}

/// A bow-tie: edges 01 and 23 cross near a pixel centre, which is in one of the two lobes.
Vertices crossing(Step& s) {
  const Point c = centre(s), u = direction(s);
  s.happens_at(c);
  const Point v = s.rng.chance(0.5) ? Point{-u.y, u.x} : Point{u.x - 2 * u.y, u.y + 2 * u.x};
  const Point moved = s.offset() * (u + v);
  const double a = pick(s.rng, 2, 8), b = pick(s.rng, 2, 8), d = pick(s.rng, 1, 4), e = pick(s.rng, 1, 4);
  return ordinary(s, {c - a * u + moved, c + b * u + moved, c - d * v - 2 * moved, c + e * v - 2 * moved});
}

/// Long sides 2^-knob px apart; they meet in half of the quads. Side 01 leaves a row of pixel centres a step of the
/// grid beside one and arrives a step beside another, on the other hand: of a sliver as thin as that step, on either
/// side of it, some of these centres are inside and not on an edge.
Vertices sliver_thickness(Step& s) {
  const Point c = centre(s), u = direction(s);
  const double a = pick(s.rng, 6, 12), b = pick(s.rng, 6, 12);
  const bool wedge = s.rng.chance(0.5);
  const Point across = std::abs(u.x) >= std::abs(u.y) ? Point{0, 1} : Point{1, 0};
  const Point thick = s.offset() * across, step = 1 / window_grid * across;
  const Point from = c - a * u - step, to = c + b * u + step;
  return ordinary(s, {from, to, to + thick, wedge ? from : from + thick});
}

/// Corners 0 and 1 close together.
Vertices edge_length(Step& s) {
  const Point p0 = anywhere(s), d = direction(s);
  const Point p2 = around(s, p0, 16), p3 = around(s, p0, 16);
  Vertices v = ordinary(s, {p0, p0, p2, p3});
  const double w = v[0].w;
  v[1] = {(p0.x + s.offset() * d.x) * w, (p0.y + s.offset() * d.y) * w, v[0].z, w};
  return v;
}

/// Corners 0 and 2 close together, on either side of a pixel centre; edges lead away from there to corners 1 and 3, in
/// one line or bent.
Vertices opposite_distance(Step& s) {
  const Point c = centre(s), d = direction(s), across{-d.y, d.x};
  s.happens_at(c);
  const double a = pick(s.rng, 4, 10), b = pick(s.rng, 4, 10), bend = s.rng.chance(0.5) ? 1 : 0;
  return ordinary(s,
                  {c - s.offset() * d, c + a * across, c + s.offset() * (d + across), c - b * across + bend * b * d});
}

/// Corner 1 beside the diagonal 02: convex, a corner of 180 degrees, reflex.
Vertices diagonal_distance(Step& s) {
  const Point m = anywhere(s), u = direction(s), across{-u.y, u.x};
  const double a = pick(s.rng, 3, 8), b = pick(s.rng, 3, 8), h = pick(s.rng, 4, 8), along = pick(s.rng, -3, 3);
  return ordinary(s, {m - a * u, m + s.offset() * across, m + b * u, m + along * u + h * across});
}

}  // namespace quadrille::golden::approach
