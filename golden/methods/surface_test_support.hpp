// Quads and independent answers for the tests of split, refine, adaptive and affine.
#pragma once

#include "golden/methods/method.hpp"
#include "model/support/float113.hpp"
#include "model/support/prng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace quadrille::golden::methods::test {

using Point = std::array<double, 2>;
using Real = Float113;

inline std::vector<MethodSample> draw(const Method& method, const Quad& quad, const View& view) {
  std::vector<MethodSample> out;
  method.draw(quad, view, out);
  return out;
}

/// Corners at screen positions; object space is the homogeneous window space, texture the unit square.
inline Quad screen_quad(const std::array<Point, 4>& position, const std::array<double, 4>& w = {1, 1, 1, 1}) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i] = {position[i][0] * w[i], position[i][1] * w[i], 0.125 * static_cast<double>(i + 1) * w[i], w[i]};
    quad.object[i] = {quad.vertex[i].x, quad.vertex[i].y, quad.vertex[i].w};
  }
  quad.texture = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::size_t i = 0; i < 4; ++i) quad.attribute[i] = {quad.texture[i][0], quad.texture[i][1]};
  return quad;
}

/// Any shape around a view of `size` pixels; w of either sign if `any_w`.
inline Quad random_quad(Prng& prng, int size, bool any_w) {
  std::array<Point, 4> position{};
  std::array<double, 4> w{};
  for (std::size_t i = 0; i < 4; ++i) {
    position[i] = {prng.uniform(-0.3, 1.3) * size, prng.uniform(-0.3, 1.3) * size};
    w[i] = any_w ? prng.uniform(-1, 1) : prng.log2_spread(-2, 2);
  }
  return screen_quad(position, w);
}

/// m with sum(m_i V_i) = (x, y, 1) by Cramer's rule: the triangle shows at the point where no m_i is negative, m_i
/// divided by their sum are barycentric coordinates in space, m_i w_i those on the screen (H&T equation 11 backwards).
struct CramerSolution {
  std::array<Real, 3> m{};
  Real determinant = 0;
};

inline CramerSolution cramer(const std::array<WindowVertex, 3>& v, Real x, Real y) {
  const auto det = [](const std::array<Real, 3>& a, const std::array<Real, 3>& b, const std::array<Real, 3>& c) {
    return a[0] * b[1] * c[2] + b[0] * c[1] * a[2] + c[0] * a[1] * b[2] - c[0] * b[1] * a[2] - a[0] * c[1] * b[2] -
           b[0] * a[1] * c[2];
  };
  const auto column = [&](std::size_t i) { return std::array<Real, 3>{v[i].x, v[i].y, v[i].w}; };
  const std::array<Real, 3> a = column(0), b = column(1), c = column(2), p{x, y, 1};
  const Real whole = det(a, b, c);
  return {{det(p, b, c) / whole, det(a, p, c) / whole, det(a, b, p) / whole}, whole};
}

/// (s, t) of the bilinear surface at a screen point by Newton's method on x̃(s, t) = x w(s, t), ỹ(s, t) = y w(s, t).
inline std::optional<std::array<Real, 2>> inverse_bilinear(const Quad& quad, Real x, Real y) {
  const auto& v = quad.vertex;
  std::array<Real, 4> f{}, g{};
  for (std::size_t i = 0; i < 4; ++i) {
    f[i] = v[i].x - x * v[i].w;
    g[i] = v[i].y - y * v[i].w;
  }
  Real s = 0.5, t = 0.5;
  for (int n = 0; n < 50; ++n) {
    const auto value = [&](const auto& h) {
      return (1 - t) * ((1 - s) * h[0] + s * h[1]) + t * ((1 - s) * h[3] + s * h[2]);
    };
    const auto by_s = [&](const auto& h) { return (1 - t) * (h[1] - h[0]) + t * (h[2] - h[3]); };
    const auto by_t = [&](const auto& h) { return (1 - s) * (h[3] - h[0]) + s * (h[2] - h[1]); };
    const Real det = by_s(f) * by_t(g) - by_t(f) * by_s(g);
    const Real ds = (value(f) * by_t(g) - by_t(f) * value(g)) / det;
    const Real dt = (by_s(f) * value(g) - value(f) * by_s(g)) / det;
    s -= ds;
    t -= dt;
    if (std::abs(static_cast<double>(ds)) + std::abs(static_cast<double>(dt)) < 1e-25) return {{s, t}};
  }
  return std::nullopt;
}

/// Largest difference between a sample's weights and the bilinear ones at its pixel.
inline double bilinear_error(const Quad& quad, const MethodSample& sample) {
  const auto st = inverse_bilinear(quad, sample.x + 0.5, sample.y + 0.5);
  if (!st) return HUGE_VAL;
  const auto [s, t] = *st;
  const std::array<Real, 4> expected{(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
  double error = 0;
  for (std::size_t i = 0; i < 4; ++i)
    error = std::fmax(error, std::abs(static_cast<double>(sample.lambda[i] - expected[i])));
  return error;
}

/// Corners and edges on pixel centres, every corner of another w; a plane in space (1/w is linear on the screen).
inline constexpr std::array<Point, 4> centred_corners{{{10.5, 10.5}, {50.5, 20.5}, {44.5, 50.5}, {8.5, 38.5}}};
inline double centred_w(const Point& p) { return 1 / (0.5 + p[0] / 64 + p[1] / 128); }

inline Quad centred_quad(const std::array<Point, 4>& position) {
  std::array<double, 4> w{};
  for (std::size_t i = 0; i < 4; ++i) w[i] = centred_w(position[i]);
  return screen_quad(position, w);
}

/// The triangle of its first three corners, the last repeated.
inline Quad triangle_quad() {
  Quad quad = centred_quad(centred_corners);
  quad.vertex[3] = quad.vertex[2];
  quad.object[3] = quad.object[2];
  quad.texture[3] = quad.texture[2];
  quad.attribute[3] = quad.attribute[2];
  return quad;
}

/// The quad with all corners moved away from its middle by a factor of 1 + 2^-20: pixel centres on its edges and
/// corners are then inside by some 1e-5 pixels, whatever the tie rule.
inline Quad swollen_quad() {
  std::array<Point, 4> position = centred_corners;
  for (Point& p : position)
    for (std::size_t k = 0; k < 2; ++k) p[k] += (p[k] - 30) * 0x1p-20;
  return centred_quad(position);
}

inline std::optional<MethodSample> sample_at(const std::vector<MethodSample>& samples, double x, double y) {
  std::optional<MethodSample> found;
  for (const MethodSample& sample : samples) {
    if (sample.x + 0.5 != x || sample.y + 0.5 != y) continue;
    EXPECT_FALSE(found) << "drawn twice at " << x << ", " << y;
    found = sample;
  }
  return found;
}

/// At the corners lambda_i = 1; on the edge between V_i and V_j at a fraction c of the screen, 1/w interpolates
/// linearly (H&T equation 11): lambda_j = (c/w_j) / ((1 - c)/w_i + c/w_j), without perspective c.
inline void expect_corners_and_linear_edges(const Method& method, const View& view) {
  const Quad quad = swollen_quad();
  const std::vector<MethodSample> samples = draw(method, quad, view);
  int points = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const Point &p = centred_corners[i], &q = centred_corners[j];
    for (int n = 0; n < 120; ++n) {
      const double c = n / 120.0, x = p[0] + c * (q[0] - p[0]), y = p[1] + c * (q[1] - p[1]);
      if (x != std::floor(x) + 0.5 || y != std::floor(y) + 0.5) continue;
      const auto sample = sample_at(samples, x, y);
      ASSERT_TRUE(sample) << x << ", " << y;
      const double one = (1 - c) / quad.vertex[i].w, other = c / quad.vertex[j].w;
      const double expected = view.perspective ? other / (one + other) : c;
      for (std::size_t k = 0; k < 4; ++k) {
        const double wanted = k == i ? 1 - expected : k == j ? expected : 0;
        EXPECT_NEAR(sample->lambda[k], wanted, 5e-6) << method.name() << " at " << x << ", " << y;
      }
      ++points;
    }
  }
  // 4 corners; between them gcd(40, 10), gcd(6, 30), gcd(36, 12), gcd(2, 28) steps.
  EXPECT_EQ(points, 10 + 6 + 12 + 2);
}

/// How often each pixel is drawn, row by row.
inline std::vector<int> counts(const Method& method, const std::vector<Quad>& quads, const View& view) {
  std::vector<int> count(static_cast<std::size_t>(view.width * view.height));
  for (const Quad& quad : quads)
    for (const MethodSample& sample : draw(method, quad, view))
      ++count[static_cast<std::size_t>(sample.y * view.width + sample.x)];
  return count;
}

/// The same quad given from another corner, or the other way round.
inline Quad renumbered(const Quad& quad, std::size_t first, bool reverse) {
  Quad other;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (reverse ? first + 4 - i : first + i) % 4;
    other.vertex[i] = quad.vertex[k];
    other.object[i] = quad.object[k];
    other.texture[i] = quad.texture[k];
    other.attribute[i] = quad.attribute[k];
  }
  return other;
}

/// `columns` × `rows` quads over a grid of points, each given from a random corner in a random direction.
inline std::vector<Quad> quad_mesh(Prng& prng, std::size_t columns, std::size_t rows, auto&& point) {
  std::vector<Quad> quads;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const bool turned = prng.chance(0.5);
      quads.push_back(renumbered(centred_quad({point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)}),
                                 prng.below(4), turned));
    }
  return quads;
}

}  // namespace quadrille::golden::methods::test
