#include "golden/scenes/approach.hpp"

#include "golden/scenes/window_point.hpp"
#include "model/support/prng.hpp"

#include <array>
#include <cmath>
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
/// one.
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

/// Corner 0 beside a pixel centre.
Vertices vertex_distance(Step& s) {
  const Point c = centre(s), d = direction(s);
  s.happens_at(c);
  Points p{c + s.offset() * d};
  for (std::size_t i = 1; i < 4; ++i) p[i] = around(s, c, 16);
  return ordinary(s, p);
}

/// A bow-tie: edges 01 and 23 cross near a pixel centre.
Vertices crossing(Step& s) {
  const Point c = centre(s), u = direction(s);
  s.happens_at(c);
  const Point v = s.rng.chance(0.5) ? Point{-u.y, u.x} : Point{u.x - 2 * u.y, u.y + 2 * u.x};
  const Point moved{s.offset(), -2 * s.offset()};
  const double a = pick(s.rng, 2, 8), b = pick(s.rng, 2, 8), d = pick(s.rng, 1, 4), e = pick(s.rng, 1, 4);
  return ordinary(s, {c - a * u + moved, c + b * u + moved, c - d * v - 2 * moved, c + e * v - 2 * moved});
}

/// Long sides through pixel centres, 2^-knob px apart; not quite parallel in half of the quads.
Vertices sliver_thickness(Step& s) {
  const Point c = centre(s), u = direction(s);
  const double a = pick(s.rng, 6, 12), b = pick(s.rng, 6, 12);
  const bool wedge = s.rng.chance(0.5);
  const Point thick = std::abs(u.x) >= std::abs(u.y) ? Point{0, s.offset()} : Point{s.offset(), 0};
  return ordinary(s, {c - a * u, c + b * u, c + b * u + thick, wedge ? c - a * u : c - a * u + thick});
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
  for (std::size_t i = 3; i > 0; --i) std::swap(v[i], v[s.rng.below(i + 1)]);
  set_camera_depth(s, v);
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

struct Generator {
  Approach info;
  Vertices (*make)(Step&);
};

constexpr int extent = 64;
constexpr std::array<Generator, 10> generators{{
    {{"edge_distance", "an edge through a pixel centre", "distance in px", 0, 24, true, true, extent, extent},
     edge_distance},
    {{"vertex_distance", "a corner at a pixel centre", "distance in px, times up to 2.3", 0, 8, true, true, extent,
      extent},
     vertex_distance},
    {{"crossing", "a bow-tie that crosses at a pixel centre", "distance of either edge in px, times up to 4.5", 0, 8,
      true, true, extent, extent},
     crossing},
    {{"sliver_thickness", "no area", "thickness in px", 0, 8, true, true, extent, extent}, sliver_thickness},
    {{"edge_length", "two neighbouring corners equal", "length of their edge in px, times up to 2.3", 0, 8, true, true,
      extent, extent},
     edge_length},
    {{"diagonal_distance", "a corner of 180 degrees, on the diagonal",
      "distance of the corner from the diagonal in px, times up to 2.3", 0, 8, true, true, extent, extent},
     diagonal_distance},
    {{"eye_plane", "a corner in the eye plane, w = 0", "|w| of the corner", 0, 23, true, true, extent, extent},
     eye_plane},
    {{"eye_face", "the eye in a face of the corners' hull", "share of the fourth corner in the eye", 0, 14, true, true,
      extent, extent},
     eye_face},
    {{"coincident_w", "two neighbouring corners equal, w too", "|w1/w0 - 1| of corners at one place", 1, 24, true, true,
      extent, extent},
     coincident_w},
    {{"long_edge", "", "2^knob is the length in px", 4, 12, false, false, 4096, 16}, long_edge},
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
    Step step{Prng(seed * 1'000'003 + q, index + 1), knob, side, approach.width, approach.height};
    const Vertices vertices = generators[index].make(step);
    take(q, step, vertices);
  }
}

}  // namespace

std::vector<WindowQuad> make_approach(const Approach& approach, int knob, int side, std::size_t count,
                                      std::uint64_t seed, int attributes) {
  std::vector<WindowQuad> quads(count);
  each_step(approach, knob, side, count, seed, [&](std::size_t q, Step& step, const Vertices& vertices) {
    quads[q].id = static_cast<std::uint32_t>(q);
    quads[q].vertex = vertices;
    for (std::vector<double>& attribute : quads[q].attribute)
      for (int a = 0; a < attributes; ++a) attribute.push_back(step.rng.uniform(-1, 1));
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
