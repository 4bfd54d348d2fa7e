// Approaches of the eye, of limits of numbers and of values.
#include "golden/scenes/approach_step.hpp"

namespace quadrille::golden::approach {

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

namespace {

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

}  // namespace

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

}  // namespace quadrille::golden::approach
