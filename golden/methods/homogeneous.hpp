// Edge functions in homogeneous coordinates (Olano & Greer 1997, cited by Hormann & Tarini section 4.1) and a triangle
// rasterizer on top of them, in double precision.
#pragma once

#include "golden/methods/method.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden::methods {

/// E(p) = S_P × S_Q with S = (x̃ − w x, ỹ − w y): positive where p sees P → Q turn clockwise on the screen (y down), for
/// vertices with positive w. Exactly antisymmetric: E_PQ = −E_QP in every bit.
struct EdgeFunction {
  double a = 0, b = 0, c = 0;  ///< E = a x + b y + c

  EdgeFunction() = default;
  EdgeFunction(const WindowVertex& p, const WindowVertex& q)
      : a(p.y * q.w - q.y * p.w), b(q.x * p.w - p.x * q.w), c(p.x * q.y - q.x * p.y) {}

  double at(double x, double y) const { return a * x + b * y + c; }
  /// Sign of E at (x, y); where E is 0 its sign at (x + eps, y + eps^2). 0 for an edge whose coefficients are all 0.
  int sign(double x, double y) const {
    for (const double v : {at(x, y), a, b}) {
      if (v > 0) return 1;
      if (v < 0) return -1;
    }
    return 0;
  }
};

/// Half-open pixel rectangle that holds every covered pixel of the view: the whole view where a vertex has w <= 0.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

template <std::size_t N>
PixelBox pixel_box(const std::array<WindowVertex, N>& vertex, const View& view) {
  double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
  for (const WindowVertex& v : vertex) {
    if (!(v.w > 0)) return {0, 0, view.width, view.height};
    x0 = std::min(x0, v.x / v.w), x1 = std::max(x1, v.x / v.w);
    y0 = std::min(y0, v.y / v.w), y1 = std::max(y1, v.y / v.w);
  }
  // A pixel either way costs nothing and makes the roundings of the quotients harmless.
  const auto low = [](double v, int size) {
    return static_cast<int>(std::clamp(std::floor(v - 1.5), 0.0, static_cast<double>(size)));
  };
  const auto high = [](double v, int size) {
    return static_cast<int>(std::clamp(std::ceil(v + 1.5), 0.0, static_cast<double>(size)));
  };
  return {low(x0, view.width), low(y0, view.height), high(x1, view.width), high(y1, view.height)};
}

/// What a triangle's pixel gets: barycentric coordinates of the triangle in space (b) and on the screen (c); both sum
/// to 1.
struct TrianglePixel {
  int x = 0, y = 0;
  bool front = false;
  std::array<double, 3> space{}, screen{};
  double z = 0;
};

/// Calls visit(const TrianglePixel&) for every pixel of the view whose centre the homogeneous triangle covers in front
/// of the eye; any sign of w. Two triangles that share an edge never both draw a pixel of it, nor leave one out.
template <class Visit>
void raster_triangle(const std::array<WindowVertex, 3>& vertex, const View& view, Visit&& visit) {
  const std::array<EdgeFunction, 3> edge{EdgeFunction(vertex[1], vertex[2]), EdgeFunction(vertex[2], vertex[0]),
                                         EdgeFunction(vertex[0], vertex[1])};
  // p times the determinant is sum(E_i V_i): the sum of w's share of it tells front from behind.
  const PixelBox box = pixel_box(vertex, view);
  for (int y = box.y0; y < box.y1; ++y) {
    const double py = y + 0.5;
    for (int x = box.x0; x < box.x1; ++x) {
      const double px = x + 0.5;
      const int sign = edge[0].sign(px, py);
      if (sign == 0 || edge[1].sign(px, py) != sign || edge[2].sign(px, py) != sign) continue;
      TrianglePixel pixel{x, y, sign < 0, {}, {}, 0};
      double sum = 0, sum_w = 0, sum_z = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        pixel.space[i] = edge[i].at(px, py);
        sum += pixel.space[i];
        sum_w += pixel.space[i] * vertex[i].w;
        sum_z += pixel.space[i] * vertex[i].z;
      }
      if (sum == 0 || !(sum_w / sum > 0)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        pixel.screen[i] = pixel.space[i] * vertex[i].w / sum_w;
        pixel.space[i] /= sum;
      }
      pixel.z = sum_z / sum_w;
      visit(static_cast<const TrianglePixel&>(pixel));
    }
  }
}

}  // namespace quadrille::golden::methods
