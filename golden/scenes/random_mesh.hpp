// Random planar meshes whose coverage is known beforehand: together the cells tile a rectangle exactly once.
#pragma once

#include "model/port/records.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::golden {

struct RandomMeshOptions {
  int width = 512, height = 512;  ///< viewport in pixels; the rectangle lies inside it
  int columns = 16, rows = 16;    ///< cells of the grid before jitter
  double jitter = 0.9;            ///< largest displacement, in grid spacings; above about 0.3 concave cells appear
  double tie_share = 0;           ///< share of vertices at pixel centres; above 0 the rectangle's corners are too
  double triangle_share = 0.2;    ///< share of triangles that stay triangles instead of joining a neighbour
  bool vary_w = false;            ///< give vertices w of 1/2, 1, 2, 4 (exact: the window positions stay on the grid)
};

/// Window positions in units of 1/256 px (y down, pixel (px, py) has its centre at (256 px + 128, 256 py + 128)).
struct RandomMesh {
  std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< the rectangle that the cells tile
  std::vector<std::array<std::int64_t, 2>> vertices;
  std::vector<std::array<int, 4>> cells;                  ///< vertex indices as drawn; a triangle repeats one
  std::size_t triangles = 0, concave = 0, clockwise = 0;  ///< clockwise: as seen on the screen
  std::vector<WindowQuad> quads;                          ///< one per cell, id = index, attributes = the four weights

  /// Whether the top-left rule gives this pixel to the rectangle: then exactly one cell draws it, else none.
  bool expected(int px, int py) const {
    const std::int64_t x = std::int64_t{256} * px + 128, y = std::int64_t{256} * py + 128;
    return x >= x0 && x < x1 && y >= y0 && y < y1;
  }
};

/// A jittered grid, every cell cut into two triangles, most of which are then joined in random pairs. Each vertex moves
/// only where all cells around it stay simple with positive area (exact orientations of the two triangles of one
/// diagonal; straight corners are allowed), so the winding numbers of the cells add up to the rectangle's: every point
/// is covered exactly once. Windings, start corners and order of the cells are random. Integer arithmetic throughout
/// but for the jitter's draw. Throws std::invalid_argument when the viewport is too small for the grid (one pixel per
/// cell and one to spare) or an option is out of range (shares 0 to 1, jitter 0 to 4).
RandomMesh make_random_mesh(std::uint64_t seed, const RandomMeshOptions& options = {});

}  // namespace quadrille::golden
