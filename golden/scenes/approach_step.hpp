// What the makers of approaches work with; not for use outside this folder.
#pragma once

#include "golden/scenes/approach.hpp"
#include "golden/scenes/window_point.hpp"
#include "model/support/prng.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace quadrille::golden::approach {

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

inline double pick(Prng& rng, double low, double high) { return snap256(rng.uniform(low, high)); }

/// A pixel centre away from the viewport's ends.
inline Point centre(Step& s) {
  const double x = static_cast<double>(s.rng.integer(s.width / 3, 2 * s.width / 3));
  const double y = static_cast<double>(s.rng.integer(s.height / 3, 2 * s.height / 3));
  return {x + 0.5, y + 0.5};
}

/// A pixel centre, or a point between centres.
inline Point anywhere(Step& s) {
  const Point c = centre(s);
  const double dx = pick(s.rng, -0.5, 0.5);
  const double dy = pick(s.rng, -0.5, 0.5);
  return s.rng.chance(0.5) ? c : c + Point{dx, dy};
}

inline Point around(Step& s, Point p, double reach) {
  const double dx = pick(s.rng, -reach, reach);
  const double dy = pick(s.rng, -reach, reach);
  return p + Point{dx, dy};
}

/// One of eight directions of whole steps.
inline Point direction(Step& s) {
  constexpr std::array<Point, 8> all{{{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 1}, {-1, 2}, {-1, 0}, {0, -1}}};
  return all[s.rng.below(all.size())];
}

/// Ordinary corners with w a power of two, so that snapping moves nothing.
inline Vertices ordinary(Step& s, const Points& p) {
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
inline void set_camera_depth(Step& s, Vertices& v) {
  const double a = s.rng.uniform(0.5, 0.95);
  for (WindowVertex& q : v) q.z = a * q.w - 0x1p-9;
}

// approach_pixel.cpp
Vertices edge_distance(Step& s);
Vertices edge_line(Step& s);
Vertices right_angle_edge(Step& s);
Vertices right_angle_diagonal(Step& s);
Vertices vertex_distance(Step& s);
Vertices crossing(Step& s);
Vertices sliver_thickness(Step& s);
Vertices edge_length(Step& s);
Vertices opposite_distance(Step& s);
Vertices diagonal_distance(Step& s);

// approach_eye.cpp
Vertices eye_plane(Step& s);
Vertices eye_face(Step& s);
Vertices eye_edge(Step& s);
Vertices eye_diagonal(Step& s);
Vertices guard_band(Step& s);
Vertices guard_band_flat(Step& s);
Vertices value_spread(Step& s);
Vertices depth_limit(Step& s);
Vertices w_ratio(Step& s);
Vertices coincident_w(Step& s);
Vertices long_edge(Step& s);
Vertices long_edge_down(Step& s);
Vertices long_edge_behind(Step& s);

}  // namespace quadrille::golden::approach
