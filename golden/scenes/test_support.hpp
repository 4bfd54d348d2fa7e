// Helpers of the tests in this folder: independent of the code under test.
#pragma once

#include "model/port/records.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

namespace quadrille::golden {

/// FNV-1a over the bits of every number.
inline std::uint64_t hash_quads(const std::vector<WindowQuad>& quads) {
  std::uint64_t h = 0xcbf29ce484222325u;
  const auto add = [&](std::uint64_t word) {
    for (int i = 0; i < 8; ++i) h = (h ^ (word >> (8 * i) & 255)) * 0x100000001b3u;
  };
  for (const WindowQuad& quad : quads) {
    add(quad.id);
    for (std::size_t i = 0; i < 4; ++i) {
      const WindowVertex& v = quad.vertex[i];
      for (const double d : {v.x, v.y, v.z, v.w}) add(std::bit_cast<std::uint64_t>(d));
      for (const double d : quad.attribute[i]) add(std::bit_cast<std::uint64_t>(d));
    }
  }
  return h;
}

inline double det3(const WindowVertex& a, const WindowVertex& b, const WindowVertex& c) {
  return a.x * (b.y * c.w - b.w * c.y) - a.y * (b.x * c.w - b.w * c.x) + a.w * (b.x * c.y - b.y * c.x);
}

/// The eye strictly inside the tetrahedron of the corners.
inline bool holds_eye(const WindowQuad& q) {
  const auto& v = q.vertex;
  const double d[4] = {det3(v[1], v[2], v[3]), -det3(v[0], v[2], v[3]), det3(v[0], v[1], v[3]),
                       -det3(v[0], v[1], v[2])};
  return (d[0] > 0 && d[1] > 0 && d[2] > 0 && d[3] > 0) || (d[0] < 0 && d[1] < 0 && d[2] < 0 && d[3] < 0);
}

/// Whether the quad shows at a point, by half-angles as complex arguments (no formula in common with the library): a
/// point is covered where the four weights have one sign, and visible where their sum with w has that sign too.
inline bool probe_visible(const WindowQuad& quad, double x, double y) {
  std::array<std::complex<double>, 4> s;
  for (std::size_t i = 0; i < 4; ++i) {
    const WindowVertex& v = quad.vertex[i];
    s[i] = {v.x - v.w * x, v.y - v.w * y};
    if (s[i] == std::complex<double>{}) return false;
  }
  std::array<double, 4> half_tan{};
  for (std::size_t i = 0; i < 4; ++i) half_tan[i] = std::tan(std::arg(s[(i + 1) & 3] / s[i]) / 2);
  double sum_w = 0, sum = 0;
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double m = (half_tan[(i + 3) & 3] + half_tan[i]) / std::abs(s[i]);
    sum += m;
    sum_w += m * quad.vertex[i].w;
    const double noise = 1e-12 * (std::abs(half_tan[i]) + std::abs(half_tan[(i + 3) & 3])) / std::abs(s[i]);
    positive += m > noise ? 1 : 0;
    negative += m < -noise ? 1 : 0;
  }
  return (positive == 0) != (negative == 0) && sum * sum_w > 0;
}

}  // namespace quadrille::golden
