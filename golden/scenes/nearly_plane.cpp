#include "golden/scenes/nearly_plane.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace quadrille::golden {

WindowQuad nearly_plane_quad(Prng& rng, std::uint32_t id, const NearlyPlane& kind) {
  WindowQuad q;
  q.id = id;
  const double cx = rng.uniform(kind.picture / 3, 2 * kind.picture / 3),
               cy = rng.uniform(kind.picture / 3, 2 * kind.picture / 3), angle = rng.uniform(0, 2 * std::numbers::pi),
               half_x = rng.uniform(kind.half_low, kind.half_high), half_y = rng.uniform(kind.half_low, kind.half_high);
  const bool mirrored = rng.chance(0.5);
  const double tilt_x = rng.uniform(-kind.tilt, kind.tilt) / 64, tilt_y = rng.uniform(-kind.tilt, kind.tilt) / 64;
  const auto depth = static_cast<std::size_t>(kind.attributes);
  std::vector<std::array<double, 3>> plane(depth + 1);  // the attributes, depth: at the centre, along x, along y
  for (auto& p : plane)
    for (double& v : p) v = rng.uniform(-1, 1);
  const auto bent = static_cast<std::size_t>(rng.integer(0, kind.attributes));
  for (std::size_t i = 0; i < 4; ++i) {
    const double u = (i == 1 || i == 2 ? 1 : -1) * half_x, v = (i >= 2 ? 1 : -1) * half_y * (mirrored ? -1 : 1);
    const double dx = std::cos(angle) * u - std::sin(angle) * v, dy = std::sin(angle) * u + std::cos(angle) * v;
    const double w = 1 / (1 + tilt_x * dx + tilt_y * dy);
    const auto value = [&](std::size_t n) {
      const double here = plane[n][0] + plane[n][1] * dx / 40 + plane[n][2] * dy / 40;
      return here + (i == 3 && n == bent ? kind.bend * (std::fabs(plane[n][0]) + 1) : 0);
    };
    const double z = 0.5 + value(depth) / 16;
    q.vertex[i] = {(cx + dx) * w, (cy + dy) * w, z * w, w};
    for (std::size_t j = 0; j < depth; ++j) q.attribute[i].push_back(value(j) * w);
  }
  return q;
}

}  // namespace quadrille::golden
