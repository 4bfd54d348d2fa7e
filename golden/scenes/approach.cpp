#include "golden/scenes/approach.hpp"

#include "golden/scenes/window_point.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace quadrille::golden {
namespace {

using Point = WindowPoint;
using Points = std::array<Point, 4>;
using Vertices = std::array<WindowVertex, 4>;

/// One quad to make: its own random numbers, and how far it is from the special case.
struct Step {
  Prng rng;
  int knob;
  int side;  ///< 1, -1, or 0: the special case
  int width, height;
  ApproachPlace place{};  ///< the whole quad unless the approach says otherwise
  /// Of approaches that are about values: the attributes of corner 0, 1, 2, 3 of the definition. None: any in [-1, 1].
  std::optional<std::array<double, 4>> value{};

  /// The signed distance, 0 at the special case.
  double offset() const { return side * std::ldexp(1.0, -knob); }

  void happens_near(Point p, double radius) {
    place.near_x = p.x;
    place.near_y = p.y;
    place.near_radius = radius;
  }
  /// At a pixel centre.
  void happens_at(Point centre) { happens_near(centre, 0); }
};

double pick(Prng& rng, double low, double high) { return snap256(rng.uniform(low, high)); }

/// A pixel centre away from the viewport's ends.
Point centre(Step& s) {
  const double x = static_cast<double>(s.rng.integer(s.width / 3, 2 * s.width / 3));
  const double y = static_cast<double>(s.rng.integer(s.height / 3, 2 * s.height / 3));
  return {x + 0.5, y + 0.5};
}

/// A pixel centre, or a point between centres.
Point anywhere(Step& s) {
  const Point c = centre(s);
  const double dx = pick(s.rng, -0.5, 0.5);
  const double dy = pick(s.rng, -0.5, 0.5);
  return s.rng.chance(0.5) ? c : c + Point{dx, dy};
}

Point around(Step& s, Point p, double reach) {
  const double dx = pick(s.rng, -reach, reach);
  const double dy = pick(s.rng, -reach, reach);
  return p + Point{dx, dy};
}

/// One of eight directions of whole steps.
Point direction(Step& s) {
  constexpr std::array<Point, 8> all{{{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 1}, {-1, 2}, {-1, 0}, {0, -1}}};
  return all[s.rng.below(all.size())];
}

/// Ordinary corners with w a power of two, so that snapping moves nothing.
Vertices ordinary(Step& s, const Points& p) {
  Vertices v;
  const bool perspective = s.rng.chance(0.5);
  for (std::size_t i = 0; i < 4; ++i) {
    const double octave = static_cast<double>(s.rng.integer(-3, 3));
    const double w = perspective ? std::exp2(octave) : 1;
    const double z = s.rng.uniform(0.1, 0.9);
    v[i] = {p[i].x * w, p[i].y * w, z * w, w};
  }
  return v;
}

/// Depth as a perspective camera makes it: linear in w, and in [0, 1] but close to the eye.
void set_camera_depth(Step& s, Vertices& v) {
  const double a = s.rng.uniform(0.5, 0.95);
  for (WindowVertex& q : v) q.z = a * q.w - 0x1p-9;
}

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

/// Corner 1 through the eye plane: w = +-2^-knob, x and y stay.
Vertices eye_plane(Step& s) {
  const Point c = centre(s);
  Points p;
  for (Point& q : p) q = around(s, c, 24);
  Vertices v = ordinary(s, p);
  const Point u = direction(s);
  const Point d = pick(s.rng, 8, 64) * u;
  v[1] = {d.x, d.y, 0, s.offset()};
  set_camera_depth(s, v);
  return v;
}

/// Corner 3 = -(V0 + V1)/2 - c V2 with c = +-2^-knob, the corners in any order: the eye is in their hull, in its face
/// 013, beside it.
Vertices eye_face(Step& s) {
  const Point c = centre(s);
  Vertices v;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point p = around(s, c, 40);
    v[i] = {p.x, p.y, 0, 1};
  }
  const auto opposite = [&](double WindowVertex::*number) {
    return -(v[0].*number + v[1].*number) / 2 - s.offset() * v[2].*number;
  };
  v[3] = {opposite(&WindowVertex::x), opposite(&WindowVertex::y), 0, opposite(&WindowVertex::w)};
  std::array<std::size_t, 4> order{0, 1, 2, 3};  // any: its corners may be next to each other or not
  s.rng.shuffle(order);
  Vertices ordered;
  for (std::size_t i = 0; i < 4; ++i) ordered[order[i]] = v[i];
  s.place.corner = order;
  v = ordered;
  set_camera_depth(s, v);
  return v;
}

/// A corner -c V0 + 2^-knob U: the eye is on the line from there to corner 0, of which all points are one in the
/// picture.
WindowVertex beyond_the_eye(Step& s, const WindowVertex& v0) {
  const double share = std::ldexp(1.0, static_cast<int>(s.rng.integer(-2, 2)));
  const double dx = s.rng.sign() * pick(s.rng, 8, 24), dy = s.rng.sign() * pick(s.rng, 8, 24);
  const Point u{v0.x + dx, v0.y + dy};
  return {-share * v0.x + s.offset() * u.x, -share * v0.y + s.offset() * u.y, 0, -share + s.offset()};
}

/// Corners around a place, w = 1.
Vertices flat_corners(Step& s) {
  const Point c = centre(s);
  Vertices v;
  for (WindowVertex& q : v) {
    const Point p = around(s, c, 24);
    q = {p.x, p.y, 0, 1};
  }
  return v;
}

/// The eye beside the edge from corner 0 to corner 1.
Vertices eye_edge(Step& s) {
  Vertices v = flat_corners(s);
  v[1] = beyond_the_eye(s, v[0]);
  set_camera_depth(s, v);
  return v;
}

/// The eye beside the diagonal from corner 0 to corner 2.
Vertices eye_diagonal(Step& s) {
  Vertices v = flat_corners(s);
  v[2] = beyond_the_eye(s, v[0]);
  set_camera_depth(s, v);
  return v;
}

/// Corner 0 through the limit of the guard band that the standard configuration has: on side -1 it is ordinary.
Vertices guard_band(Step& s) {
  constexpr double limit = 1 << 15;  // of a pixel centre's coordinates
  const Point c = centre(s);
  Points p;
  for (Point& q : p) q = around(s, c, 24);
  const double far = s.rng.sign() * (limit + s.offset()) + 0.5, along = pick(s.rng, -limit / 2, limit / 2);
  p[0] = s.rng.chance(0.5) ? Point{far, along} : Point{along, far};
  return ordinary(s, p);
}

/// One depth for all four corners, beyond the limit of the guard band. So far away the vertex is rounded to
/// the grid of homogeneous ones, but not its depth.
Vertices guard_band_flat(Step& s) {
  Vertices v = guard_band(s);
  const double depth = snap256(s.rng.uniform(0.9, 1));
  for (WindowVertex& q : v) q.z = depth * q.w;
  return v;
}

/// Depths from either end of their range on, spread over 2^-knob of it; attributes likewise from 100 to 127 on, or from
/// below 0.
Vertices value_spread(Step& s) {
  const Point c = centre(s);
  Points p;
  for (Point& q : p) q = around(s, c, 24);
  Vertices v = ordinary(s, p);
  std::array<double, 4> part{};
  for (double& share : part) share = s.rng.uniform();
  const std::size_t one = 1 + s.rng.below(3);
  part[0] = 0;
  part[one] = 1;
  const bool from_low = s.rng.chance(0.5);
  const double step = from_low ? s.offset() : -s.offset(), end = s.rng.uniform(100, 127);
  s.value.emplace();
  for (std::size_t i = 0; i < 4; ++i) {
    v[i].z = ((from_low ? 0 : 1) + part[i] * step) * v[i].w;
    (*s.value)[i] = end * ((from_low ? -1 : 1) + 2 * part[i] * step);
  }
  return v;
}

/// Corner 0 within the range of depth or beyond its end, which is where znear and zfar are; the others within, or at
/// the end.
Vertices depth_limit(Step& s) {
  const Point c = centre(s);
  Points p;
  for (Point& q : p) q = around(s, c, 24);
  Vertices v = ordinary(s, p);
  const bool far = s.rng.chance(0.5), others = s.rng.chance(0.75);
  for (std::size_t i = 0; i < 4; ++i) {
    const double inward = i == 0 ? s.offset() : others ? s.rng.uniform(0.1, 0.9) : 0;
    v[i].z = (far ? 1 - inward : inward) * v[i].w;
  }
  return v;
}

/// w of 2^knob or 2^-knob among corners of w = 1: corner 0, corners 0 and 1, or spread over the four.
Vertices w_ratio(Step& s) {
  const Point c = centre(s);
  const std::uint64_t kind = s.rng.below(3);
  Vertices v;
  for (int i = 0; i < 4; ++i) {
    const Point p = around(s, c, 24);
    const double z = s.rng.uniform(0.1, 0.9);
    const int octaves = kind == 2 ? s.knob * (3 - i) / 3 : i <= static_cast<int>(kind) ? s.knob : 0;
    const double w = std::ldexp(1.0, s.side * octaves);
    v[static_cast<std::size_t>(i)] = {p.x * w, p.y * w, z * w, w};
  }
  return v;
}

/// Corners 0 and 1 at one place, w1/w0 = 1 +- 2^-knob.
Vertices coincident_w(Step& s) {
  const Point p0 = anywhere(s);
  const Point p2 = around(s, p0, 16), p3 = around(s, p0, 16);
  Vertices v = ordinary(s, {p0, p0, p2, p3});
  const double w = v[0].w * (1 + s.offset());
  v[1] = {p0.x * w, p0.y * w, v[0].z / v[0].w * w, w};
  return v;
}

/// Long sides of 2^knob px from the left, few pixels apart: what forward differences drift over.
Vertices long_edge(Step& s) {
  const double x0 = pick(s.rng, -1, 2), y0 = pick(s.rng, 0, s.height), length = std::ldexp(1.0, s.knob);
  const double y1 = pick(s.rng, 0, s.height), t0 = pick(s.rng, 0.5, 6), t1 = pick(s.rng, 0.5, 6);
  return ordinary(s, {Point{x0, y0}, Point{x0 + length, y1}, Point{x0 + length, y1 + t1}, Point{x0, y0 + t0}});
}

/// The same from the top.
Vertices long_edge_down(Step& s) {
  std::swap(s.width, s.height);
  Vertices v = long_edge(s);
  for (WindowVertex& q : v) std::swap(q.x, q.y);
  return v;
}

/// The same to the right end of the viewport, corner 1 behind the eye: as far to the left of corner 0 as corner 2 is to
/// the right, so that edge 01 goes through the viewport and on without end.
Vertices long_edge_behind(Step& s) {
  const double length = std::ldexp(1.0, s.knob);
  const double x0 = s.width - length + pick(s.rng, -1, 2), y0 = pick(s.rng, 0, s.height);
  const double y1 = pick(s.rng, 0, s.height), t0 = pick(s.rng, 0.5, 6), t1 = pick(s.rng, 0.5, 6);
  Vertices v =
      ordinary(s, {Point{x0, y0}, Point{x0 - length, 2 * y0 - y1}, Point{x0 + length, y1 + t1}, Point{x0, y0 + t0}});
  v[1] = {-v[1].x, -v[1].y, 0, -v[1].w};
  set_camera_depth(s, v);
  return v;
}

/// What make_approach may do to the quads of a maker beside turning and mirroring the order of their corners.
enum class Window {
  keep,    ///< the case is at a place of the window
  mirror,  ///< left and right, top and bottom
  turn,    ///< x and y too: of a square viewport
};

struct Generator {
  Approach info;
  Vertices (*make)(Step&);
  Window window;
};

constexpr int extent = 64, long_extent = 4096, short_extent = 16;
constexpr std::array<Generator, 23> generators{{
    {{"edge_distance", "an edge through a pixel centre", "distance in px", 0, 24, true, true, extent, extent},
     edge_distance,
     Window::turn},
    {{"edge_line", "a pixel centre on an edge's line outside the edge", "distance in px", 0, 24, true, true, extent,
      extent},
     edge_line,
     Window::turn},
    {{"right_angle_edge", "neighbouring corners at a right angle as seen from a pixel, D = 0",
      "cosine of the angle, times up to 2", 0, 22, true, true, extent, extent},
     right_angle_edge,
     Window::turn},
    {{"right_angle_diagonal", "opposite corners at a right angle as seen from a pixel, D = 0",
      "cosine of the angle, times up to 2", 0, 22, true, true, extent, extent},
     right_angle_diagonal,
     Window::turn},
    {{"vertex_distance", "a corner at a pixel centre", "distance in px, times up to 2.3", 0, 8, true, true, extent,
      extent},
     vertex_distance,
     Window::turn},
    {{"crossing", "a bow-tie that crosses at a pixel centre", "distance of either edge in px, times up to 4.5", 0, 8,
      true, true, extent, extent},
     crossing,
     Window::turn},
    {{"sliver_thickness", "no area", "thickness in px", 0, 8, true, true, extent, extent},
     sliver_thickness,
     Window::turn},
    {{"edge_length", "two neighbouring corners equal", "length of their edge in px, times up to 2.3", 0, 8, true, true,
      extent, extent},
     edge_length,
     Window::turn},
    {{"opposite_distance", "two opposite corners equal, at a pixel centre", "their distance in px, times up to 5", 0, 8,
      true, true, extent, extent},
     opposite_distance,
     Window::turn},
    {{"diagonal_distance", "a corner of 180 degrees, on the diagonal",
      "distance of the corner from the diagonal in px, times up to 2.3", 0, 8, true, true, extent, extent},
     diagonal_distance,
     Window::turn},
    {{"eye_plane", "a corner in the eye plane, w = 0", "|w| of the corner", 0, 23, true, true, extent, extent},
     eye_plane,
     Window::turn},
    {{"eye_face", "the eye in a face of the corners' hull", "share of the fourth corner in the eye", 0, 14, true, true,
      extent, extent},
     eye_face,
     Window::turn},
    {{"eye_edge", "the eye on an edge", "share of another vertex in the corner opposite the eye", 0, 16, true, true,
      extent, extent},
     eye_edge,
     Window::turn},
    {{"eye_diagonal", "the eye on a diagonal", "share of another vertex in the corner opposite the eye", 0, 16, true,
      true, extent, extent},
     eye_diagonal,
     Window::turn},
    {{"guard_band", "a corner at the limit of the guard band", "distance from the limit in px", -12, 8, true, true,
      extent, extent},
     guard_band,
     Window::keep},
    {{"guard_band_flat", "the same of a quad of one depth", "distance from the limit in px", -24, 8, false, true,
      extent, extent},
     guard_band_flat,
     Window::keep},
    {{"value_spread", "one depth, and attributes of one value far from 0", "spread of the whole range", 0, 32, false,
      true, extent, extent, 127},
     value_spread,
     Window::turn},
    {{"depth_limit", "the depth of a corner at the end of its range, at znear or zfar", "distance in depth", 2, 27,
      true, true, extent, extent},
     depth_limit,
     Window::turn},
    {{"coincident_w", "two neighbouring corners equal, w too", "|w1/w0 - 1| of corners at one place", 1, 24, true, true,
      extent, extent},
     coincident_w,
     Window::turn},
    {{"w_ratio", "", "smallest w / largest w", 0, 40, true, false, extent, extent}, w_ratio, Window::turn},
    {{"long_edge", "", "2^knob is the length in px", 4, 12, false, false, long_extent, short_extent},
     long_edge,
     Window::mirror},
    {{"long_edge_down", "", "2^knob is the length in px", 4, 12, false, false, short_extent, long_extent},
     long_edge_down,
     Window::mirror},
    {{"long_edge_behind", "", "2^knob is the length in px, one corner behind the eye", 4, 12, false, false, long_extent,
      short_extent},
     long_edge_behind,
     Window::mirror},
}};

constexpr auto infos = [] {
  std::array<Approach, generators.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = generators[i].info;
  return all;
}();

}  // namespace

std::span<const Approach> approaches() { return infos; }

const Approach* find_approach(std::string_view name) {
  for (const Approach& info : infos)
    if (info.name == name) return &info;
  return nullptr;
}

namespace {

/// The window mirrored and turned, all numbers exact: a pixel centre becomes another one.
void turn_window(Step& s, Vertices& v, Window window) {
  const bool left_right = s.rng.chance(0.5), top_bottom = s.rng.chance(0.5), turned = s.rng.chance(0.5);
  if (window == Window::keep) return;
  const auto turn = [&](double& x, double& y, double w) {
    if (left_right) x = s.width * w - x;
    if (top_bottom) y = s.height * w - y;
    if (turned && window == Window::turn) std::swap(x, y);
  };
  for (WindowVertex& q : v) turn(q.x, q.y, q.w);
  turn(s.place.near_x, s.place.near_y, 1);
}

/// The order of the corners turned and mirrored: the same quad, its special corner another one.
Vertices turn_corners(Step& s, const Vertices& v) {
  const std::size_t first = s.rng.below(4);
  const bool mirrored = s.rng.chance(0.5);
  const auto turned = [&](std::size_t i) { return (first + (mirrored ? 4 - i : i)) & 3; };
  Vertices out;
  for (std::size_t i = 0; i < 4; ++i) out[turned(i)] = v[i];
  for (std::size_t& corner : s.place.corner) corner = turned(corner);
  return out;
}

/// The step of every quad, its vertices made.
template <class Take>
void each_step(const Approach& approach, int knob, int side, std::size_t count, std::uint64_t seed, const Take& take) {
  if (knob < approach.first || knob > approach.last || (side == 0 && !approach.limit) ||
      (side < 0 && !approach.both_sides) || side < -1 || side > 1)
    throw std::invalid_argument(std::string(approach.name) + ": no knob " + std::to_string(knob) + ", side " +
                                std::to_string(side));
  const auto index = static_cast<std::size_t>(find_approach(approach.name) - infos.data());
  for (std::size_t q = 0; q < count; ++q) {
    // A sequence of its own for each quad: every step draws as many numbers.
    Step step{Prng(seed * 1'000'003 + q, index + 1), side == 0 ? approach.last : knob, side, approach.width,
              approach.height};
    Vertices vertices = generators[index].make(step);
    step.width = approach.width;
    step.height = approach.height;
    turn_window(step, vertices, generators[index].window);
    take(q, step, turn_corners(step, vertices));
  }
}

}  // namespace

std::vector<WindowQuad> make_approach(const Approach& approach, int knob, int side, std::size_t count,
                                      std::uint64_t seed, int attributes) {
  std::vector<WindowQuad> quads(count);
  each_step(approach, knob, side, count, seed, [&](std::size_t q, Step& step, const Vertices& vertices) {
    quads[q].id = static_cast<std::uint32_t>(q);
    quads[q].vertex = vertices;
    for (std::size_t i = 0; i < 4; ++i)
      for (int a = 0; a < attributes; ++a)
        quads[q].attribute[step.place.corner[i]].push_back(step.value ? (a % 2 == 0 ? 1 : -1) * (*step.value)[i]
                                                                      : step.rng.uniform(-1, 1));
  });
  return quads;
}

bool ApproachPlace::is_near(int x, int y) const {
  return std::hypot(x + 0.5 - near_x, y + 0.5 - near_y) <= near_radius;
}

std::vector<ApproachPlace> approach_places(const Approach& approach, int knob, int side, std::size_t count,
                                           std::uint64_t seed) {
  std::vector<ApproachPlace> places(count);
  each_step(approach, knob, side, count, seed,
            [&](std::size_t q, const Step& step, const Vertices&) { places[q] = step.place; });
  return places;
}

}  // namespace quadrille::golden
