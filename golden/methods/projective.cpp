// Method projective: the projective map of the projected quad to the unit square, bilinear there (Hormann & Tarini
// 2004, section 1, after Duff 1979; the map by Heckbert 1989, section 2.2.3).
#include "golden/methods/builders.hpp"
#include "golden/methods/quad_coverage.hpp"

#include <cmath>

namespace quadrille::golden::methods {
namespace {

struct Projected {
  std::array<double, 4> x{}, y{};

  explicit Projected(const std::array<WindowVertex, 4>& vertex) {
    for (std::size_t i = 0; i < 4; ++i) x[i] = vertex[i].x / vertex[i].w, y[i] = vertex[i].y / vertex[i].w;
  }

  /// All four turns are to the same side. A quad cannot turn twice around, so it is simple then.
  bool strictly_convex() const {
    int left = 0, right = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) & 3, k = (i + 2) & 3;
      const double turn = (x[j] - x[i]) * (y[k] - y[j]) - (y[j] - y[i]) * (x[k] - x[j]);
      left += turn < 0 ? 1 : 0;
      right += turn > 0 ? 1 : 0;
    }
    return left == 4 || right == 4;
  }
};

/// The inverse of Heckbert's map of the unit square to the quad, X = (a s + b t) / (g s + h t + 1), Y = (d s + e t) /
/// (g s + h t + 1) with (X, Y) relative to corner 0.
class ToSquare {
 public:
  explicit ToSquare(const Projected& v) : x0_(v.x[0]), y0_(v.y[0]) {
    const double x1 = v.x[1] - x0_, x2 = v.x[2] - x0_, x3 = v.x[3] - x0_;
    const double y1 = v.y[1] - y0_, y2 = v.y[2] - y0_, y3 = v.y[3] - y0_;
    const double dx1 = x1 - x2, dx2 = x3 - x2, dy1 = y1 - y2, dy2 = y3 - y2;
    const double sum_x = x2 - x1 - x3, sum_y = y2 - y1 - y3;  // x0 - x1 + x2 - x3
    const double det = dx1 * dy2 - dx2 * dy1;
    const double g = (sum_x * dy2 - dx2 * sum_y) / det, h = (dx1 * sum_y - sum_x * dy1) / det;
    a_ = x1 + g * x1, b_ = x3 + h * x3;
    d_ = y1 + g * y1, e_ = y3 + h * y3;
    qx_ = d_ * h - e_ * g, qy_ = b_ * g - a_ * h, q1_ = a_ * e_ - b_ * d_;
  }

  /// Bilinear weights of the square at the image of (x, y).
  std::array<double, 4> weights(double x, double y) const {
    const double dx = x - x0_, dy = y - y0_;
    const double q = qx_ * dx + qy_ * dy + q1_;
    const double s = (e_ * dx - b_ * dy) / q, t = (a_ * dy - d_ * dx) / q;
    return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
  }

 private:
  double x0_, y0_, a_ = 0, b_ = 0, d_ = 0, e_ = 0, qx_ = 0, qy_ = 0, q1_ = 0;
};

/// Refuses quads whose projection is not strictly convex (triangles too: their corners 2 and 3 coincide) or with a
/// w <= 0: the map to the square does not exist, or maps part of the quad across infinity.
///
/// The corners' own w plays no role, with perspective or without: the map sees the projected quad only and takes
/// whatever foreshortening a square of that outline would have. That is the false depth of which Hormann & Tarini
/// speak; a quad that is the picture of a parallelogram is the case in which it is true.
class Projective final : public Method {
 public:
  std::string name() const override { return "projective"; }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    if (refuses(quad)) return;
    const ToSquare map{Projected(quad.vertex)};
    raster_quad(quad.vertex, view, [&](int x, int y, bool front) {
      MethodSample sample{x, y, front, false, 0, map.weights(x + 0.5, y + 0.5)};
      for (std::size_t i = 0; i < 4; ++i) sample.z += sample.lambda[i] * (quad.vertex[i].z / quad.vertex[i].w);
      out.push_back(sample);
    });
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    const auto refused = static_cast<std::uint64_t>(std::ranges::count_if(quads, refuses));
    return {.quads = quads.size(), .refused = refused, .emitted_quads = quads.size() - refused};
  }

 private:
  static bool refuses(const Quad& quad) {
    return !all_in_front(quad.vertex) || !Projected(quad.vertex).strictly_convex();
  }
};

}  // namespace

std::unique_ptr<Method> make_projective() { return std::make_unique<Projective>(); }

}  // namespace quadrille::golden::methods
