// Plane equations for the quads whose attributes are an affine image of their corners, mean value coordinates for the
// others (Bloomenthal section 4).
#include "golden/methods/affine.hpp"

#include "golden/methods/builders.hpp"
#include "golden/methods/knob_name.hpp"
#include "golden/methods/vector_math.hpp"
#include "golden/methods/weighted_triangle.hpp"

#include <cfloat>
#include <optional>

namespace quadrille::golden::methods {
namespace {

using Vector = std::vector<double>;

/// The barycentric coordinates of p_i with respect to the three corners after it, from area(a, b, c), which is signed
/// and linear in every point; none if those three are on one line as far as areas of size `unit` can tell.
template <class Point, class Area>
std::optional<Vec3> barycentric(const std::array<Point, 4>& p, std::size_t i, double unit, Area&& area) {
  const Point &p1 = p[(i + 1) % 4], &p2 = p[(i + 2) % 4], &p3 = p[(i + 3) % 4];
  const double a1 = area(p[i], p2, p3), a2 = area(p[i], p3, p1), a3 = area(p[i], p1, p2), sum = a1 + a2 + a3;
  if (!(std::abs(sum) > FLT_EPSILON * unit)) return std::nullopt;
  return Vec3{a1 / sum, a2 / sum, a3 / sum};
}

std::optional<Vec3> barycentric_in_space(const std::array<Vec3, 4>& p, std::size_t i) {
  Vec3 normal = largest_normal(p);
  const double norm = length(normal), size = extent(p);
  if (norm == 0) return std::nullopt;
  for (double& n : normal) n /= norm;
  return barycentric(p, i, size * size, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return dot(cross_product(difference(b, a), difference(c, b)), normal);
  });
}

std::optional<Vec3> barycentric_in_plane(const std::array<Vec2, 4>& p, std::size_t i) {
  const double size = extent(p);
  return barycentric(p, i, size * size, [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
  });
}

double distance(const Vector& a, const Vector& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

/// Whether b takes the attributes of the other three to those of corner i.
bool combines(const std::array<Vector, 4>& attribute, std::size_t i, const Vec3& b, double tolerance) {
  double size = 0;
  for (std::size_t j = 1; j < 4; ++j)
    for (std::size_t k = 0; k < j; ++k) size = std::fmax(size, distance(attribute[j], attribute[k]));
  Vector combined(attribute[i].size());
  for (std::size_t k = 0; k < combined.size(); ++k)
    for (std::size_t j = 0; j < 3; ++j) combined[k] += b[j] * attribute[(i + 1 + j) % 4][k];
  return distance(attribute[i], combined) <= tolerance * size;
}

bool has_equal_neighbours(const Quad& quad) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    if (same_vertex(quad.vertex[i], quad.vertex[j]) && quad.object[i] == quad.object[j] &&
        quad.attribute[i] == quad.attribute[j])
      return true;
  }
  return false;
}

/// Convex in its own plane, on either side of the eye: a determinant of three corners is their signed area there times
/// the plane's distance from the eye.
bool is_convex(const std::array<WindowVertex, 4>& v) {
  const auto turn = [&](std::size_t i) {
    const WindowVertex &p = v[i], &q = v[(i + 1) % 4], &r = v[(i + 2) % 4];
    return p.x * (q.y * r.w - r.y * q.w) - p.y * (q.x * r.w - r.x * q.w) + p.w * (q.x * r.y - r.x * q.y);
  };
  const std::array<double, 4> d{turn(0), turn(1), turn(2), turn(3)};
  return std::ranges::all_of(d, [](double t) { return t > 0; }) ||
         std::ranges::all_of(d, [](double t) { return t < 0; });
}

class Affine final : public Method {
 public:
  explicit Affine(double tolerance) : tolerance_(tolerance), mean_value_(make_mvc()) {}

  std::string name() const override { return knob_name("affine", tolerance_); }
  bool needs_object_space() const override { return true; }

  /// On a convex quad the two triangles of a diagonal are the plane equation: both give an affine attribute the same
  /// values. They are not on a concave or crossed one, where coverage is expression (12): mean value coordinates, which
  /// reproduce affine attributes too.
  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    if (triangles(quad, view) > 0)
      draw_split02(weighted_corners(quad), view, out);
    else
      mean_value_->draw(quad, view, out);
  }

  Census census(std::span<const Quad> quads, const View& view) const override {
    Census census;
    census.quads = census.emitted_quads = quads.size();
    for (const Quad& quad : quads) {
      const std::uint64_t set_up = triangles(quad, view);
      census.affine += set_up > 0 ? 1 : 0;
      census.triangles += set_up;
    }
    return census;
  }

 private:
  /// How many triangles draw the quad; 0 for mean value coordinates. Of a triangle one half of the split is empty.
  std::uint64_t triangles(const Quad& quad, const View& view) const {
    if (has_equal_neighbours(quad)) return 1;
    return is_convex(quad.vertex) && is_affine(quad, view, tolerance_) ? 2 : 0;
  }

  double tolerance_;
  std::unique_ptr<Method> mean_value_;
};

}  // namespace

bool is_affine(const Quad& quad, const View& view, double tolerance) {
  if (has_equal_neighbours(quad)) return true;
  std::array<Vec3, 4> geometry = quad.object;
  if (!view.perspective) {
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex& v = quad.vertex[i];
      if (!(v.w > 0)) return false;
      geometry[i] = {v.x / v.w, v.y / v.w, 0};
    }
  }
  if (off_plane(geometry) > tolerance) return false;

  std::array<Vec2, 4> plane{};
  const bool two_dimensions = quad.attribute[0].size() == 2;
  for (std::size_t i = 0; two_dimensions && i < 4; ++i) plane[i] = {quad.attribute[i][0], quad.attribute[i][1]};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::optional<Vec3> in_space = barycentric_in_space(geometry, i);
    if (!in_space) return false;
    if (!two_dimensions) {
      if (!combines(quad.attribute, i, *in_space, tolerance)) return false;
      continue;
    }
    const std::optional<Vec3> in_plane = barycentric_in_plane(plane, i);
    if (!in_plane || length(difference(*in_space, *in_plane)) > tolerance) return false;
  }
  return true;
}

std::unique_ptr<Method> make_affine(double tolerance) { return std::make_unique<Affine>(tolerance); }

}  // namespace quadrille::golden::methods
