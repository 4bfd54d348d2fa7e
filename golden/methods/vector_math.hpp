// Differences, products and lengths of points in any dimension.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace quadrille::golden::methods {

template <std::size_t N>
std::array<double, N> difference(const std::array<double, N>& a, const std::array<double, N>& b) {
  std::array<double, N> d{};
  for (std::size_t i = 0; i < N; ++i) d[i] = a[i] - b[i];
  return d;
}

template <std::size_t N>
double dot(const std::array<double, N>& a, const std::array<double, N>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

template <std::size_t N>
double length(const std::array<double, N>& a) {
  return std::sqrt(dot(a, a));
}

inline std::array<double, 3> cross_product(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Largest distance between two corners.
template <class Point>
double extent(const std::array<Point, 4>& p) {
  double size = 0;
  for (std::size_t i = 1; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) size = std::fmax(size, length(difference(p[i], p[j])));
  return size;
}

/// Normal of the largest triangle of three corners, its length twice the area: the plane of a quad that is known best,
/// whether the quad is concave, crosses itself or has a collapsed edge. 0 if all corners are on one line.
inline std::array<double, 3> largest_normal(const std::array<std::array<double, 3>, 4>& p) {
  std::array<double, 3> largest{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = p[i], &b = p[(i + 1) % 4], &c = p[(i + 2) % 4];
    const auto normal = cross_product(difference(b, a), difference(c, a));
    if (dot(normal, normal) > dot(largest, largest)) largest = normal;
  }
  return largest;
}

/// How far a corner is off the plane of the other three, of the largest triangle, as a fraction of the quad's extent.
inline double off_plane(const std::array<std::array<double, 3>, 4>& p) {
  const auto normal = largest_normal(p);
  const double scale = length(normal) * extent(p);
  if (scale == 0) return 0;
  // Six times the volume of the corners' tetrahedron, by whichever corner.
  const auto volume = dot(cross_product(difference(p[1], p[0]), difference(p[2], p[0])), difference(p[3], p[0]));
  return std::abs(volume) / scale;
}

}  // namespace quadrille::golden::methods
