#include "model/page/sweep.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/hardware_cost.hpp"
#include "model/page/weight_error.hpp"
#include "model/support/json.hpp"

#include <algorithm>
#include <vector>

namespace quadrille::page {
namespace {

/// At every other pixel of every other row. The exact weights depend on significand_bits too: by the k of the corners.
double worst_error(const Drawing& drawing) {
  double worst = 0;
  weight_errors(drawing, draw_picture(drawing, Values::weights).image, 2,
                [&](const WeightError& of) { worst = std::max(worst, of.error); });
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
