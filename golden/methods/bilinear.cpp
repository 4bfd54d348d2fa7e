// Method bilinear: inverse bilinear interpolation on the screen (Quilez 2010, as cited by Bloomenthal 2022, section
// 3.3).
#include "golden/methods/builders.hpp"
#include "golden/methods/mean_value.hpp"
#include "golden/methods/quad_coverage.hpp"

#include <cmath>
#include <complex>
#include <optional>

namespace quadrille::golden::methods {
namespace {

using Point = std::complex<double>;

double cross(Point a, Point b) { return a.real() * b.imag() - a.imag() * b.real(); }
double dot(Point a, Point b) { return a.real() * b.real() + a.imag() * b.imag(); }

/// Bilinear patch of the projected corners v_i, (1-u)(1-v) v_0 + u(1-v) v_1 + uv v_2 + (1-u)v v_3.
class Patch {
 public:
  explicit Patch(const std::array<WindowVertex, 4>& vertex) {
    for (std::size_t i = 0; i < 4; ++i) {
      corner_[i] = {vertex[i].x / vertex[i].w, vertex[i].y / vertex[i].w};
      w_sign_[i] = vertex[i].w > 0 ? 1.0 : -1.0;
      exterior_ = exterior_ || !(vertex[i].w > 0);
      extent_ = std::max({extent_, std::abs(corner_[i].real()), std::abs(corner_[i].imag())});
    }
  }

  /// The four weights of the (u, v) that the patch maps to p; nothing where there is none. (u, v) is in [0, 1]^2 for a
  /// quad in front of the eye.
  ///
  /// Quilez solves k2 v^2 + k1 v + k0 = 0; the same quadratic is c0 (1-v)^2 + 2 c1 v(1-v) + c2 v^2 with k0 = c0,
  /// k1 = 2 (c1 - c0), k2 = c0 - 2 c1 + c2, whose coefficients are twice the areas that p sees. So v and 1 - v are both
  /// exact to rounding, also near an edge and beside a corner that is far away, and parallel edges (k2 = 0) are no
  /// case of their own: one root is at infinity.
  ///
  /// Inside a quad in front of the eye exactly one root is in the square: the patch covers p as often as the border
  /// winds around it, up to pairs of opposite folds, and there are at most two roots.
  ///
  /// With corners behind the eye the visible part of the quad lies outside of its projected corners' square: where the
  /// discriminant is negative there is no answer (Bloomenthal's figure 14). Elsewhere the root counts whose weights
  /// have one sign once divided by w; if neither has, what Quilez' code takes: its first root, with the negative square
  /// root, if that is in the square, else the second.
  std::optional<std::array<double, 4>> weights(Point p) const {
    std::array<Point, 4> s;
    for (std::size_t i = 0; i < 4; ++i) s[i] = corner_[i] - p;
    const double c0 = cross(s[1], s[0]), c1 = (cross(s[2], s[0]) + cross(s[1], s[3])) / 2, c2 = cross(s[2], s[3]);
    // Every v: the patch shrinks a line to this point (a collapsed edge, the crossing of two edges between parallels).
    if (c0 == 0 && c1 == 0 && c2 == 0) return at(s, 1, 1);
    if (exterior_ && !(c1 * c1 - c0 * c2 >= 0)) return std::nullopt;
    // A quarter of Quilez' discriminant. Below 0 there is no root, unless by rounding: at() decides, which refuses the
    // vertex of a parabola that does not reach 0.
    const double root = std::sqrt(std::max(c1 * c1 - c0 * c2, 0.0));
    const double q = -(c1 + std::copysign(root, c1));            // nothing cancels
    const std::array<double, 2> by_end{q, c2}, by_start{c0, q};  // v : 1 - v
    const auto roots = std::signbit(c1) ? std::array{by_start, by_end} : std::array{by_end, by_start};
    if (exterior_) {
      for (const auto& [v, rest] : roots)
        if (const auto found = anywhere(s, v, rest); found && one_sign(*found)) return found;
    }
    for (const auto& [v, rest] : roots)
      if (const auto found = at(s, v, rest)) return found;
    return exterior_ ? anywhere(s, roots[1][0], roots[1][1]) : std::nullopt;
  }

 private:
  /// The weights for v : 1 - v = part : rest if they reproduce p to rounding after u and v are moved into [0, 1]. That
  /// refuses parameters outside and roots that are none (a line of the patch that shrinks to another point), whatever
  /// the quad's size and shape.
  std::optional<std::array<double, 4>> at(const std::array<Point, 4>& s, double part, double rest) const {
    const double v = std::clamp(part / (part + rest), 0.0, 1.0), v1 = std::clamp(rest / (part + rest), 0.0, 1.0);
    const Point left = v1 * s[0] + v * s[3], right = v1 * s[1] + v * s[2], along = left - right;
    // Length 0: every u.
    const double length2 = std::norm(along);
    const double u = length2 > 0 ? std::clamp(dot(left, along) / length2, 0.0, 1.0) : 0.5;
    const double u1 = length2 > 0 ? std::clamp(-dot(right, along) / length2, 0.0, 1.0) : 0.5;
    // 5e-10 px for coordinates of 512. A corner so far away that doubles beside it do not resolve pixels has no root.
    const double tolerance = std::min(0x1p-40 * extent_, 0x1p-10);
    if (!(std::abs(u1 * left + u * right) <= tolerance)) return std::nullopt;
    return std::array{u1 * v1, u * v1, u * v, u1 * v};
  }

  /// The weights for v : 1 - v = part : rest and the u that comes nearest, in the square or not; nothing at infinity.
  static std::optional<std::array<double, 4>> anywhere(const std::array<Point, 4>& s, double part, double rest) {
    const double v = part / (part + rest), v1 = rest / (part + rest);
    const Point left = v1 * s[0] + v * s[3], right = v1 * s[1] + v * s[2], along = left - right;
    const double u = dot(left, along) / std::norm(along), u1 = -dot(right, along) / std::norm(along);
    if (!std::isfinite(u * v) || !std::isfinite(u1 * v1)) return std::nullopt;
    return std::array{u1 * v1, u * v1, u * v, u1 * v};
  }

  bool one_sign(const std::array<double, 4>& beta) const {
    bool positive = false, negative = false;
    for (std::size_t i = 0; i < 4; ++i)
      positive = positive || beta[i] * w_sign_[i] > 0, negative = negative || beta[i] * w_sign_[i] < 0;
    return positive != negative;
  }

  std::array<Point, 4> corner_;
  std::array<double, 4> w_sign_{};
  double extent_ = 0;
  bool exterior_ = false;  ///< a corner is not in front of the eye
};

class Bilinear final : public Method {
 public:
  std::string name() const override { return "bilinear"; }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    const auto& vertex = quad.vertex;
    const bool always_visible = all_in_front(vertex);
    const Patch patch(vertex);
    raster_quad(vertex, view, [&](int x, int y, bool front) {
      // What is visible is the quad's matter, not the patch's, which may have no point here.
      if (!always_visible && !in_front(mean_value_weights(vertex, {1, 1, 1, 1}, x + 0.5, y + 0.5), vertex)) return;
      const auto beta = patch.weights({x + 0.5, y + 0.5});
      out.push_back(beta ? sample(x, y, front, vertex, *beta, view.perspective) : undefined_sample(x, y, front));
    });
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    return {.quads = quads.size(), .emitted_quads = quads.size()};
  }

 private:
  /// Screen-space weights beta; with perspective lambda_i ~ beta_i / w_i, eq. (10) of Hormann & Tarini. z is linear on
  /// the screen, eq. (4).
  static MethodSample sample(int x, int y, bool front, const std::array<WindowVertex, 4>& vertex,
                             const std::array<double, 4>& beta, bool perspective) {
    MethodSample out{x, y, front, false, 0, {}};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      out.z += beta[i] * (vertex[i].z / vertex[i].w);
      out.lambda[i] = perspective ? beta[i] / vertex[i].w : beta[i];
      sum += out.lambda[i];
    }
    // Corners on both sides of the eye plane: the patch's point at infinity.
    if (sum == 0) return undefined_sample(x, y, front);
    for (double& v : out.lambda) v /= sum;
    return out;
  }
};

}  // namespace

std::unique_ptr<Method> make_bilinear() { return std::make_unique<Bilinear>(); }

}  // namespace quadrille::golden::methods
