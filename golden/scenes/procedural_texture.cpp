#include "golden/scenes/procedural_texture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace quadrille::golden {
namespace {

Vec3 mix(const Vec3& a, const Vec3& b, double t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

double wrap(double x) {
  const double f = x - std::floor(x);
  return std::isfinite(f) && f < 1 ? f : 0;
}

/// Distance of a point from the nearest line of a grid with spacing 1, in spacings.
double line_distance(double x) {
  const double f = wrap(x);
  return std::min(f, 1 - f);
}

Vec3 checks(double u, double v, int count) {
  const double a = u * count, b = v * count;
  const bool odd = (static_cast<int>(a) + static_cast<int>(b)) % 2 != 0;
  const Vec3 warm = mix({0.98, 0.80, 0.30}, {0.90, 0.25, 0.20}, u);
  const Vec3 cool = mix({0.15, 0.25, 0.60}, {0.20, 0.75, 0.70}, v);
  const double line = std::min(line_distance(a), line_distance(b));
  return mix({0.05, 0.05, 0.08}, odd ? warm : cool, std::clamp((line - 0.03) / 0.02, 0.0, 1.0));
}

/// Smooth noise on a lattice of columns × rows cells that wraps in u, in [0, 1].
double noise(double u, double v, int columns, int rows) {
  const auto lattice = [&](int i, int j) {
    std::uint32_t h = static_cast<std::uint32_t>(i % columns) * 73856093u ^ static_cast<std::uint32_t>(j) * 19349663u;
    h += static_cast<std::uint32_t>(columns);
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    h ^= h >> 15;
    return static_cast<double>(h >> 8) * 0x1p-24;
  };
  const double a = u * columns, b = v * rows;
  const int i = static_cast<int>(a), j = static_cast<int>(b);
  const double fa = a - i, fb = b - j;
  const double sa = fa * fa * (3 - 2 * fa), sb = fb * fb * (3 - 2 * fb);
  const double bottom = lattice(i, j) + (lattice(i + 1, j) - lattice(i, j)) * sa;
  const double top = lattice(i, j + 1) + (lattice(i + 1, j + 1) - lattice(i, j + 1)) * sa;
  return bottom + (top - bottom) * sb;
}

Vec3 globe(double u, double v) {
  const double height = 0.6 * noise(u, v, 6, 4) + 0.28 * noise(u, v, 14, 9) + 0.12 * noise(u, v, 40, 24);
  const double latitude = std::abs(2 * v - 1);
  Vec3 colour = height < 0.47
                    ? mix({0.05, 0.15, 0.40}, {0.20, 0.50, 0.75}, std::clamp(height / 0.47, 0.0, 1.0))
                    : mix({0.25, 0.55, 0.20}, {0.75, 0.65, 0.40}, std::clamp((height - 0.47) / 0.2, 0.0, 1.0));
  colour = mix(colour, {0.95, 0.97, 1.0}, std::clamp((latitude - 0.85 + 0.1 * (height - 0.5)) / 0.05, 0.0, 1.0));
  const double line = std::min(line_distance(u * 24), line_distance(v * 12));
  return mix({0.02, 0.02, 0.05}, colour, std::clamp((line - 0.03) / 0.02, 0.0, 1.0));
}

}  // namespace

std::string_view texture_name(TextureKind kind) {
  switch (kind) {
    case TextureKind::checker:
      return "checker";
    case TextureKind::fine:
      return "fine";
    case TextureKind::globe:
      return "globe";
  }
  return "";
}

Vec3 procedural_texture(TextureKind kind, double u, double v) {
  const double s = wrap(u), t = wrap(v);
  switch (kind) {
    case TextureKind::checker:
      return checks(s, t, 8);
    case TextureKind::fine:
      return checks(s, t, 16);
    case TextureKind::globe:
      return globe(s, t);
  }
  return {};
}

std::vector<Vec3> procedural_image(TextureKind kind, int width, int height) {
  if (width < 1 || height < 1) throw std::invalid_argument("procedural texture: size must be at least 1x1");
  std::vector<Vec3> image;
  image.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image.push_back(procedural_texture(kind, (x + 0.5) / width, 1 - (y + 0.5) / height));
  }
  return image;
}

}  // namespace quadrille::golden
