#include "tb/commands/fragments_errors.hpp"

#include "golden/analysis/judged_quad.hpp"
#include "tb/judge/knob_errors.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <tuple>

namespace quadrille::tb {
namespace {

struct Pair {
  const EngineSample* drawn = nullptr;
  const EngineSample* truth = nullptr;
};

std::string real(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace

std::string fragment_errors_csv(std::span<const WindowQuad> quads, std::span<const std::string> attributes,
                                const EngineSettings& settings, std::span<const EngineSample> drawn,
                                std::span<const EngineSample> truth) {
  std::map<std::tuple<std::uint32_t, int, int>, Pair> pixels;
  for (const EngineSample& s : drawn) pixels[{s.index, s.y, s.x}].drawn = &s;
  for (const EngineSample& s : truth) pixels[{s.index, s.y, s.x}].truth = &s;

  DrawState state = settings.state;
  state.attributes = static_cast<int>(attributes.size());
  const Config snapping = snapping_config(settings.config, state.attributes);
  const Bounds bounds(settings.config);
  std::string out = "quad,x,y,value,drawn,truth,error,of_bound\n";
  std::optional<SnappedQuad> snapped;
  std::optional<JudgedQuad> quad;
  std::optional<ErrorBounds> limits;
  std::uint32_t current = 0;
  for (const auto& entry : pixels) {
    const auto [index, y, x] = entry.first;
    const auto& pixel = entry.second;
    if (!quad || index != current) {
      current = index;
      limits.reset();
      quad.reset();
      snapped = snap_as(quads[index], index, snapping, state);
      quad.emplace(*snapped, snapping, bounds, state);
      limits.emplace(*quad, settings.config, state);
    }
    // In lanes, as `stress` has it: their last bits are not those of sample(), and errors are few bits.
    const golden::PixelPlace at{x, y};
    golden::ReferenceSample exact;
    quad->truth().samples({&at, 1}, {&exact, 1});
    const AllowedErrors allowed = limits->at(exact, x, y);
    const std::string place = std::to_string(quads[index].id) + "," + std::to_string(x) + "," + std::to_string(y) + ",";
    const auto row = [&](const std::string& name, double most, const auto& value) {
      out += place + name + ",";
      const bool defined = pixel.drawn && !pixel.drawn->undefined;
      out += defined ? real(value(*pixel.drawn)) : pixel.drawn ? "undefined" : "missing";
      out += "," + (pixel.truth ? real(value(exact)) : "missing");
      if (defined && pixel.truth) {
        const double error = value(*pixel.drawn) - value(exact);
        // Nothing is allowed or forbidden where sum(M W) cancels.
        out += "," + real(error) + "," + (std::isfinite(most) ? real(std::fabs(error / most)) : "") + "\n";
      } else {
        out += ",,\n";
      }
    };
    for (std::size_t i = 0; i < 4; ++i)
      row("l" + std::to_string(i), allowed.weight[i], [&](const auto& s) { return s.lambda[i]; });
    if (state.depth) row("z", allowed.depth, [](const auto& s) { return s.z; });
    for (std::size_t a = 0; a < attributes.size(); ++a)
      row(attributes[a], allowed.attribute[a], [&](const auto& s) { return s.attribute[a]; });
  }
  return out;
}

}  // namespace quadrille::tb
