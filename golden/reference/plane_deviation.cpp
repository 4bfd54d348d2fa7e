#include "golden/reference/plane_deviation.hpp"

#include "golden/reference/port_number.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace quadrille::golden {
namespace {

using Wide = __int128;
using Real = long double;
using Corners = std::array<Real, 4>;

/// (b - a) × (c - a).
Wide cross(const SnappedVertex& a, const SnappedVertex& b, const SnappedVertex& c) {
  const Wide ux = Wide{b.x} - a.x, uy = Wide{b.y} - a.y, vx = Wide{c.x} - a.x, vy = Wide{c.y} - a.y;
  return ux * vy - uy * vx;
}

/// What corner i is off the plane through the other three: its barycentric coordinates there times their numbers.
Real off_plane(const SnappedQuad& quad, std::size_t i, const Corners& f) {
  const std::size_t j = (i + 1) % 4, k = (i + 2) % 4, l = (i + 3) % 4;
  const auto& v = quad.vertex;
  const Real whole = static_cast<Real>(cross(v[j], v[k], v[l]));
  const Real at_j = static_cast<Real>(cross(v[i], v[k], v[l])), at_k = static_cast<Real>(cross(v[j], v[i], v[l])),
             at_l = static_cast<Real>(cross(v[j], v[k], v[i]));
  return std::fabs(f[i] - (at_j * f[j] + at_k * f[k] + at_l * f[l]) / whole);
}

Real largest_of(const Corners& f) {
  Real largest = 0;
  for (const Real v : f) largest = std::max(largest, std::fabs(v));
  return largest;
}

}  // namespace

double PlaneDeviation::largest() const { return std::max(depth, *std::ranges::max_element(attribute)); }

PlaneDeviation plane_deviation(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  PlaneDeviation r;
  const auto& v = quad.vertex;
  int left = 0, right = 0;
  bool ordinary = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const Wide turn = cross(v[i], v[(i + 1) % 4], v[(i + 2) % 4]);
    left += turn > 0;
    right += turn < 0;
    ordinary = ordinary && v[i].w == std::int32_t{1} << config.frac();
  }
  r.possible = ordinary && (left == 4 || right == 4);
  if (!r.possible) return r;

  // The corner whose plane's triangle is the largest: there every value is nearest to its plane.
  std::size_t corner = 0;
  Wide widest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Wide area = cross(v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]), size = area < 0 ? -area : area;
    if (size > widest) widest = size, corner = i;
  }
  const auto corners = [&](const auto& number) {
    Corners f;
    for (std::size_t i = 0; i < 4; ++i) f[i] = port_value(number(v[i]), config.significand_bits);
    return f;
  };
  if (state.depth) {
    const Corners z = corners([](const SnappedVertex& p) { return p.z; });
    const Real range = largest_of(z);
    r.depth_range = static_cast<double>(range);
    if (range != 0) r.depth = static_cast<double>(off_plane(quad, corner, z) / range);
  }
  const Corners k = state.perspective ? corners([](const SnappedVertex& p) { return p.k; }) : Corners{1, 1, 1, 1};
  const Real off_k = off_plane(quad, corner, k), least_k = *std::ranges::min_element(k);
  for (std::size_t j = 0; j < static_cast<std::size_t>(state.attributes); ++j) {
    const Corners b = corners([&](const SnappedVertex& p) { return p.attribute[j]; });
    Corners a;
    for (std::size_t i = 0; i < 4; ++i) a[i] = b[i] / k[i];
    const Real range = largest_of(a);
    r.attribute_range[j] = static_cast<double>(range);
    if (range != 0)
      r.attribute[j] = static_cast<double>((off_plane(quad, corner, b) + range * off_k) / (least_k * range));
  }
  return r;
}

double plane_allowance(const PlaneDeviation& deviation, const Config& config, const DrawState& state) {
  const int t = config.plane_tolerance_bits;
  if (t < 1 || t > 16 || (state.skip & skip_plane) == 0 || !deviation.possible) return 0;
  const double tolerance = std::ldexp(1.0, -t);
  return deviation.largest() <= tolerance ? tolerance : 0;
}

}  // namespace quadrille::golden
