#include "golden/scenes/simple_engine.hpp"

#include "golden/scenes/regular_weights.hpp"

#include <cmath>

namespace quadrille::golden {
namespace {

/// The quad shows at window position (x, y): not outside it or behind the eye. Points on an edge may go either way.
bool shows(const std::array<WindowVertex, 4>& quad, double x, double y) {
  std::array<double, 4> sx{}, sy{}, r{}, rho{}, a{}, d{}, both{};
  for (std::size_t i = 0; i < 4; ++i) {
    sx[i] = quad[i].x - quad[i].w * x;
    sy[i] = quad[i].y - quad[i].w * y;
    r[i] = std::sqrt(sx[i] * sx[i] + sy[i] * sy[i]);
    if (r[i] == 0) return false;
    rho[i] = 1 / r[i];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) & 3;
    a[i] = sx[i] * sy[j] - sy[i] * sx[j];
  }
  // Expression (12), for either orientation.
  const double a20 = sx[2] * sy[0] - sy[2] * sx[0];
  bool inside = false;
  for (const double o : {1.0, -1.0}) {
    const bool e01 = o * a[0] > 0, e12 = o * a[1] > 0, e23 = o * a[2] > 0, e30 = o * a[3] > 0, e20 = o * a20 > 0;
    inside = inside || (e20 && e01 && e12 && (e23 || e30)) || (!e20 && e23 && e30 && (e01 || e12));
  }
  if (!inside) return false;

  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) & 3;
    both[i] = r[i] * r[j];
    d[i] = sx[i] * sx[j] + sy[i] * sy[j];
    if (d[i] < 0 && a[i] == 0) return false;
  }
  const std::array<double, 4> m = RegularWeights<double>(both, d, a, rho).m;
  double sum = 0, sum_w = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += m[i];
    sum_w += m[i] * quad[i].w;
  }
  return sum * sum_w > 0;
}

}  // namespace

int visible_probes(const std::array<WindowVertex, 4>& quad, int width, int height) {
  int count = 0;
  for (int j = 0; j < 16; ++j) {
    for (int i = 0; i < 16; ++i) {
      const int x = (2 * i + 1) * width / 32, y = (2 * j + 1) * height / 32;
      count += shows(quad, x + 0.5, y + 0.5);
    }
  }
  return count;
}

}  // namespace quadrille::golden
