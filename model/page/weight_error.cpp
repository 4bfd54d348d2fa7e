#include "model/page/weight_error.hpp"

#include "golden/reference/truth.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::page {

void weight_errors(const Drawing& drawing, const DepthImage<double>& weights, int step,
                   const std::function<void(const WeightError&)>& take) {
  const auto pixel_of = [&](int x, int y) { return static_cast<std::size_t>(y * weights.width() + x); };
  std::vector<std::vector<golden::PixelPlace>> places(drawing.quads.size());
  for (int y = 0; y < weights.height(); y += step)
    for (int x = 0; x < weights.width(); x += step)
      if (const std::uint32_t quad = weights.quads()[pixel_of(x, y)]; quad != DepthImage<double>::no_quad)
        places[quad].push_back({x, y});
  const BareQuads bare = bare_quads(drawing);
  std::vector<golden::ReferenceSample> exact;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].empty()) continue;
    const golden::TruthQuad truth(bare.quads[i], drawing.request.config, bare.state);
    exact.assign(places[i].size(), {});
    truth.samples(places[i], exact, lane_target());
    for (std::size_t n = 0; n < exact.size(); ++n) {
      WeightError of{places[i][n].x, places[i][n].y, 0, exact[n].covered && exact[n].visible};
      for (std::size_t k = 1; k < 4; ++k) {
        const double error =
            std::fabs(weights.attribute(static_cast<int>(k))[pixel_of(of.x, of.y)] - exact[n].lambda[k]);
        of.error = error > of.error || std::isnan(error) ? error : of.error;
      }
      take(of);
    }
  }
}

}  // namespace quadrille::page
