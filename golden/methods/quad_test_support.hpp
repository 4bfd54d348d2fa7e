// Helpers of the tests of mvc, hybrid, bilinear and projective: quads from screen points, and the fragments of a draw
// by pixel.
#pragma once

#include "golden/methods/method.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace quadrille::golden::methods::test {

using Pixel = std::pair<int, int>;

/// Corners that land at `point` with the given w; window z 0.1, 0.3, 0.7, 0.2.
inline Quad quad_at(const std::array<Vec2, 4>& point, const std::array<double, 4>& w = {1, 1, 1, 1}) {
  constexpr std::array<double, 4> z{0.1, 0.3, 0.7, 0.2};
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {point[i][0] * w[i], point[i][1] * w[i], z[i] * w[i], w[i]};
  return quad;
}

inline std::vector<MethodSample> draw(const Method& method, const Quad& quad, const View& view) {
  std::vector<MethodSample> out;
  method.draw(quad, view, out);
  return out;
}

/// The fragments by pixel; a pixel that occurs twice is a failure.
inline std::map<Pixel, MethodSample> by_pixel(const Method& method, const Quad& quad, const View& view) {
  std::map<Pixel, MethodSample> out;
  for (const MethodSample& sample : draw(method, quad, view)) {
    EXPECT_TRUE(out.emplace(Pixel{sample.x, sample.y}, sample).second)
        << "pixel " << sample.x << ", " << sample.y << " occurs twice";
  }
  return out;
}

inline double largest_difference(std::span<const double> a, std::span<const double> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Twice the signed area of a triangle.
inline double area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// sum(lambda V) = (x, y, 1) sum(lambda w) at the pixel's centre: perspective weights show the point of the quad that
/// lies behind the pixel (eq. 9 of Hormann & Tarini). Returns the distance in pixels.
inline double distance_from_pixel(const Quad& quad, const MethodSample& sample) {
  double x = 0, y = 0, w = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    x += sample.lambda[i] * quad.vertex[i].x;
    y += sample.lambda[i] * quad.vertex[i].y;
    w += sample.lambda[i] * quad.vertex[i].w;
  }
  return std::hypot(x / w - (sample.x + 0.5), y / w - (sample.y + 0.5));
}

}  // namespace quadrille::golden::methods::test
