#include "golden/scenes/terrain.hpp"

#include <cmath>

namespace quadrille::golden {

Mesh terrain_mesh(int side) {
  Mesh mesh;
  const double half = 0.5 * side;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i)
      mesh.positions.push_back({i - half, -1.5 + 0.7 * std::sin(i / 3.0) * std::cos(j / 4.0), j - half});
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const int a = j * (side + 1) + i;
      Face face;
      for (const int corner : {a, a + side + 1, a + side + 2, a + 1}) face.push_back({corner, -1, -1});
      mesh.faces.push_back(std::move(face));
    }
  }
  return mesh;
}

Camera terrain_camera(int side, bool inside) {
  Camera camera;
  camera.fovy = 60;
  camera.far = 4.0 * side;
  if (inside) {
    camera.eye = {0.1, 1, 0.2};
    camera.target = {3, 0.2, -10};
  } else {
    camera.eye = {-0.7 * side, 0.25 * side, 0};
  }
  return camera;
}

}  // namespace quadrille::golden
