// Oliveira's adaptive subdivision of textured quads, for the method and for drawing its mesh.
#pragma once

#include "golden/methods/weighted_triangle.hpp"

namespace quadrille::golden::methods {

/// Pixels below which a planar quad is not subdivided (Oliveira, figure 11).
inline constexpr double adaptive_area = 200;
/// Levels at which subdivision ends whatever the thresholds say: a guard, 4^10 parts of a quad.
inline constexpr int adaptive_levels = 10;

/// A quad that is drawn as OpenGL would, by split02.
struct SubQuad {
  std::array<WeightedVertex, 4> corner{};  ///< window position, and its bilinear weights of the given quad's corners
  std::array<Vec3, 4> object{};
  std::array<Vec2, 4> texture{};
};

/// The sub-quads in the order of figure 11. `threshold` is that of object space, texture space has a tenth of it. The
/// projected area is the polygon area of the whole quad, a quarter of it a level down; the viewport's where a vertex
/// has w <= 0. A quad is non-planar, and its area not tested, if a corner is off the plane of the other three by more
/// than 1e-6 of the largest distance between two corners. A triangle (its last corner repeats the third in window,
/// object and texture space) is not subdivided.
std::vector<SubQuad> subdivide(const Quad& quad, const View& view, double threshold);

}  // namespace quadrille::golden::methods
