// What the tests of triangle share.
#pragma once

#include "model/support/prng.hpp"

#include <cmath>
#include <map>
#include <vector>

namespace quadrille::golden::methods {
namespace {

using integer_triangle::EdgeEquation;
using integer_triangle::FloatPoint;
using integer_triangle::PlaneEquation;
using integer_triangle::Point;
using integer_triangle::Triangle;
using Corners = std::array<Point, 3>;
using Pixel = std::pair<int, int>;

constexpr int view_size = 128;

/// Vertices in units of 2^-fraction pixel, fraction <= 16, and their edge functions in exact integers (units
/// 2^-2 fraction), whichever way the vertices turn.
struct ExactTriangle {
  int fraction = 8;
  std::array<std::int64_t, 3> x{}, y{};

  Corners corners() const {
    Corners out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = {std::ldexp(x[i], -fraction), std::ldexp(y[i], -fraction)};
    return out;
  }
  std::int64_t area() const { return (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]); }
  /// Of edge i to i + 1: the cross product of the edge with the way from its first vertex to the pixel, positive
  /// inside.
  std::int64_t edge(std::size_t i, int px, int py) const {
    const std::size_t j = (i + 1) % 3;
    const std::int64_t unit = 1 << fraction;
    const std::int64_t e = (x[j] - x[i]) * (py * unit - y[i]) - (y[j] - y[i]) * (px * unit - x[i]);
    return area() < 0 ? -e : e;
  }
  bool inside(int px, int py) const {
    return area() != 0 && edge(0, px, py) >= 0 && edge(1, px, py) >= 0 && edge(2, px, py) >= 0;
  }
  double square_pixels(std::int64_t value) const { return std::ldexp(static_cast<double>(value), -2 * fraction); }
};

/// Up to a quarter of the view outside of it on every side; every fourth is small, every fourth thin.
inline ExactTriangle random_triangle(Prng& prng, int fraction = 8) {
  const std::int64_t pixel = 1 << fraction, low = -32 * pixel, high = (view_size + 32) * pixel;
  ExactTriangle t{.fraction = fraction};
  for (std::size_t i = 0; i < 3; ++i) t.x[i] = prng.integer(low, high), t.y[i] = prng.integer(low, high);
  const std::uint64_t kind = prng.below(4);
  if (kind == 0) {
    for (std::size_t i = 1; i < 3; ++i) {
      t.x[i] = t.x[0] + prng.integer(-6 * pixel, 6 * pixel);
      t.y[i] = t.y[0] + prng.integer(-6 * pixel, 6 * pixel);
    }
  } else if (kind == 1) {
    t.x[2] = (t.x[0] + t.x[1]) / 2 + prng.integer(-pixel, pixel);
    t.y[2] = (t.y[0] + t.y[1]) / 2 + prng.integer(-pixel, pixel);
  }
  return t;
}

inline std::map<Pixel, int> count(const std::vector<MethodSample>& samples) {
  std::map<Pixel, int> out;
  for (const MethodSample& s : samples) ++out[{s.x, s.y}];
  return out;
}

}  // namespace
}  // namespace quadrille::golden::methods
