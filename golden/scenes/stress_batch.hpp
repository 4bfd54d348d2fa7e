// What the generators of stress families work with; not for use outside this folder.
#pragma once

#include "golden/scenes/recorded_numbers.hpp"
#include "golden/scenes/simple_engine.hpp"
#include "golden/scenes/stress.hpp"
#include "golden/scenes/window_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace quadrille::golden::stress {

using Points = std::array<WindowPoint, 4>;
using Weights = std::array<double, 4>;
using Numbers = RecordedNumbers;
using Vertices = std::array<WindowVertex, 4>;

inline constexpr Weights ones{1, 1, 1, 1};

/// Steps between pixel centres along which an edge meets many of them.
inline constexpr std::array<WindowPoint, 12> lattice_steps{
    {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 1}, {1, 2}, {-1, 2}, {-2, 1}, {-1, 0}, {0, -1}, {3, 1}, {1, -3}}};

/// What every generator works with. Draws come in program order, never two in one function call.
struct Batch {
  Numbers rng;
  double knob;
  int width, height;
  std::size_t count;
  std::vector<Vertices> quads{};

  bool full() const { return quads.size() >= count; }
  double extent() const { return std::min(width, height); }
};

inline WindowPoint random_point(Numbers& rng, double x0, double y0, double x1, double y1) {
  const double x = rng.uniform(x0, x1);
  const double y = rng.uniform(y0, y1);
  return {x, y};
}

/// A place for something of this size, inside the viewport where it fits.
inline WindowPoint place(Batch& b, double size) {
  const double mx = std::min(size, b.width * 1.0) / 2, my = std::min(size, b.height * 1.0) / 2;
  return random_point(b.rng, mx, my, b.width - mx, b.height - my);
}

inline WindowPoint centre_of_pixel(WindowPoint p) { return {std::floor(p.x) + 0.5, std::floor(p.y) + 0.5}; }

inline Points random_corners(Batch& b, WindowPoint centre, double size) {
  Points p;
  for (WindowPoint& q : p)
    q = random_point(b.rng, centre.x - size / 2, centre.y - size / 2, centre.x + size / 2, centre.y + size / 2);
  return p;
}

/// An angle's direction without sine: a point of the square's outline, normalised.
inline WindowPoint random_direction(Numbers& rng) {
  const double s = rng.uniform(-1, 1);
  const WindowPoint p = rng.chance(0.5) ? WindowPoint{s, rng.sign()} : WindowPoint{rng.sign(), s};
  return 1 / std::sqrt(p.x * p.x + p.y * p.y) * p;
}

/// Powers of two, so that x·w is exact and x·w/w is x again.
inline Weights exact_weights(Numbers& rng) {
  Weights w = ones;
  if (rng.chance(0.5)) {
    for (double& v : w) v = std::ldexp(1.0, static_cast<int>(rng.integer(-2, 2)));
  }
  return w;
}

/// Which corner comes first and which way round it goes is never the generator's.
inline void turn(Numbers& rng, Vertices& v) {
  std::rotate(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(rng.below(4)), v.end());
  if (rng.chance(0.5)) std::reverse(v.begin(), v.end());
}

/// A vertex of a family in front of the eye, at a window depth of its own.
inline WindowVertex ordinary(Numbers& rng, WindowPoint p, double w) {
  return {p.x * w, p.y * w, rng.uniform(0.1, 0.9) * w, w};
}

inline void emit(Batch& b, const Points& p, const Weights& w = ones) {
  Vertices v;
  for (std::size_t i = 0; i < 4; ++i) v[i] = ordinary(b.rng, p[i], w[i]);
  for (std::size_t i = 0; i < 4; ++i) {  // one depth for equal corners
    for (std::size_t j = 0; j < i; ++j) {
      if (v[i].x == v[j].x && v[i].y == v[j].y && v[i].w == v[j].w) v[i].z = v[j].z;
    }
  }
  turn(b.rng, v);
  b.quads.push_back(v);
}

/// z̃ = a w − b: what a perspective camera makes of depth, linear in w.
inline void set_camera_depth(Numbers& rng, Vertices& v) {
  const double a = rng.uniform(0.5, 0.95);
  const double near = rng.uniform(0x1p-10, 0x1p-7);
  for (WindowVertex& q : v) q.z = a * q.w - near;
}

/// Draws with `make` until at least `least` of 256 probes are visible and `accept` agrees.
template <typename Make, typename Accept>
void emit_visible(Batch& b, int least, Make make, Accept accept) {
  Vertices v;
  const std::size_t first = b.rng.position();
  for (int attempt = 0; attempt < 64; ++attempt) {
    const std::size_t begin = b.rng.position();
    v = make();
    if (visible_probes(v, b.width, b.height) < least || !accept(v)) continue;
    b.rng.forget(first, begin);
    break;
  }
  set_camera_depth(b.rng, v);
  turn(b.rng, v);
  b.quads.push_back(v);
}

template <typename Make>
void emit_visible(Batch& b, int least, Make make) {
  emit_visible(b, least, make, [](const Vertices&) { return true; });
}

Points lattice_corners(Batch& b, double size);

// stress_shapes.cpp
void general(Batch& b);
void sliver(Batch& b);
void collapsed_edge(Batch& b);
void straight_corner(Batch& b);
void reflex(Batch& b);
void bowtie(Batch& b);
void tiny(Batch& b);
void long_span(Batch& b);
void coincident(Batch& b);

// stress_lattice.cpp
void near_edge(Batch& b);
void on_edge(Batch& b);
void near_vertex(Batch& b);
void on_vertex(Batch& b);
void shared_edge(Batch& b);
void shared_vertex(Batch& b);
void coplanar(Batch& b);

// stress_eye.cpp
void perspective(Batch& b);
void any_w(Batch& b);
void huge(Batch& b);
void eye_crossing(Batch& b);
void eye_in_hull(Batch& b);
void w_zero(Batch& b);

}  // namespace quadrille::golden::stress
