// The integer triangle rasterizer of MIT 6.837 (2000), lecture 6, slides 9 to 29: edge equations, bounding box, plane
// equations and scan, and the precision of an edge equation's C (slide 13).
//
// The lecture samples at integer coordinates; here the caller moves the vertices by (-1/2, -1/2) first, so that pixel
// (x, y) is sampled at the point (x, y). `bits` is the lecture's FRACBITS, 12 there. Every (int) cast of the lecture is
// a truncation towards 0.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace quadrille::golden::methods::integer_triangle {

/// Largest |x| and |y| of a vertex, and the largest view. With them and bits <= 20 nothing overflows 64 bits: A, B are
/// below 2^41, C below 2^61, and A x + B y below 2^58 in the view. The lecture's 32 bits hold, with 12 fraction bits, a
/// C below 2^19 square pixels only, hence vertices up to some 500 pixels from the origin.
inline constexpr double guard_band = 0x1p20;
inline constexpr int largest_view = 1 << 16;

struct Point {
  double x = 0, y = 0;
};

/// A x + B y + C >= 0 on the inner side, A = y0 - y1, B = x1 - x0, C = -(A (x0 + x1) + B (y0 + y1)) / 2; in pixels, for
/// C square pixels, each with `bits` fraction bits and truncated: off by less than one unit. Truncation is odd, so that
/// an edge walked backwards has exactly the negated coefficients: of two triangles at an edge each pixel is inside at
/// least one.
struct EdgeEquation {
  std::int64_t a = 0, b = 0, c = 0;
  /// What the bounding box needs: 8 for A >= 0 (the edge does not go down: y0 >= y1), 1 for B >= 0 (x1 >= x0).
  int flag = 0;

  EdgeEquation() = default;
  EdgeEquation(Point v0, Point v1, int bits);

  /// Exchanges the two sides; `flag` keeps the direction of the vertices.
  void flip();
  std::int64_t at(std::int64_t x, std::int64_t y) const { return a * x + b * y + c; }
};

struct Triangle {
  std::array<EdgeEquation, 3> edge{};  ///< 01, 12, 20; all three positive inside
  std::int64_t area = 0;               ///< C0 + C1 + C2 > 0: twice the area, `bits` fraction bits
  bool flipped = false;                ///< the area was negative: counter-clockwise on the screen
  int x_min = 0, x_max = -1;           ///< pixels to scan, both included, clipped to the view
  int y_min = 0, y_max = -1;
};

/// Nothing where the area of the truncated equations is 0. |x|, |y| <= guard_band, width and height <= largest_view.
///
/// Defects of the lecture's scheme that are kept: two triangles both draw a pixel exactly on their shared edge; pixels
/// whose edge function is within (1 + x + y) units of 0 may be added or left out; a difference that truncates to 0
/// counts as not negative in either direction, so that the box may follow the other of two vertices that are less than
/// a unit apart and then ends a pixel earlier or later, which shows where a truncated edge sticks out of the triangle.
std::optional<Triangle> set_up(const std::array<Point, 3>& vertex, int width, int height, int bits);

/// A parameter's value A x + B y + C, with `bits` fraction bits, each coefficient truncated.
struct PlaneEquation {
  std::int64_t a = 0, b = 0, c = 0;
};

/// The plane through the values p at the three vertices, from the edge equations' coefficients (slide 24; the code of
/// slide 26 is not in the transcript). Slopes saturate at 2^45 and C at 2^61 units, so that the scan cannot overflow:
/// that takes a slope of 2^25 per pixel with 20 fraction bits.
PlaneEquation plane_equation(const Triangle& triangle, const std::array<double, 3>& p, int bits);

/// Calls visit(x, y, values) for every pixel inside, row by row: t += B per row, e += A per pixel, the three signs
/// tested at once by OR, ties drawn. `early_exit` leaves a row where it leaves the triangle, which is convex.
template <std::size_t N, class Visit>
void scan(const Triangle& triangle, const std::array<PlaneEquation, N>& plane, bool early_exit, Visit&& visit) {
  const auto& [e0, e1, e2] = triangle.edge;
  std::int64_t t0 = e0.at(triangle.x_min, triangle.y_min);
  std::int64_t t1 = e1.at(triangle.x_min, triangle.y_min);
  std::int64_t t2 = e2.at(triangle.x_min, triangle.y_min);
  std::array<std::int64_t, N> row{};
  for (std::size_t i = 0; i < N; ++i) {
    row[i] = plane[i].a * triangle.x_min + plane[i].b * triangle.y_min + plane[i].c;
  }
  for (int y = triangle.y_min; y <= triangle.y_max; ++y) {
    std::int64_t s0 = t0, s1 = t1, s2 = t2;
    std::array<std::int64_t, N> value = row;
    bool been_inside = false;
    for (int x = triangle.x_min; x <= triangle.x_max; ++x) {
      if ((s0 | s1 | s2) >= 0) {
        visit(x, y, static_cast<const std::array<std::int64_t, N>&>(value));
        been_inside = true;
      } else if (been_inside && early_exit) {
        break;
      }
      s0 += e0.a, s1 += e1.a, s2 += e2.a;
      for (std::size_t i = 0; i < N; ++i) value[i] += plane[i].a;
    }
    t0 += e0.b, t1 += e1.b, t2 += e2.b;
    for (std::size_t i = 0; i < N; ++i) row[i] += plane[i].b;
  }
}

struct FloatPoint {
  float x = 0, y = 0;
};

/// Errors of C before truncation, in units of the last fraction bit.
struct Error {
  double max = 0, rms = 0;
};

/// Slide 13 measured: C of the same edges between float vertices.
struct EdgePrecision {
  Error naive;     ///< x0 y1 - x1 y0, every operation in single precision
  Error averaged;  ///< -(A (x0 + x1) + B (y0 + y1)) / 2, every operation in single precision
  Error printed;   ///< the averaged form as the slide's Java evaluates it: sums of vertices single, the rest double
};

EdgePrecision edge_precision(std::span<const std::array<FloatPoint, 2>> edges, int bits);

}  // namespace quadrille::golden::methods::integer_triangle
