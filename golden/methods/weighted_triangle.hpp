// Triangles whose corners are points of a quad: what split, refine and adaptive draw.
#pragma once

#include "golden/methods/homogeneous.hpp"

namespace quadrille::golden::methods {

/// A point of a quad's surface: vertex = sum(weight_i V_i) in homogeneous window coordinates.
struct WeightedVertex {
  WindowVertex vertex;
  std::array<double, 4> weight{};
};

/// The quad's own corners.
inline std::array<WeightedVertex, 4> weighted_corners(const Quad& quad) {
  std::array<WeightedVertex, 4> corner{};
  for (std::size_t i = 0; i < 4; ++i) {
    corner[i].vertex = quad.vertex[i];
    corner[i].weight[i] = 1;
  }
  return corner;
}

inline bool same_vertex(const WindowVertex& p, const WindowVertex& q) {
  return p.x == q.x && p.y == q.y && p.z == q.z && p.w == q.w;
}

/// A triangle given as a quad: its last corner repeats the third in everything. A collapsed edge whose ends differ in
/// texture or attributes makes no triangle: what is seen depends on the end that is drawn.
inline bool is_triangle(const Quad& quad) {
  return same_vertex(quad.vertex[2], quad.vertex[3]) && quad.object[2] == quad.object[3] &&
         quad.texture[2] == quad.texture[3] && quad.attribute[2] == quad.attribute[3];
}

/// Appends the fragments of one triangle; lambda = sum of barycentric coordinate times weight, in space with
/// View::perspective, on the screen without.
inline void draw_triangle(const WeightedVertex& a, const WeightedVertex& b, const WeightedVertex& c, const View& view,
                          std::vector<MethodSample>& out) {
  raster_triangle({a.vertex, b.vertex, c.vertex}, view, [&](const TrianglePixel& pixel) {
    const std::array<double, 3>& share = view.perspective ? pixel.space : pixel.screen;
    MethodSample sample{pixel.x, pixel.y, pixel.front, false, pixel.z, {}};
    for (std::size_t i = 0; i < 4; ++i)
      sample.lambda[i] = share[0] * a.weight[i] + share[1] * b.weight[i] + share[2] * c.weight[i];
    out.push_back(sample);
  });
}

/// A quad of such points as OpenGL would draw it: triangles (0, 1, 2) and (0, 2, 3).
inline void draw_split02(const std::array<WeightedVertex, 4>& corner, const View& view,
                         std::vector<MethodSample>& out) {
  draw_triangle(corner[0], corner[1], corner[2], view, out);
  draw_triangle(corner[0], corner[2], corner[3], view, out);
}

}  // namespace quadrille::golden::methods
