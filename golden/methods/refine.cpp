// N × N refinement by bilinear interpolation in space (Hormann & Tarini section 1, figures 10 and 11): projection is
// linear in homogeneous coordinates, so the grid's points are interpolated there. A non-planar quad may fold over
// itself on the screen; both layers are drawn.
#include "golden/methods/builders.hpp"
#include "golden/methods/weighted_triangle.hpp"

namespace quadrille::golden::methods {
namespace {

class Refine final : public Method {
 public:
  explicit Refine(int n) : n_(n) {}

  std::string name() const override { return "refine:" + std::to_string(n_); }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    if (out_of_view(quad.vertex, view)) return;
    for_each_cell(quad, [&](const std::array<WeightedVertex, 4>& corner) { draw_split02(corner, view, out); });
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    const auto n = static_cast<std::uint64_t>(n_);
    Census census;
    census.quads = quads.size();
    census.emitted_quads = n * n * quads.size();
    // A triangle's last row of cells shrinks to triangles.
    for (const Quad& quad : quads) census.triangles += 2 * n * n - (is_triangle(quad) ? n : 0);
    return census;
  }

  /// The cells, not their diagonals.
  std::vector<std::vector<WindowVertex>> wireframe(const Quad& quad, const View&) const override {
    std::vector<std::vector<WindowVertex>> cells;
    for_each_cell(quad, [&](const std::array<WeightedVertex, 4>& corner) {
      cells.push_back({corner[0].vertex, corner[1].vertex, corner[2].vertex, corner[3].vertex});
    });
    return cells;
  }

 private:
  template <class Visit>
  void for_each_cell(const Quad& quad, Visit&& visit) const {
    const auto size = static_cast<std::size_t>(n_) + 1;
    std::vector<WeightedVertex> below(size), above(size);
    for (int i = 0; i <= n_; ++i) below[static_cast<std::size_t>(i)] = point(quad, i, 0);
    for (int j = 1; j <= n_; ++j) {
      for (int i = 0; i <= n_; ++i) above[static_cast<std::size_t>(i)] = point(quad, i, j);
      for (std::size_t i = 1; i < size; ++i) visit({below[i - 1], below[i], above[i], above[i - 1]});
      std::swap(below, above);
    }
  }

  /// The grid's point at s = i/N, t = j/N. Every weight is one exactly rounded quotient and the sum has two terms on an
  /// edge: the point of an edge is the same number whichever quad, and from whichever end, computes it.
  WeightedVertex point(const Quad& quad, int i, int j) const {
    const double n = n_, cells = n * n;
    WeightedVertex p;
    p.weight = {(n - i) * (n - j) / cells, i * (n - j) / cells, 1.0 * i * j / cells, (n - i) * j / cells};
    const auto blend = [&](double WindowVertex::*coordinate) {
      const auto term = [&](std::size_t k) { return p.weight[k] * quad.vertex[k].*coordinate; };
      return (term(0) + term(1)) + (term(2) + term(3));
    };
    p.vertex = {blend(&WindowVertex::x), blend(&WindowVertex::y), blend(&WindowVertex::z), blend(&WindowVertex::w)};
    return p;
  }

  int n_;
};

}  // namespace

std::unique_ptr<Method> make_refine(int n) { return std::make_unique<Refine>(n); }

}  // namespace quadrille::golden::methods
