#include "tb/studies/peer_loads.hpp"

#include "golden/scenes/projection.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace quadrille::tb {
namespace {

constexpr std::array<golden::Vec2, 4> unit_square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

void set_vertex(WindowQuad& quad, std::size_t corner, double x, double y, double z, double w) {
  quad.vertex[corner] = {x * w, y * w, z * w, w};
  quad.attribute[corner] = {unit_square[corner][0], unit_square[corner][1]};
}

}  // namespace

std::vector<WindowQuad> large_quad(int width, int height) {
  WindowQuad quad;
  const double x = width, y = height;
  set_vertex(quad, 0, 0.02 * x, 0.03 * y, 0.3, 1.0);
  set_vertex(quad, 1, 0.98 * x, 0.07 * y, 0.4, 1.3);
  set_vertex(quad, 2, 0.94 * x, 0.97 * y, 0.6, 1.7);
  set_vertex(quad, 3, 0.05 * x, 0.93 * y, 0.5, 1.2);
  return {quad};
}

std::vector<WindowQuad> sphere_quads(int n, int width, int height) {
  golden::Mesh mesh;
  for (int band = 0; band <= n; ++band) {
    for (int segment = 0; segment <= n; ++segment) {
      const double u = static_cast<double>(segment) / n, v = static_cast<double>(band) / n;
      const double longitude = 2 * std::numbers::pi * (segment % n) / n, latitude = std::numbers::pi * (v - 0.5);
      const double radius = band % n == 0 ? 0.0 : std::cos(latitude);  // the poles are points
      mesh.positions.push_back({radius * std::sin(longitude), std::sin(latitude), radius * std::cos(longitude)});
      mesh.texcoords.push_back({u, v});
    }
  }
  for (int band = 0; band < n; ++band) {
    for (int segment = 0; segment < n; ++segment) {
      const int first = band * (n + 1) + segment;
      golden::Face face;
      for (const int corner : {first, first + 1, first + n + 2, first + n + 1}) face.push_back({corner, corner, -1});
      mesh.faces.push_back(std::move(face));
    }
  }
  return golden::project_mesh(mesh, golden::frame_mesh(mesh, width, height), width, height,
                              {.attributes = golden::AttributeSet::uv})
      .quads;
}

}  // namespace quadrille::tb
