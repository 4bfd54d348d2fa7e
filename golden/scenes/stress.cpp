#include "golden/scenes/stress.hpp"

#include "golden/scenes/recorded_numbers.hpp"
#include "golden/scenes/simple_engine.hpp"
#include "golden/scenes/window_point.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace quadrille::golden {
namespace {

using Points = std::array<WindowPoint, 4>;
using Weights = std::array<double, 4>;
using Numbers = RecordedNumbers;
using Vertices = std::array<WindowVertex, 4>;

constexpr Weights ones{1, 1, 1, 1};

/// Steps between pixel centres along which an edge meets many of them.
constexpr std::array<WindowPoint, 12> lattice_steps{
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

WindowPoint random_point(Numbers& rng, double x0, double y0, double x1, double y1) {
  const double x = rng.uniform(x0, x1);
  const double y = rng.uniform(y0, y1);
  return {x, y};
}

/// A place for something of this size, inside the viewport where it fits.
WindowPoint place(Batch& b, double size) {
  const double mx = std::min(size, b.width * 1.0) / 2, my = std::min(size, b.height * 1.0) / 2;
  return random_point(b.rng, mx, my, b.width - mx, b.height - my);
}

WindowPoint centre_of_pixel(WindowPoint p) { return {std::floor(p.x) + 0.5, std::floor(p.y) + 0.5}; }

Points random_corners(Batch& b, WindowPoint centre, double size) {
  Points p;
  for (WindowPoint& q : p)
    q = random_point(b.rng, centre.x - size / 2, centre.y - size / 2, centre.x + size / 2, centre.y + size / 2);
  return p;
}

/// An angle's direction without sine: a point of the square's outline, normalised.
WindowPoint random_direction(Numbers& rng) {
  const double s = rng.uniform(-1, 1);
  const WindowPoint p = rng.chance(0.5) ? WindowPoint{s, rng.sign()} : WindowPoint{rng.sign(), s};
  return 1 / std::sqrt(p.x * p.x + p.y * p.y) * p;
}

/// Powers of two, so that x·w is exact and x·w/w is x again.
Weights exact_weights(Numbers& rng) {
  Weights w = ones;
  if (rng.chance(0.5)) {
    for (double& v : w) v = std::ldexp(1.0, static_cast<int>(rng.integer(-2, 2)));
  }
  return w;
}

/// Which corner comes first and which way round it goes is never the generator's.
void turn(Numbers& rng, Vertices& v) {
  std::rotate(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(rng.below(4)), v.end());
  if (rng.chance(0.5)) std::reverse(v.begin(), v.end());
}

/// A vertex of a family in front of the eye, at a window depth of its own.
WindowVertex ordinary(Numbers& rng, WindowPoint p, double w) {
  return {p.x * w, p.y * w, rng.uniform(0.1, 0.9) * w, w};
}

void emit(Batch& b, const Points& p, const Weights& w = ones) {
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
void set_camera_depth(Numbers& rng, Vertices& v) {
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

double det(const WindowVertex& a, const WindowVertex& b, const WindowVertex& c) {
  return a.x * (b.y * c.w - b.w * c.y) - a.y * (b.x * c.w - b.w * c.x) + a.w * (b.x * c.y - b.y * c.x);
}

/// The origin (the eye) inside the tetrahedron: one sign of d123, −d023, d013, −d012.
bool holds_eye(const Vertices& v) {
  const std::array<double, 4> d{det(v[1], v[2], v[3]), -det(v[0], v[2], v[3]), det(v[0], v[1], v[3]),
                                -det(v[0], v[1], v[2])};
  return std::all_of(d.begin(), d.end(), [](double x) { return x > 0; }) ||
         std::all_of(d.begin(), d.end(), [](double x) { return x < 0; });
}

// ---- one generator per family; each adds one quad or a small group ----

void general(Batch& b) {
  const double size = b.extent() * b.knob * b.rng.log2_spread(-6, -0.5);
  const WindowPoint centre = place(b, size);
  emit(b, random_corners(b, centre, size));
}

void perspective(Batch& b) {
  const double size = b.extent() * b.rng.log2_spread(-4, -0.25);
  const WindowPoint centre = place(b, size);
  const Points p = random_corners(b, centre, size);
  const double ratio_log2 = std::min(6.643856 * b.knob, 40.0);  // log2 of 100
  Weights w;
  for (double& v : w) v = b.rng.log2_spread(0, ratio_log2);
  const std::size_t nearest = b.rng.below(4);
  w[nearest] = 1;
  w[(nearest + 1 + b.rng.below(3)) & 3] =
      std::ldexp(1.0 + (ratio_log2 - std::floor(ratio_log2)), static_cast<int>(ratio_log2));
  emit(b, p, w);
}

/// A vertex with the given w that projects near the viewport; with w = 0 a direction of that order.
WindowVertex anywhere(Batch& b, double w, double reach) {
  const WindowPoint p =
      random_point(b.rng, -reach * b.width, -reach * b.height, (1 + reach) * b.width, (1 + reach) * b.height);
  if (w != 0) return {p.x * w, p.y * w, 0, w};
  const double length = b.extent() * b.rng.log2_spread(-2, 2);
  const WindowPoint d = length * random_direction(b.rng);
  return {d.x, d.y, 0, 0};
}

/// |w| within this many octaves of 1, whatever the knob.
constexpr double most_octaves = 30;

double magnitude(Numbers& rng, double octaves) {
  const double limit = std::min(octaves, most_octaves);
  return rng.log2_spread(-limit, limit);
}

double any_sign(Numbers& rng, double octaves) {
  const double s = rng.sign();
  return s * magnitude(rng, octaves);
}

void any_w(Batch& b) {
  emit_visible(b, 3, [&] {
    Vertices v;
    for (WindowVertex& q : v) {
      const double w = b.rng.chance(0.125) ? 0.0 : any_sign(b.rng, 3 * b.knob);
      q = anywhere(b, w, 0.5);
    }
    return v;
  });
}

/// Three lattice edges of a polygon whose corners are pixel centres; the fourth edge closes it.
Points lattice_polygon(Batch& b) {
  const double reach = std::max(4.0, b.extent() / 12);
  const auto step = [&] {
    const WindowPoint direction = lattice_steps[b.rng.below(lattice_steps.size())];
    return static_cast<double>(b.rng.integer(2, static_cast<std::int64_t>(reach))) * direction;
  };
  Points p;
  const WindowPoint a = step(), c = step();
  p[0] = centre_of_pixel(place(b, 3 * reach));
  p[1] = p[0] + a;
  p[2] = p[1] + c;
  p[3] = b.rng.chance(0.5) ? p[2] - a : p[2] + step();
  return p;
}

/// Edges along x + y and x − y through pixel centres whose corners may lie between them.
Points lattice_diamond(Batch& b) {
  const std::int64_t reach = static_cast<std::int64_t>(std::max(6.0, b.extent() / 6));
  const WindowPoint o = centre_of_pixel(place(b, static_cast<double>(reach)));
  const double k = static_cast<double>(b.rng.integer(3, reach));
  const double m = static_cast<double>(b.rng.integer(3, reach));
  const double shift = b.rng.chance(0.5) ? 0.5 : 0.0;
  const WindowPoint c{o.x + shift, o.y + shift};
  return {{c, {c.x + k / 2, c.y + k / 2}, {c.x + k / 2 - m / 2, c.y + k / 2 + m / 2}, {c.x - m / 2, c.y + m / 2}}};
}

/// Two opposite edges along a row (or column) of pixel centres, corners at a quarter pixel.
Points lattice_trapezoid(Batch& b) {
  const double reach = std::max(8.0, b.extent() / 4);
  const WindowPoint o = centre_of_pixel(place(b, reach));
  const double depth = static_cast<double>(b.rng.integer(2, static_cast<std::int64_t>(reach)));
  const auto quarter = [&](double lo, double hi) { return std::floor(b.rng.uniform(lo, hi)) + 0.25; };
  Points p;
  p[0] = {o.x + quarter(-reach / 2, -1), o.y};
  p[1] = {o.x + quarter(1, reach / 2), o.y};
  p[2] = {o.x + quarter(1, reach / 2), o.y + depth};
  p[3] = {o.x + quarter(-reach / 2, -1), o.y + depth};
  if (b.rng.chance(0.5)) {
    for (WindowPoint& q : p) q = o + WindowPoint{q.y - o.y, q.x - o.x};
  }
  return p;
}

Points lattice_quad(Batch& b) {
  switch (b.rng.below(3)) {
    case 0:
      return lattice_polygon(b);
    case 1:
      return lattice_diamond(b);
    default:
      return lattice_trapezoid(b);
  }
}

void near_edge(Batch& b) {
  Points p = lattice_quad(b);
  const double reach = b.knob * 0x1p-4 * 0.7;  // in each axis, so that the distance stays below knob/16 px
  for (WindowPoint& q : p) q = q + random_point(b.rng, -reach, -reach, reach, reach);
  emit(b, p, exact_weights(b.rng));
}

void on_edge(Batch& b) {
  const Points p = lattice_quad(b);
  emit(b, p, exact_weights(b.rng));
}

/// Distinct corners at pixel centres within a square.
Points lattice_corners(Batch& b, double size) {
  const std::int64_t n = std::max<std::int64_t>(2, static_cast<std::int64_t>(size));
  const WindowPoint o = centre_of_pixel(place(b, size));
  Points p;
  for (std::size_t i = 0; i < 4; ++i) {
    bool fresh = false;
    while (!fresh) {
      const double x = static_cast<double>(b.rng.integer(-n / 2, n / 2)),
                   y = static_cast<double>(b.rng.integer(-n / 2, n / 2));
      p[i] = o + WindowPoint{x, y};
      fresh = std::none_of(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(i),
                           [&](WindowPoint q) { return q.x == p[i].x && q.y == p[i].y; });
    }
  }
  return p;
}

void near_vertex(Batch& b) {
  Points p = lattice_corners(b, b.rng.log2_spread(2, 5));
  for (WindowPoint& q : p) {
    const WindowPoint direction = random_direction(b.rng);
    q = q + std::min(1.0, b.knob * b.rng.log2_spread(-9, -1)) * direction;
  }
  emit(b, p, exact_weights(b.rng));
}

void on_vertex(Batch& b) {
  const double size = b.knob * b.rng.log2_spread(2, 5);
  const Points p = lattice_corners(b, std::min(size, b.extent()));
  emit(b, p, exact_weights(b.rng));
}

void sliver(Batch& b) {
  const double length = b.extent() * b.rng.log2_spread(-4, -0.25);
  const double thickness = b.knob * b.rng.log2_spread(-6, 0);
  const WindowPoint o = place(b, length), along = random_direction(b.rng);
  const WindowPoint across{-along.y, along.x};
  const auto corner = [&](double s) {
    const double jitter = b.rng.uniform(-0.1, 0.1);
    const double off = b.rng.uniform(0, 0.5);
    return o + length * (s + jitter) * along + (s > 0 ? thickness * off : -thickness * off) * across;
  };
  const WindowPoint p0 = corner(-0.4), p2 = corner(0.4);
  const double side = b.rng.uniform(0.5, 1);
  Points p{{p0, p0 + length * 0.8 * along - thickness * side * across, p2, p2 - length * 0.8 * along}};
  if (b.rng.chance(0.25)) p[3] = p[0] + length * 0x1p-5 * along;  // nearly a triangle
  emit(b, p);
}

void collapsed_edge(Batch& b) {
  const double size = b.extent() * b.rng.log2_spread(-5, -1);
  const bool lattice = b.rng.chance(0.25);
  Points p = lattice ? lattice_corners(b, size) : random_corners(b, place(b, size), size);
  Weights w = exact_weights(b.rng);
  p[1] = p[0];
  w[1] = w[0];
  if (b.rng.chance(0.25)) {  // not quite collapsed: an edge of at most knob px
    const double length = b.knob * b.rng.log2_spread(-8, 0);
    p[1] = p[0] + length * random_direction(b.rng);
  }
  emit(b, p, w);
}

void straight_corner(Batch& b) {
  const double size = b.extent() * b.rng.log2_spread(-5, -1);
  const WindowPoint o = place(b, size);
  Points p;
  const auto even = [&] {  // a multiple of 1/32 px, so that points at eighths of an edge are on the 1/256 px grid
    const WindowPoint q = random_point(b.rng, -size / 2, -size / 2, size / 2, size / 2);
    return WindowPoint{std::floor((o.x + q.x) * 32) / 32, std::floor((o.y + q.y) * 32) / 32};
  };
  p[0] = even();
  p[2] = even();
  p[3] = even();
  // Between its neighbours (180 degrees) or beyond one of them (a spike of 0 degrees).
  const double eighths =
      b.rng.chance(0.75) ? static_cast<double>(b.rng.integer(1, 7)) : static_cast<double>(b.rng.integer(9, 12));
  p[1] = p[0] + eighths / 8 * (p[2] - p[0]);
  if (b.rng.chance(0.5)) {
    const double reach = b.knob * 0x1p-8;
    p[1] = p[1] + random_point(b.rng, -reach, -reach, reach, reach);
  }
  emit(b, p);
}

/// The tip of a notch near a pixel centre: corner 0 is reflex, its neighbours lie close to each other's direction.
void reflex(Batch& b) {
  const double length = std::min(b.extent() / 2, b.rng.log2_spread(3, 7));
  const double width = std::min(length, b.knob * b.rng.log2_spread(-2, 4));
  const double behind = b.rng.log2_spread(0, 5);
  const double skew = b.rng.uniform(0.4, 1.6);
  const WindowPoint tip = place(b, 2 * length), along = random_direction(b.rng);
  const WindowPoint across{-along.y, along.x};
  Points p;
  p[0] = centre_of_pixel(tip) + random_point(b.rng, -0.5, -0.5, 0.5, 0.5);
  p[1] = p[0] + length * along + width / 2 * across;
  p[2] = p[0] - behind * along;
  p[3] = p[0] + length * skew * along - width / 2 * across;
  emit(b, p);
}

void bowtie(Batch& b) {
  const double size = b.extent() * b.rng.log2_spread(-5, -1.5);
  Points p;
  const bool exact = b.rng.chance(0.5);
  const WindowPoint c = exact ? centre_of_pixel(place(b, 2 * size)) : place(b, 2 * size);
  const auto arm = [&] {
    WindowPoint d = random_point(b.rng, -size / 2, -size / 2, size / 2, size / 2);
    // Exactly crossing: arms of whole pixels and a ratio that is a power of two.
    if (exact) d = {2 * std::floor(d.x / 2 + 0.5) + (std::abs(d.x) < 1 ? 2 : 0), 2 * std::floor(d.y / 2 + 0.5)};
    return d;
  };
  const auto ratio = [&] {
    return exact ? std::ldexp(1.0, static_cast<int>(b.rng.integer(-1, 1))) : b.rng.uniform(0.25, 2);
  };
  WindowPoint a = arm(), d = arm();
  const double area = a.x * d.y - a.y * d.x;
  if (area == 0) d = {-a.y, a.x};
  const double s = ratio(), t = ratio();
  p = {{c + a, c - s * a, c + d, c - t * d}};
  if (exact) {
    emit(b, p, exact_weights(b.rng));
  } else {
    emit(b, p);
  }
}

void tiny(Batch& b) {
  const double size = b.knob * b.rng.uniform(0.5, 4);
  const WindowPoint centre = place(b, size);
  Points p = random_corners(b, centre, size);
  if (b.rng.chance(0.6)) {  // one corner in each quarter of the square, so that more of them cover a pixel
    for (std::size_t i = 0; i < 4; ++i) {
      const double sx = i == 1 || i == 2 ? 1 : -1, sy = i >= 2 ? 1 : -1;
      p[i] = {centre.x + sx * std::abs(p[i].x - centre.x), centre.y + sy * std::abs(p[i].y - centre.y)};
    }
  }
  emit(b, p, exact_weights(b.rng));
}

void huge(Batch& b) {
  emit_visible(b, 3, [&] {
    const WindowPoint target = place(b, 0);
    Vertices v;
    const std::size_t farthest = b.rng.below(4);
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowPoint direction = random_direction(b.rng);
      const double distance = i == farthest ? b.knob * b.rng.log2_spread(17, 24) : b.rng.log2_spread(6, 20);
      const WindowPoint p = target + distance * direction;
      v[i] = {p.x, p.y, 0, 1};
    }
    return v;
  });
}

void eye_crossing(Batch& b) {
  emit_visible(
      b, 8,
      [&] {
        Vertices v;
        const std::uint64_t behind = 1 + b.rng.below(14);  // some behind, some in front
        for (std::size_t i = 0; i < 4; ++i) {
          const double w = magnitude(b.rng, 2 * b.knob);
          v[i] = anywhere(b, (behind >> i & 1) != 0 ? -w : w, 0.3);
        }
        return v;
      },
      [](const Vertices& v) { return !holds_eye(v); });
}

/// V3 = −(a V0 + b V1 + c V2) with positive a, b, c puts the origin inside the tetrahedron.
void eye_in_hull(Batch& b) {
  emit_visible(
      b, 8,
      [&] {
        Vertices v;
        WindowVertex sum{0, 0, 0, 0};
        for (std::size_t i = 0; i < 3; ++i) {
          v[i] = anywhere(b, any_sign(b.rng, b.knob), 0.5);
          const double share = b.rng.uniform(0.25, 1);
          sum.x += share * v[i].x;
          sum.y += share * v[i].y;
          sum.w += share * v[i].w;
        }
        v[3] = {-sum.x, -sum.y, 0, -sum.w};
        std::swap(v[3], v[b.rng.below(4)]);
        return v;
      },
      holds_eye);
}

void w_zero(Batch& b) {
  emit_visible(b, 3, [&] {
    Vertices v;
    const std::size_t first = b.rng.below(4);
    const std::size_t second = b.rng.chance(0.3) ? b.rng.below(4) : first;
    for (std::size_t i = 0; i < 4; ++i) {
      double w = i == first || i == second ? 0.0 : magnitude(b.rng, 2 * b.knob);
      if (w != 0 && b.rng.chance(0.25)) w = -w;
      v[i] = anywhere(b, w, 0.3);
    }
    return v;
  });
}

void push_turned(Batch& b, Vertices v) {
  turn(b.rng, v);
  if (!b.full()) b.quads.push_back(v);
}

/// A strip: two rows of shared vertices, quads between them; every second strip has its vertices at pixel centres.
void shared_edge(Batch& b) {
  const bool lattice = b.rng.chance(0.5);
  const int cells = static_cast<int>(b.rng.integer(3, 10));
  const double step = std::min(b.extent() / (cells + 1), b.knob * b.rng.log2_spread(2, 5));
  const WindowPoint o = place(b, step * cells);
  std::array<std::vector<WindowVertex>, 2> rows;
  const bool turned = b.rng.chance(0.5);
  const double lean = b.rng.uniform(-0.5, 0.5);
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j < 2; ++j) {
      const WindowPoint jitter = random_point(b.rng, -0.4, -0.4, 0.4, 0.4);
      WindowPoint p{step * (i - cells / 2.0 + jitter.x), step * (j - 0.5 + jitter.y * 0.8) + lean * step * i};
      p = o + (turned ? WindowPoint{p.y, p.x} : p);
      p = lattice ? centre_of_pixel(p) : snap256(p);
      const double w = std::ldexp(1.0, static_cast<int>(b.rng.integer(-1, 1)));
      rows[static_cast<std::size_t>(j)].push_back(ordinary(b.rng, p, w));
    }
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(cells); ++i) {
    push_turned(b, {{rows[0][i], rows[0][i + 1], rows[1][i + 1], rows[1][i]}});
  }
}

/// A fan of quads around one vertex, which is at a pixel centre every second time.
void shared_vertex(Batch& b) {
  const int spokes = 2 * static_cast<int>(b.rng.integer(3, 8));
  const double radius = std::min(b.extent() / 2, b.knob * b.rng.log2_spread(2, 6));
  const WindowPoint o = place(b, 2 * radius);
  const WindowPoint c = b.rng.chance(0.5) ? centre_of_pixel(o) : snap256(o);
  const WindowVertex hub = ordinary(b.rng, c, std::ldexp(1.0, static_cast<int>(b.rng.integer(-1, 1))));
  std::vector<WindowVertex> ring;
  for (int i = 0; i < spokes; ++i) {
    // Once around the outline of a square, in order.
    const double s = 8.0 * (i + b.rng.uniform(0.1, 0.9)) / spokes;
    const int side = static_cast<int>(s / 2);
    const double f = s - 2 * side - 1;
    const std::array<WindowPoint, 4> outline{{{f, -1}, {1, f}, {-f, 1}, {-1, -f}}};
    const double reach = radius * b.rng.uniform(0.4, 1);
    const WindowPoint p = snap256(c + reach * outline[static_cast<std::size_t>(side)]);
    const double w = std::ldexp(1.0, static_cast<int>(b.rng.integer(-1, 1)));
    ring.push_back(ordinary(b.rng, p, w));
  }
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; i += 2) push_turned(b, {{hub, ring[i], ring[i + 1], ring[(i + 2) % n]}});
}

/// All corners on one screen line, with w of one sign or of both: the quad's plane holds the eye.
void coplanar(Batch& b) {
  const double size = b.extent() / 2;
  const WindowPoint o = centre_of_pixel(place(b, size));
  const WindowPoint direction = lattice_steps[b.rng.below(lattice_steps.size())];
  Vertices v;
  const bool mixed = b.rng.chance(0.33), bent = b.rng.chance(0.5);
  for (WindowVertex& q : v) {
    const double along = std::floor(b.rng.uniform(-size / 4, size / 4) * 32) / 32;
    WindowPoint p = o + along * direction;  // exact, so that the four points are exactly collinear
    if (bent) {
      const double reach = b.knob * 0x1p-8;
      p = p + random_point(b.rng, -reach, -reach, reach, reach);
    }
    double w = std::ldexp(1.0, static_cast<int>(b.rng.integer(-1, 1)));
    if (mixed && b.rng.chance(0.5)) w = -w;
    q = {p.x * w, p.y * w, 0, w};
  }
  const double depth = b.rng.uniform(0.1, 0.9);  // one depth everywhere: pixels are close to the eye plane
  for (WindowVertex& q : v) q.z = depth * q.w;
  turn(b.rng, v);
  b.quads.push_back(v);
}

/// From beyond one side of the viewport to beyond the other, often thin.
void long_span(Batch& b) {
  const bool vertical = b.rng.chance(0.25);
  const double along = vertical ? b.height : b.width, across = vertical ? b.width : b.height;
  const double margin = b.rng.uniform(0, 0.25) * along;
  const double thickness = std::min(across, b.knob * b.rng.log2_spread(-1, 6));
  const double left = b.rng.uniform(0, across);
  const double right = b.rng.chance(0.5) ? b.rng.uniform(0, across) : left;
  const double taper = b.rng.uniform(0.25, 1);
  Points p{{{-margin, left},
            {along + margin, right},
            {along + margin, right + thickness * taper},
            {-margin, left + thickness}}};
  for (WindowPoint& q : p) q = vertical ? WindowPoint{q.y, q.x} : q;
  Weights w = ones;
  if (b.rng.chance(0.5)) {
    w[0] = w[3] = b.rng.log2_spread(-3, 3);
    w[1] = w[2] = b.rng.log2_spread(-3, 3);
  }
  emit(b, p, w);
}

void coincident(Batch& b) {
  const double size = b.extent() * b.rng.log2_spread(-5, -1);
  const bool lattice = b.rng.chance(0.5);
  Points p = lattice ? lattice_corners(b, size) : random_corners(b, place(b, size), size);
  Weights w = exact_weights(b.rng);
  const auto same = [&](std::size_t i, std::size_t j) {
    p[i] = p[j];
    w[i] = w[j];
  };
  switch (b.rng.below(8)) {
    case 0:
    case 1:
    case 2:
      same(1, 0);
      break;  // a triangle
    case 3:
    case 4:
      same(2, 0);
      break;  // opposite corners: two needles back to back
    case 5:
      same(1, 0), same(3, 2);
      break;  // an edge drawn there and back
    case 6:
      same(1, 0), same(2, 0);
      break;  // three at one place
    default:
      same(1, 0), same(2, 0), same(3, 0);
      break;  // a point
  }
  emit(b, p, w);
}

struct Generator {
  StressFamilyInfo info;
  void (*make)(Batch&);
};

constexpr std::array<Generator, 22> generators{{
    {{StressFamily::general, "general", "four random corners, any shape, w = 1: the common case", "size"}, general},
    {{StressFamily::perspective, "perspective", "w ratio 100 between two corners: k spreads over the sums",
      "exponent of the ratio 100"},
     perspective},
    {{StressFamily::any_w, "any_w",
      "w of any sign and magnitude, one in eight zero: homogeneous edge functions, visibility", "octaves of |w|"},
     any_w},
    {{StressFamily::near_edge, "near_edge", "edges within 1/16 px of the pixel centres along them: cancellation in A",
      "distance"},
     near_edge},
    {{StressFamily::on_edge, "on_edge", "edges exactly through pixel centres, corners there or not: ties, A = 0",
      "nothing"},
     on_edge},
    {{StressFamily::near_vertex, "near_vertex", "corners 2^-9 to 1 px from pixel centres on small quads: R close to 0",
      "distance"},
     near_vertex},
    {{StressFamily::on_vertex, "on_vertex",
      "corners exactly at pixel centres: R = 0, ties on two edges and the diagonal", "size"},
     on_vertex},
    {{StressFamily::sliver, "sliver", "long quads 1/64 to 1 px thick: all A small together", "thickness"}, sliver},
    {{StressFamily::collapsed_edge, "collapsed_edge",
      "two neighbouring corners equal, a quarter at most 1 px apart: t = 0 or tiny", "length of the short edges"},
     collapsed_edge},
    {{StressFamily::straight_corner, "straight_corner",
      "a corner on its neighbours' line, exactly or by 1/256 px: 180 or 0 degrees", "offset"},
     straight_corner},
    {{StressFamily::reflex, "reflex",
      "notches of 1/4 to 16 px with the tip near a pixel centre: t of both signs cancel", "width"},
     reflex},
    {{StressFamily::bowtie, "bowtie",
      "crossed quads, half with the crossing exactly at a pixel centre: two edges at once", "nothing"},
     bowtie},
    {{StressFamily::tiny, "tiny", "quads under 4 px: few bits in every difference", "size"}, tiny},
    {{StressFamily::huge, "huge", "corners 2^17 to 2^24 px away, beyond any guard band, with visible pixels",
      "distance"},
     huge},
    {{StressFamily::eye_crossing, "eye_crossing",
      "one to three corners behind the eye, visible, the eye outside their hull", "octaves of |w|"},
     eye_crossing},
    {{StressFamily::eye_in_hull, "eye_in_hull",
      "the eye inside the tetrahedron of the corners: visibility pixel by pixel", "octaves of |w|"},
     eye_in_hull},
    {{StressFamily::w_zero, "w_zero", "one or two corners with w = 0 exactly: points at infinity", "octaves of |w|"},
     w_zero},
    {{StressFamily::shared_edge, "shared_edge", "strips of quads with common edges, any winding: gaps and doubles",
      "cell size"},
     shared_edge},
    {{StressFamily::shared_vertex, "shared_vertex",
      "fans of quads around one vertex, often at a pixel centre: gaps and doubles", "radius"},
     shared_vertex},
    {{StressFamily::coplanar, "coplanar",
      "all corners on one screen line, seen edge-on, exactly or by 1/256 px: zero areas", "offset"},
     coplanar},
    {{StressFamily::long_span, "long_span",
      "from side to side of the viewport, often thin: forward differences over long spans", "thickness"},
     long_span},
    {{StressFamily::coincident, "coincident",
      "two, three or four equal corners, neighbours or opposite: edges without a sign", "nothing"},
     coincident},
}};

constexpr auto infos = [] {
  std::array<StressFamilyInfo, generators.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = generators[i].info;
  return all;
}();

}  // namespace

std::span<const StressFamilyInfo> stress_families() { return infos; }

std::string_view stress_family_name(StressFamily family) { return infos[static_cast<std::size_t>(family)].name; }

StressFamily parse_stress_family(std::string_view name) {
  std::string all;
  for (const StressFamilyInfo& info : infos) {
    if (info.name == name) return info.family;
    all += ' ';
    all += info.name;
  }
  throw std::invalid_argument("no stress family '" + std::string(name) + "'; families:" + all);
}

namespace {

void check_arguments(double knob, int width, int height) {
  if (!(knob >= 0x1p-6 && knob <= 0x1p6)) throw std::invalid_argument("stress: the knob lies between 1/64 and 64");
  if (width < 1 || height < 1 || width > 32768 || height > 32768) {
    throw std::invalid_argument("stress: size " + std::to_string(width) + "x" + std::to_string(height) +
                                " (1x1 to 32768x32768)");
  }
}

/// Window depths of a spread of 2^-1 to 2^-24 of what it was, about that of a corner in front of the eye.
void draw_depths_together(Prng& rng, Vertices& v) {
  const double part = std::ldexp(1.0, static_cast<int>(rng.integer(-24, -1)));
  const auto first = std::ranges::find_if(v, [](const WindowVertex& q) { return q.w > 0; });
  if (first == v.end()) return;
  const double depth = first->z / first->w;
  for (WindowVertex& q : v) q.z = depth * q.w + part * (q.z - depth * q.w);
}

/// Slots 0 to 3 hold the weights. Of the others even ones hold any numbers, odd ones a number far from 0 and others of
/// a spread of 2^-1 to 2^-24 of it.
void add_attribute(Prng& rng, std::size_t slot, WindowQuad& quad) {
  const bool together = slot >= 4 && slot % 2 == 1;
  const double base = together ? rng.sign() * rng.uniform(0.75, 1) : 0;
  const double part = together ? std::ldexp(1.0, static_cast<int>(rng.integer(-24, -1))) : 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double weight = slot == i ? 1 : 0;
    quad.attribute[i].push_back(slot < 4 ? weight : together ? base * (1 - part * rng.uniform()) : rng.uniform(-1, 1));
  }
}

}  // namespace

std::vector<WindowQuad> make_stress(StressFamily family, std::size_t count, std::uint64_t seed, double knob, int width,
                                    int height, int attributes) {
  check_arguments(knob, width, height);
  if (attributes < 0 || attributes > max_attribute_slots) {
    throw std::invalid_argument("stress: " + std::to_string(attributes) + " attributes (0 to " +
                                std::to_string(max_attribute_slots) + ")");
  }
  const std::size_t index = static_cast<std::size_t>(family);
  const std::uint64_t own_seed =
      Prng(seed ^ ((index + 1) * 0xd1342543de82ef95u)).next();  // one sequence per family and seed
  Batch batch{Numbers(own_seed), knob, width, height, count};
  batch.quads.reserve(count);
  while (!batch.full()) generators[index].make(batch);

  Prng attribute_rng(~own_seed), depth_rng(~own_seed, 1);
  const bool shares_corners = family == StressFamily::shared_edge || family == StressFamily::shared_vertex;
  std::vector<WindowQuad> quads(count);
  for (std::size_t q = 0; q < count; ++q) {
    quads[q].id = static_cast<std::uint32_t>(q);
    quads[q].vertex = batch.quads[q];
    if (q % 4 == 3 && !shares_corners) draw_depths_together(depth_rng, quads[q].vertex);
    for (std::size_t a = 0; a < static_cast<std::size_t>(attributes); ++a) add_attribute(attribute_rng, a, quads[q]);
  }
  return quads;
}

WindowQuad draw_stress(StressFamily family, StressDrawing& drawing, int width, int height) {
  check_arguments(drawing.knob, width, height);
  Batch batch{Numbers(drawing.seed, std::move(drawing.words)), drawing.knob, width, height, SIZE_MAX};
  generators[static_cast<std::size_t>(family)].make(batch);
  drawing.words = batch.rng.take_words();
  WindowQuad quad;
  quad.vertex = batch.quads[drawing.member % batch.quads.size()];
  return quad;
}

std::vector<WindowQuad> make_stress_without_weights(StressFamily family, std::size_t count, std::uint64_t seed,
                                                    int width, int height, int attributes, double knob) {
  constexpr int weights = 4;
  std::vector<WindowQuad> quads = make_stress(family, count, seed, knob, width, height, weights + attributes);
  for (WindowQuad& quad : quads)
    for (std::vector<double>& attribute : quad.attribute)
      attribute.erase(attribute.begin(), attribute.begin() + weights);
  return quads;
}

}  // namespace quadrille::golden
