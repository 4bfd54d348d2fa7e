// Quad meshes: Bloomenthal's sphere with collapsed pole edges, and a smooth mesh with normals in place of a
// Phong-shaded head.
#include "golden/scenes/scene_builders.hpp"

#include <cmath>

namespace quadrille::golden {
namespace {

Scene sphere() {
  Scene scene;
  scene.mesh = sphere_mesh(16, 8);
  scene.camera.eye = {1.2, 2.2, 3.0};
  scene.camera.fovy = 34;
  scene.camera.near = 1;
  scene.camera.far = 10;
  scene.texture = TextureKind::globe;
  return scene;
}

/// Height of a mask over the plane and its derivatives: a dome with a nose, brows, eye sockets and a chin, each bump
/// a / (1 + x²/sx² + y²/sy²)².
struct Height {
  double z = 0, dx = 0, dy = 0;
};

Height mask(double x, double y) {
  struct Bump {
    double x, y, sx, sy, amount;
  };
  static constexpr std::array<Bump, 8> bumps{{{0, 0, 1.3, 1.6, 1.1},
                                              {0, -0.05, 0.16, 0.34, 0.45},
                                              {-0.36, 0.30, 0.24, 0.16, -0.26},
                                              {0.36, 0.30, 0.24, 0.16, -0.26},
                                              {-0.36, 0.58, 0.34, 0.14, 0.14},
                                              {0.36, 0.58, 0.34, 0.14, 0.14},
                                              {0, -0.48, 0.32, 0.12, 0.15},
                                              {0, -0.90, 0.30, 0.22, 0.20}}};
  Height h;
  for (const Bump& b : bumps) {
    const double u = (x - b.x) / b.sx, v = (y - b.y) / b.sy;
    const double q = 1 + u * u + v * v;
    h.z += b.amount / (q * q);
    h.dx -= 4 * b.amount * u / (b.sx * q * q * q);
    h.dy -= 4 * b.amount * v / (b.sy * q * q * q);
  }
  return h;
}

/// 13 × 16 quads over an oval; the normals are those of the surface, not of the facets.
Scene phong_mesh() {
  constexpr int columns = 13, rows = 16;
  Scene scene;
  Mesh& mesh = scene.mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const double s = 2.0 * i / columns - 1, t = 2.0 * j / rows - 1;
      // The square [−1, 1]² onto a disc, then an oval.
      const double x = 1.0 * s * std::sqrt(1 - t * t / 2), y = 1.3 * t * std::sqrt(1 - s * s / 2);
      const Height h = mask(x, y);
      mesh.positions.push_back({x, y, h.z});
      mesh.normals.push_back({-h.dx, -h.dy, 1});
      mesh.texcoords.push_back({static_cast<double>(i) / columns, static_cast<double>(j) / rows});
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      Face face;
      for (const auto& [di, dj] : {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
        const int k = (j + dj) * (columns + 1) + i + di;
        face.push_back({k, k, k});
      }
      mesh.faces.push_back(std::move(face));
    }
  }
  scene.camera.eye = {1.6, 0.7, 4.0};
  scene.camera.target = {0, 0, 0.5};
  scene.camera.fovy = 40;
  scene.camera.near = 1;
  scene.camera.far = 10;
  scene.texture = TextureKind::checker;
  scene.shade = "normal";
  return scene;
}

/// The same without normals: whoever draws it computes them from the faces.
Scene phong_mesh_smooth() {
  Scene scene = phong_mesh();
  scene.mesh.normals.clear();
  for (Face& face : scene.mesh.faces)
    for (Corner& corner : face) corner.normal = -1;
  return scene;
}

/// A few quads of it fill the picture, so that a crease has many pixels on either side.
Scene phong_mesh_detail() {
  Scene scene = phong_mesh();
  scene.camera.target = {0.12, 0.2, 0.75};
  scene.camera.fovy = 9;
  return scene;
}

constexpr std::array<SceneEntry, 4> entries{{
    {"sphere", "A textured sphere of 16 × 8 quads with collapsed edges at the poles", "Bloomenthal 2022, fig. 9",
     sphere},
    {"phong_mesh", "A smooth quad mesh with a normal at every vertex", "Hormann & Tarini 2004, fig. 11", phong_mesh},
    {"phong_mesh_smooth", "The same mesh with normals computed from its geometry", "Hormann & Tarini 2004, fig. 11",
     phong_mesh_smooth},
    {"phong_mesh_detail", "The same mesh close up: about four quads across", "Hormann & Tarini 2004, fig. 11",
     phong_mesh_detail},
}};

}  // namespace

std::span<const SceneEntry> surface_scenes() { return entries; }

}  // namespace quadrille::golden
