#include "model/page/sweep.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/hardware_cost.hpp"
#include "golden/reference/truth.hpp"
#include "model/port/snap.hpp"
#include "model/support/json.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille::page {
namespace {

/// At every other pixel of every other row. The exact weights depend on significand_bits too: by the k of the corners.
double worst_error(const Drawing& drawing) {
  const Picture picture = draw_picture(drawing, Values::weights);
  const DepthImage<double>& image = picture.image;
  const auto pixel_of = [&](const golden::PixelPlace& at) {
    return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(image.width()) + static_cast<std::size_t>(at.x);
  };
  std::vector<std::vector<golden::PixelPlace>> places(drawing.quads.size());
  for (int y = 0; y < image.height(); y += 2)
    for (int x = 0; x < image.width(); x += 2)
      if (const std::uint32_t quad = image.quads()[pixel_of({x, y})]; quad != DepthImage<double>::no_quad)
        places[quad].push_back({x, y});
  DrawState state = drawing.state;
  state.attributes = 0;
  double worst = 0;
  std::vector<golden::ReferenceSample> exact;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].empty()) continue;
    const Config& config = drawing.request.config;
    const golden::TruthQuad truth(snap_quad(drawing.quads[i], config, state), config, state);
    exact.assign(places[i].size(), {});
    truth.samples(places[i], exact, lane_target());
    for (std::size_t n = 0; n < exact.size(); ++n)
      for (std::size_t k = 1; k < 4; ++k)
        worst = std::max(worst,
                         std::fabs(image.attribute(static_cast<int>(k))[pixel_of(places[i][n])] - exact[n].lambda[k]));
  }
  return worst;
}

}  // namespace

std::string sweep_json(const Drawing& drawing) {
  const ConfigKey& key = Config::key("significand_bits");
  Drawing variant = drawing;
  std::vector<std::string> points;
  for (int bits = key.minimum; bits <= key.maximum; ++bits) {
    Config& config = variant.request.config;
    config = drawing.request.config;
    config.significand_bits = bits;
    try {
      config.validate();
    } catch (const ConfigError&) {  // not with the other keys
      continue;
    }
    const HardwareCost cost = hardware_cost(config);
    points.push_back(Json()
                         .put("significand_bits", bits)
                         .put("cost", scalar_cost(cost, ecp5_weights))
                         .put("luts", lut_cost(cost, ecp5_weights))
                         .put("dsps", cost.dsps)
                         .put("bound", bound_lambda(config).value)
                         .put("worst", worst_error(variant))
                         .text());
  }
  return Json().raw("points", Json::list(points, [](const std::string& point) { return point; })).text();
}

}  // namespace quadrille::page
