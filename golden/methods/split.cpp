// The diagonal split: a quad as two triangles. Those of a concave or crossed quad may stick out or cover pixels twice;
// both are kept, for that is what the split shows.
#include "golden/methods/builders.hpp"
#include "golden/methods/weighted_triangle.hpp"

namespace quadrille::golden::methods {
namespace {

class Split final : public Method {
 public:
  explicit Split(Diagonal diagonal) : diagonal_(diagonal) {}

  std::string name() const override { return diagonal_ == Diagonal::v0_v2 ? "split02" : "split13"; }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    const auto corner = weighted_corners(quad);
    if (is_triangle(quad)) return draw_triangle(corner[0], corner[1], corner[2], view, out);
    if (diagonal_ == Diagonal::v0_v2) return draw_split02(corner, view, out);
    draw_triangle(corner[1], corner[2], corner[3], view, out);
    draw_triangle(corner[1], corner[3], corner[0], view, out);
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    Census census;
    census.quads = census.emitted_quads = quads.size();
    for (const Quad& quad : quads) census.triangles += is_triangle(quad) ? 1 : 2;
    return census;
  }

  std::vector<std::vector<WindowVertex>> wireframe(const Quad& quad, const View&) const override {
    const auto& [v0, v1, v2, v3] = quad.vertex;
    if (is_triangle(quad)) return {{v0, v1, v2}};
    if (diagonal_ == Diagonal::v0_v2) return {{v0, v1, v2}, {v0, v2, v3}};
    return {{v1, v2, v3}, {v1, v3, v0}};
  }

 private:
  Diagonal diagonal_;
};

}  // namespace

std::unique_ptr<Method> make_split(Diagonal diagonal) { return std::make_unique<Split>(diagonal); }

}  // namespace quadrille::golden::methods
