// Where to look for the pixels of a quad: a bounding box and, in each row, an interval, from signs of the homogeneous
// edge functions (Olano & Greer 1997; Hormann & Tarini 2004, expression 12).
#pragma once

#include "model/port/records.hpp"

#include <array>
#include <cstdint>

namespace quadrille::golden {

/// Half-open rectangle of pixels: x0 <= x < x1, y0 <= y < y1; empty when x0 >= x1 or y0 >= y1.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  bool empty() const { return x0 >= x1 || y0 >= y1; }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

inline PixelRect scissor_of(const DrawState& draw) {
  return {draw.scissor_x0, draw.scissor_y0, draw.scissor_x1, draw.scissor_y1};
}

/// Pixels of a row, x0 <= x < x1; none when x0 >= x1.
struct PixelSpan {
  int x0 = 0, x1 = 0;

  int size() const { return x1 > x0 ? x1 - x0 : 0; }
};

/// No pixel outside of the rows is covered, whoever computes the edge functions from these vertices, exactly or in
/// double precision: an interval ends where a function's sign is certain. The rows may hold more than what is covered:
/// the hull of both clauses of (12), with a concave quad's notch.
class CoverageRows {
 public:
  using Vertex = std::array<double, 3>;  ///< (x, y, w)
  /// Which covered pixels count: those that a triangle of (12), 012 or 023, shows in front of the eye, or all.
  enum class Eye : std::uint8_t { in_front, anywhere };

  CoverageRows() = default;
  /// Pixel (x, y) is looked at in (x + centre, y + centre).
  CoverageRows(const std::array<Vertex, 4>& vertex, double centre, const PixelRect& within, Eye eye);

  const PixelRect& bounds() const { return bounds_; }
  /// Of a row of the bounds; within them.
  PixelSpan row(int y) const;

 private:
  /// |x_i| + |w_i| max |x|: no coordinate of S_i = V_i - w_i p is larger within the rectangle.
  struct Reach {
    std::array<double, 4> x, y;
  };
  PixelRect triangle_box(std::size_t clause, int orientation, const PixelRect& within, const Reach& reach,
                         Eye eye) const;

  std::array<Vertex, 4> vertex_{};
  double centre_ = 0;
  std::array<double, 5> tolerance_{};  ///< beyond which an edge function's sign is certain
  /// By clause: the orientations for which it may hold.
  std::array<std::array<bool, 2>, 2> possible_{};
  PixelRect bounds_;
};

}  // namespace quadrille::golden
