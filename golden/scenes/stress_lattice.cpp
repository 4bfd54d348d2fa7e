// Stress families on the lattice of pixel centres, and those whose quads share corners.
#include "golden/scenes/stress_batch.hpp"

namespace quadrille::golden::stress {
namespace {

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

void push_turned(Batch& b, Vertices v) {
  turn(b.rng, v);
  if (!b.full()) b.quads.push_back(v);
}

}  // namespace

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

}  // namespace quadrille::golden::stress
