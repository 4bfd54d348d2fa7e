// Method mvc: mean value coordinates of the whole quad (Hormann & Tarini 2004, sections 3 and 4).
#include "golden/methods/builders.hpp"
#include "golden/methods/mean_value.hpp"
#include "golden/methods/quad_coverage.hpp"
#include "golden/scenes/regular_weights.hpp"

#include <cmath>

namespace quadrille::golden::methods {
namespace {

class MeanValue final : public Method {
 public:
  std::string name() const override { return "mvc"; }

  void draw(const Quad& quad, const View& view, std::vector<MethodSample>& out) const override {
    const auto& vertex = quad.vertex;
    const bool always_visible = all_in_front(vertex);
    std::array<double, 4> share{1, 1, 1, 1};
    if (!view.perspective) {
      for (std::size_t i = 0; i < 4; ++i) share[i] = vertex[i].w;
    }
    raster_quad(vertex, view, [&](int x, int y, bool front) {
      const std::array<double, 4> m = mean_value_weights(vertex, share, x + 0.5, y + 0.5);
      if (!always_visible && !in_front(m, vertex)) return;
      double sum = 0, sum_w = 0, sum_z = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        sum += m[i] * share[i];
        sum_w += m[i] * vertex[i].w;
        sum_z += m[i] * vertex[i].z;
      }
      MethodSample sample{x, y, front, false, sum_z / sum_w, {}};
      for (std::size_t i = 0; i < 4; ++i) sample.lambda[i] = m[i] * share[i] / sum;
      out.push_back(sample);
    });
  }

  Census census(std::span<const Quad> quads, const View&) const override {
    return {.quads = quads.size(), .emitted_quads = quads.size()};
  }
};

}  // namespace

std::array<double, 4> mean_value_weights(const std::array<WindowVertex, 4>& vertex, const std::array<double, 4>& share,
                                         double x, double y) {
  constexpr auto next = [](std::size_t i) { return (i + 1) & 3; };
  std::array<double, 4> m{}, sx{}, sy{};
  std::array<std::size_t, 2> corner{};
  std::size_t corners = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sx[i] = vertex[i].x - vertex[i].w * x;
    sy[i] = vertex[i].y - vertex[i].w * y;
    // A covered point has at most two corners: three leave too many all-zero edges for expression (12).
    if (sx[i] == 0 && sy[i] == 0 && corners < 2) corner[corners++] = i;
  }
  if (corners == 2) {
    m[corner[0]] = share[corner[1]];
    m[corner[1]] = share[corner[0]];
    return m;
  }
  if (corners == 1) {
    m[corner[0]] = 1;
    return m;
  }

  // Cosine and sine of the angle between S_i and S_{i+1}. The sine has the sign that coverage sees, so that no weight
  // of a covered point gets the other one beside an edge.
  std::array<double, 4> rho{}, cosine{}, sine{};
  std::array<std::size_t, 2> edge{};
  std::size_t edges = 0;
  for (std::size_t i = 0; i < 4; ++i) rho[i] = 1 / std::sqrt(sx[i] * sx[i] + sy[i] * sy[i]);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = next(i);
    cosine[i] = (sx[i] * sx[j] + sy[i] * sy[j]) * (rho[i] * rho[j]);
    sine[i] = difference_of_products(sx[i], sy[j], sy[i], sx[j]) * (rho[i] * rho[j]);
    if (sine[i] == 0 && cosine[i] < 0 && edges < 2) edge[edges++] = i;
  }
  if (edges == 2) {
    // Along edge i the weights are as rho_i share_i : rho_{i+1} share_{i+1}.
    const auto sum_on = [&](std::size_t i) { return rho[i] * share[i] + rho[next(i)] * share[next(i)]; };
    for (const std::size_t side : {0, 1}) {
      const double other = sum_on(edge[1 - side]);
      for (const std::size_t i : {edge[side], next(edge[side])}) m[i] += rho[i] * other;
    }
    return m;
  }
  return RegularWeights<double>({1, 1, 1, 1}, cosine, sine, rho).m;
}

bool in_front(const std::array<double, 4>& m, const std::array<WindowVertex, 4>& vertex) {
  double sum = 0, sum_w = 0, size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += m[i];
    sum_w += m[i] * vertex[i].w;
    size += std::abs(m[i] * vertex[i].w);
  }
  return (sum > 0 ? sum_w : -sum_w) > 0x1p-40 * size;
}

std::unique_ptr<Method> make_mvc() { return std::make_unique<MeanValue>(); }

}  // namespace quadrille::golden::methods
