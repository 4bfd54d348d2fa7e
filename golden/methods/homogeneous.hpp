// Edge functions in homogeneous coordinates (Olano & Greer 1997, cited by Hormann & Tarini section 4.1) and a triangle
// rasterizer on top of them, in double precision.
#pragma once

#include "golden/methods/method.hpp"
#include "golden/reference/coverage_rows.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden::methods {

/// a d − b c: the sign is that of the exact value (rounding is monotone, so unequal products are in their true order;
/// the errors of equal ones are exact), and exchanging (a, b) with (c, d) negates every bit.
inline double difference_of_products(double a, double d, double b, double c) {
  const double ad = a * d, bc = b * c;
  return ad != bc ? ad - bc : std::fma(a, d, -ad) - std::fma(b, c, -bc);
}

/// S = (x̃ − w x, ỹ − w y) with w: a vertex as seen from a pixel centre.
struct PixelVector {
  double x = 0, y = 0, w = 0;

  PixelVector(const WindowVertex& v, double px, double py) : x(v.x - v.w * px), y(v.y - v.w * py), w(v.w) {}

  /// The edge function E(p) = S_P × S_Q: positive where p sees P → Q turn clockwise on the screen (y down), for
  /// vertices with positive w. Exactly antisymmetric: E_PQ = −E_QP in every bit. Signs are exact for the vectors S,
  /// which are rounded once a vertex and pixel: all edges at a vertex agree about where it is, so that the triangles
  /// around it neither leave a pixel out nor draw one twice. (a x + b y + c rounds every edge by itself and does both.)
  friend double cross(const PixelVector& p, const PixelVector& q) { return difference_of_products(p.x, q.y, p.y, q.x); }

  /// Sign of S_P × S_Q; where it is 0, its sign seen from (x + eps, y + eps^2). 0 for P parallel to Q.
  friend int side(const PixelVector& p, const PixelVector& q) {
    double v = cross(p, q);
    if (v == 0) v = difference_of_products(p.y, q.w, q.y, p.w);
    if (v == 0) v = difference_of_products(q.x, p.w, p.x, q.w);
    return (v > 0) - (v < 0);
  }
};

/// Empty where no convex combination of the vertices is both in front of the eye and in the view; otherwise the whole
/// view where a vertex has w <= 0.
template <std::size_t N>
PixelRect pixel_box(const std::array<WindowVertex, N>& vertex, const View& view) {
  const auto all = [&](auto&& outside) { return std::ranges::all_of(vertex, outside); };
  if (all([](const WindowVertex& v) { return v.w <= 0; }) || all([](const WindowVertex& v) { return v.x <= 0; }) ||
      all([](const WindowVertex& v) { return v.y <= 0; }) ||
      all([&](const WindowVertex& v) { return v.x >= v.w * view.width; }) ||
      all([&](const WindowVertex& v) { return v.y >= v.w * view.height; }))
    return {};
  double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
  for (const WindowVertex& v : vertex) {
    if (!(v.w > 0)) return {0, 0, view.width, view.height};
    x0 = std::min(x0, v.x / v.w), x1 = std::max(x1, v.x / v.w);
    y0 = std::min(y0, v.y / v.w), y1 = std::max(y1, v.y / v.w);
  }
  // Pixel x is covered only if x0 <= x + 1/2 <= x1; the margin makes the roundings of the quotients harmless.
  constexpr double margin = 0x1p-10;
  const auto low = [](double v, int size) {
    return static_cast<int>(std::clamp(std::ceil(v - 0.5 - margin), 0.0, static_cast<double>(size)));
  };
  const auto high = [](double v, int size) {
    return static_cast<int>(std::clamp(std::floor(v + 0.5 + margin), 0.0, static_cast<double>(size)));
  };
  return {low(x0, view.width), low(y0, view.height), high(x1, view.width), high(y1, view.height)};
}

/// No point of the quad, nor of any part of it, is in front of the eye and in the view. Where some w are positive and
/// some are not, nothing is said: parts are rounded.
inline bool out_of_view(const std::array<WindowVertex, 4>& vertex, const View& view) {
  const auto behind = std::ranges::count_if(vertex, [](const WindowVertex& v) { return !(v.w > 0); });
  return behind == 4 ? std::ranges::all_of(vertex, [](const WindowVertex& v) { return v.w <= 0; })
                     : behind == 0 && pixel_box(vertex, view).empty();
}

/// Calls visit(x, y) for pixels of the view, row by row, every one that the triangle or quad covers in front of the eye
/// (of quads, `anywhere`) among them.
template <std::size_t N, class Visit>
void for_each_pixel(const std::array<WindowVertex, N>& vertex, const View& view, CoverageRows::Eye eye, Visit&& visit) {
  const PixelRect box = pixel_box(vertex, view);
  constexpr std::int64_t few = 256;  // pixels, which are looked at in less time than rows are found
  if (box.empty() || std::int64_t{box.x1 - box.x0} * (box.y1 - box.y0) <= few) {
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x) visit(x, y);
    return;
  }
  std::array<CoverageRows::Vertex, 4> corner;
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex& v = vertex[std::min(i, N - 1)];  // a triangle repeats its last corner
    corner[i] = {v.x, v.y, v.w};
  }
  const CoverageRows rows(corner, 0.5, box, eye);
  for (int y = rows.bounds().y0; y < rows.bounds().y1; ++y) {
    const PixelSpan row = rows.row(y);
    for (int x = row.x0; x < row.x1; ++x) visit(x, y);
  }
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
/// of the eye; any sign of w. Triangles that share edges or corners (the same bits) never both draw a pixel there, nor
/// leave one out.
template <class Visit>
void raster_triangle(const std::array<WindowVertex, 3>& vertex, const View& view, Visit&& visit) {
  for_each_pixel(vertex, view, CoverageRows::Eye::in_front, [&](int x, int y) {
    const double px = x + 0.5, py = y + 0.5;
    const PixelVector s0(vertex[0], px, py), s1(vertex[1], px, py), s2(vertex[2], px, py);
    const int sign = side(s1, s2);
    if (sign == 0 || side(s2, s0) != sign || side(s0, s1) != sign) return;
    TrianglePixel pixel{x, y, sign < 0, {cross(s1, s2), cross(s2, s0), cross(s0, s1)}, {}, 0};
    // p times the determinant is sum(E_i V_i): the sum of w's share of it tells front from behind.
    double sum = 0, sum_w = 0, sum_z = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += pixel.space[i];
      sum_w += pixel.space[i] * vertex[i].w;
      sum_z += pixel.space[i] * vertex[i].z;
    }
    if (sum == 0 || !(sum_w / sum > 0)) return;
    for (std::size_t i = 0; i < 3; ++i) {
      pixel.screen[i] = pixel.space[i] * vertex[i].w / sum_w;
      pixel.space[i] /= sum;
    }
    pixel.z = sum_z / sum_w;
    visit(static_cast<const TrianglePixel&>(pixel));
  });
}

}  // namespace quadrille::golden::methods
