#include "tb/studies/peer_loads.hpp"

#include "golden/scenes/projection.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

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

WindowQuad ScatteredQuads::quad(std::uint32_t i) const {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32), i};
  std::mt19937 random(sequence);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * 0x1p-32 * static_cast<double>(random());
  };
  const double angle = uniform(0, 2 * std::numbers::pi), reach = 0.9 * side_;
  const double x = uniform(reach, size_ - reach), y = uniform(reach, size_ - reach);
  WindowQuad quad;
  quad.id = i;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const double a = side_ * (unit_square[corner][0] - 0.5 + uniform(-0.1, 0.1));
    const double b = side_ * (unit_square[corner][1] - 0.5 + uniform(-0.1, 0.1));
    set_vertex(quad, corner, x + a * std::cos(angle) - b * std::sin(angle),
               y + a * std::sin(angle) + b * std::cos(angle), uniform(0.2, 0.8), uniform(1, 2));
  }
  return quad;
}

}  // namespace quadrille::tb
