#include "golden/scenes/shading.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::golden {
namespace {

double scalar_product(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A colour that an eye tells from what is not drawn and from what is undefined.
bool stands_out(const Vec3& colour) {
  constexpr double least = 0.3;
  const auto far_from = [&](const Vec3& other) {
    return std::max({std::fabs(colour[0] - other[0]), std::fabs(colour[1] - other[1]),
                     std::fabs(colour[2] - other[2])}) >= least;
  };
  return far_from(background_colour) && far_from(undefined_colour);
}

}  // namespace

Vec3 unit_vector(const Vec3& v) {
  const double length = std::sqrt(scalar_product(v, v));
  return length > 0 ? Vec3{v[0] / length, v[1] / length, v[2] / length} : Vec3{0, 0, 1};
}

double wrapped(double c) {
  constexpr double step = 1.0 / 256;
  return c > -step && c < 1 + step ? std::clamp(c, 0.0, 1.0) : c - std::floor(c);
}

Vec3 phong(Vec3 n, const Vec3& to_eye, const Vec3& to_light) {
  static constexpr Vec3 base{0.78, 0.74, 0.68};
  n = unit_vector(n);
  if (scalar_product(n, to_eye) < 0) n = {-n[0], -n[1], -n[2]};
  const Vec3 half = unit_vector({to_light[0] + to_eye[0], to_light[1] + to_eye[1], to_light[2] + to_eye[2]});
  const double diffuse = 0.18 + 0.75 * std::max(0.0, scalar_product(n, to_light));
  double shine = std::max(0.0, scalar_product(n, half));
  for (int i = 0; i < 5; ++i) shine *= shine;  // to the 32nd
  return {base[0] * diffuse + 0.35 * shine, base[1] * diffuse + 0.35 * shine, base[2] * diffuse + 0.35 * shine};
}

Vec3 facet_normal(const std::array<Vec3, 4>& corner) {
  Vec3 a{}, b{};
  for (std::size_t i = 0; i < 3; ++i) a[i] = corner[2][i] - corner[0][i], b[i] = corner[3][i] - corner[1][i];
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 weight_colour(const std::array<double, 4>& lambda) {
  static constexpr std::array<Vec3, 4> corner{
      {{0.90, 0.22, 0.20}, {0.20, 0.72, 0.30}, {0.22, 0.42, 0.95}, {0.96, 0.86, 0.25}}};
  Vec3 colour{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) colour[c] += lambda[i] * corner[i][c];
  return colour;
}

Vec3 id_colour(std::uint32_t id) {
  std::uint32_t h = id * 0x9e3779b1u;
  for (;;) {
    h ^= h >> 15;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    const auto part = [&](int shift) { return 0.25 + 0.7 * static_cast<double>((h >> shift) & 0xff) / 255; };
    const Vec3 colour{part(0), part(8), part(16)};
    if (stands_out(colour)) return colour;
    h += 0x9e3779b1u;
  }
}

Vec3 cut_colour(const Vec3& flat, double height, double steepness) {
  if (!(steepness > 0)) return flat;
  const double plane = std::round(height), pixels = std::fabs(height - plane) / steepness;
  const double cover = std::clamp(1.25 - pixels, 0.0, 1.0);
  const double line = std::fmod(plane, 2) == 0 ? 0.08 : 0.98;
  return {flat[0] + (line - flat[0]) * cover, flat[1] + (line - flat[1]) * cover, flat[2] + (line - flat[2]) * cover};
}

}  // namespace quadrille::golden
