// Stress families of shapes: slivers, notches, crossed quads, equal corners.
#include "golden/scenes/stress_batch.hpp"

namespace quadrille::golden::stress {

void general(Batch& b) {
  const double size = b.extent() * b.knob * b.rng.log2_spread(-6, -0.5);
  const WindowPoint centre = place(b, size);
  emit(b, random_corners(b, centre, size));
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

}  // namespace quadrille::golden::stress
