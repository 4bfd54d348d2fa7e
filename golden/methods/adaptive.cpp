// Adaptive subdivision until every part is nearly a parallelogram in object and texture space (Oliveira, figures 10 and
// 11).
#include "golden/methods/adaptive.hpp"

#include "golden/methods/builders.hpp"
#include "golden/methods/knob_name.hpp"
#include "golden/methods/vector_math.hpp"

namespace quadrille::golden::methods {
namespace {

constexpr double planar = 1e-6;  // of the quad's size

template <std::size_t N>
std::array<double, N> midpoint(const std::array<double, N>& a, const std::array<double, N>& b) {
  std::array<double, N> m{};
  for (std::size_t i = 0; i < N; ++i) m[i] = (a[i] + b[i]) * 0.5;
  return m;
}

WeightedVertex midpoint(const WeightedVertex& a, const WeightedVertex& b) {
  const WindowVertex &p = a.vertex, &q = b.vertex;
  return {{(p.x + q.x) * 0.5, (p.y + q.y) * 0.5, (p.z + q.z) * 0.5, (p.w + q.w) * 0.5}, midpoint(a.weight, b.weight)};
}

/// The corners of the four parts in the order of figure 11.
template <class Point>
std::array<std::array<Point, 4>, 4> quarter(const std::array<Point, 4>& q) {
  const auto& [a, b, c, d] = q;
  const Point ab = midpoint(a, b), bc = midpoint(b, c), cd = midpoint(c, d), ad = midpoint(a, d);
  const Point abcd = midpoint(ab, cd);
  return {{{a, ab, abcd, ad}, {ab, b, bc, abcd}, {abcd, bc, c, cd}, {ad, abcd, cd, d}}};
}

/// Whether both tests of figure 11 find a parallelogram.
template <std::size_t N>
bool is_parallelogram(const std::array<std::array<double, N>, 4>& q, double threshold) {
  const auto v1 = difference(q[0], q[1]), v2 = difference(q[2], q[1]);
  const auto v3 = difference(q[2], q[3]), v4 = difference(q[0], q[3]);
  return std::abs(dot(v1, v2) - dot(v3, v4)) < threshold && std::abs(dot(v1, v4) - dot(v2, v3)) < threshold;
}

/// Figure 10; the viewport's area where a vertex is not in front of the eye.
double projected_area(const std::array<WindowVertex, 4>& vertex, const View& view) {
  double twice = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex &p = vertex[i], &q = vertex[(i + 1) % 4];
    if (!(p.w > 0)) return double{1} * view.width * view.height;
    twice += p.x / p.w * (q.y / q.w) - p.y / p.w * (q.x / q.w);
  }
  return std::abs(twice) / 2;
}

/// Figure 11; `area` is infinite where it is not tested. Parts that `skip` names are left out.
template <class Skip, class Emit>
void subdivide_part(const SubQuad& part, double area, int level, double threshold, Skip& skip, Emit& emit) {
  if (skip(part)) return;
  if (area < adaptive_area || level == adaptive_levels ||
      (is_parallelogram(part.object, threshold) && is_parallelogram(part.texture, threshold / 10)))
    return emit(part);
  const auto corner = quarter(part.corner);
  const auto object = quarter(part.object);
  const auto texture = quarter(part.texture);
  for (std::size_t i = 0; i < 4; ++i)
    subdivide_part(SubQuad{corner[i], object[i], texture[i]}, area / 4, level + 1, threshold, skip, emit);
}

constexpr auto no_part = [](const SubQuad&) { return false; };

template <class Skip, class Emit>
void subdivide_quad(const Quad& quad, const View& view, double threshold, Skip&& skip, Emit&& emit) {
  const SubQuad whole{weighted_corners(quad), quad.object, quad.texture};
  if (is_triangle(quad)) return emit(whole);
  const double area = off_plane(quad.object) > planar ? HUGE_VAL : projected_area(quad.vertex, view);
  subdivide_part(whole, area, 0, threshold, skip, emit);
}

/// Vertices of an emitted quad strictly inside an edge of another. Parts share an edge only where one is the other
/// halved so and so often, and a point of it is a vertex only if the midpoints above it are: halving edges finds all.
class TVertices {
 public:
  void add(const std::array<Vec3, 4>& quad) {
    for (std::size_t i = 0; i < 4; ++i) {
      vertices_.push_back(quad[i]);
      edges_.push_back({quad[i], quad[(i + 1) % 4]});
    }
  }

  std::uint64_t count() {
    std::ranges::sort(vertices_);
    std::vector<Vec3> found;
    for (const auto& [p, q] : edges_) halve(p, q, found);
    std::ranges::sort(found);
    return static_cast<std::uint64_t>(std::unique(found.begin(), found.end()) - found.begin());
  }

 private:
  void halve(const Vec3& p, const Vec3& q, std::vector<Vec3>& found) const {
    const Vec3 m = midpoint(p, q);
    if (m == p || m == q || !std::ranges::binary_search(vertices_, m)) return;
    found.push_back(m);
    halve(p, m, found);
    halve(m, q, found);
  }

  std::vector<Vec3> vertices_;
  std::vector<std::array<Vec3, 2>> edges_;
};

class Adaptive final : public Method {
 public:
  explicit Adaptive(double threshold) : threshold_(threshold) {}

  std::string name() const override { return knob_name("adaptive", threshold_); }
  bool needs_object_space() const override { return true; }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    const auto unseen = [&](const SubQuad& part) {
      const auto& c = part.corner;
      return out_of_view({c[0].vertex, c[1].vertex, c[2].vertex, c[3].vertex}, view);
    };
    subdivide_quad(quad, view, threshold_, unseen, [&](const SubQuad& part) { draw_split02(part.corner, view, out); });
  }

  Census census(std::span<const Quad> quads, const View& view) const override {
    Census census;
    census.quads = quads.size();
    TVertices t_vertices;
    for (const Quad& quad : quads) {
      const std::uint64_t triangles = is_triangle(quad) ? 1 : 2;
      subdivide_quad(quad, view, threshold_, no_part, [&](const SubQuad& part) {
        ++census.emitted_quads;
        census.triangles += triangles;
        t_vertices.add(part.object);
      });
    }
    census.t_vertices = t_vertices.count();
    return census;
  }

  /// The sub-quads, not their diagonals.
  std::vector<std::vector<WindowVertex>> wireframe(const Quad& quad, const View& view) const override {
    std::vector<std::vector<WindowVertex>> parts;
    subdivide_quad(quad, view, threshold_, no_part, [&](const SubQuad& part) {
      const auto& c = part.corner;
      parts.push_back({c[0].vertex, c[1].vertex, c[2].vertex, c[3].vertex});
    });
    return parts;
  }

 private:
  double threshold_;
};

}  // namespace

std::vector<SubQuad> subdivide(const Quad& quad, const View& view, double threshold) {
  std::vector<SubQuad> parts;
  subdivide_quad(quad, view, threshold, no_part, [&](const SubQuad& part) { parts.push_back(part); });
  return parts;
}

std::unique_ptr<Method> make_adaptive(double threshold) { return std::make_unique<Adaptive>(threshold); }

}  // namespace quadrille::golden::methods
