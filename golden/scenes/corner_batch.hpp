// What the generators of corner groups work with; not for use outside this folder.
#pragma once

#include "golden/scenes/corner_quads.hpp"
#include "model/support/prng.hpp"

#include <array>

namespace quadrille::golden {

/// A point of the integer lattice in homogeneous form, relative to some pixel centre.
struct LatticePoint {
  std::int64_t x = 0, y = 0, w = 0;
};

/// What every generator works with. Draws come in program order, never two in one function call.
struct Batch {
  Prng rng;
  const Config& config;
  const DrawState& state;
  std::vector<std::array<WindowVertex, 4>> quads{};

  int integer(int low, int high) { return static_cast<int>(rng.integer(low, high)); }
  LatticePoint pixel() {  // with room for a few steps around it
    const int x = integer(10, 20);
    return {x, integer(10, 20), 1};
  }
};

/// The vertex w·(pixel + point/w) of a lattice point around a pixel's centre, `step` pixels a unit; z̃ is left 0.
inline WindowVertex vertex_at(const LatticePoint& pixel, const LatticePoint& p, double step) {
  const auto w = static_cast<double>(p.w);
  return {w * (static_cast<double>(pixel.x) + 0.5) + step * static_cast<double>(p.x),
          w * (static_cast<double>(pixel.y) + 0.5) + step * static_cast<double>(p.y), 0, w};
}

/// Ordinary vertices at pixel centres, where interpolation gives a corner's values without an error.
inline std::array<WindowVertex, 4> lattice_polygon(Batch& b) {
  const LatticePoint pixel = b.pixel();
  std::array<WindowVertex, 4> quad;
  for (WindowVertex& v : quad) {
    const int x = b.integer(-8, 8);
    v = vertex_at(pixel, {x, b.integer(-8, 8), 1}, 1);
  }
  return quad;
}

// The groups about positions: corner_geometry.cpp.
void face_plane(Batch& b);
void flat(Batch& b);
void den_w_zero(Batch& b);
void negative_r2(Batch& b);
void two_corner(Batch& b);
void two_edge(Batch& b);
void tall(Batch& b);
void burst(Batch& b);
void extreme(Batch& b);
void far_corner(Batch& b);

// The groups about depth and attributes: corner_values.cpp.
void z_limits(Batch& b);
void minus_zero(Batch& b);
void constant_depth(Batch& b);
void one_corner(Batch& b);
void far_base(Batch& b);
void ties(Batch& b);
void saturation(Batch& b);

// The groups about exact boundaries: corner_boundaries.cpp.
void box(Batch& b);
void plane(Batch& b);
void coarse_depth(Batch& b);
void far_depth(Batch& b);
std::array<double, 4> plane_values(Batch& b);

/// The values of one attribute at the corners of a group's quad.
std::array<double, 4> corner_values(CornerGroup group, Batch& b, std::size_t quad);

/// Makes of a snapped quad what no vertices give: saturation needs it, and so does a depth where sum(M W) = 0.
void change_at_port(CornerGroup group, Batch& b, SnappedQuad& quad);

}  // namespace quadrille::golden
