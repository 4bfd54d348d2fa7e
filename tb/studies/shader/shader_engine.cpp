#include "tb/studies/shader/shader_engine.hpp"

#include "golden/reference/truth.hpp"
#include "tb/studies/shader/quad_shader.hpp"

#include <algorithm>
#include <cmath>

namespace quadrille::tb {
namespace {

constexpr std::size_t quads_at_a_time = 4096;

/// A frame buffer keeps one fragment a pixel, and an engine hands out all: a quad is drawn alone and read back.
class ShaderEngine final : public Engine {
 public:
  explicit ShaderEngine(const EngineSettings& settings) : settings_(settings) { QuadShader::require(); }

  void draw(std::span<const WindowQuad> quads, int attributes, bool weights, const SampleSink& sink) override {
    QuadShader shader(shader_settings(attributes, weights));
    const Config config = snapping_config(settings_.config, attributes);
    const DrawState state = draw_state(attributes);
    for (std::size_t first = 0; first < quads.size(); first += quads_at_a_time) {
      const std::size_t last = std::min(quads.size(), first + quads_at_a_time);
      ShaderQuads vertices(attributes);
      std::vector<Place> places;
      for (std::size_t i = first; i < last; ++i) {
        const SnappedQuad snapped = snap_as(quads[i], 0, config, state);  // refuses what no engine draws
        if (settings_.snap) {
          vertices.add(snapped, config, state.perspective);
          places.push_back(place_of(golden::TruthQuad(snapped, config, state).rows(), state));
        } else {
          vertices.add(quads[i]);
          places.push_back(place_of(golden::TruthQuad(quads[i], state).rows(), state));
        }
        places.back().far = std::ranges::any_of(
            snapped.vertex, [&](const SnappedVertex& v) { return v.w != std::int32_t{1} << config.frac(); });
      }
      shader.load(vertices);
      for (std::size_t i = first; i < last; ++i) {
        const Place& place = places[i - first];
        if (!place.far && is_empty(place.rect)) continue;
        const auto read = [&](const ShaderRect& rect) {
          return samples_of(shader.read(rect), rect, static_cast<std::uint32_t>(i), quads[i].id, weights, attributes);
        };
        shader.clear(place.rect);
        const std::uint64_t fragments = shader.count(i - first, 1);
        if (fragments == 0) continue;
        std::vector<EngineSample> samples;
        if (!is_empty(place.rect)) samples = read(place.rect);
        if (place.far && samples.size() < fragments) {
          const ShaderRect all{state.scissor_x0, state.scissor_y0, state.scissor_x1, state.scissor_y1};
          shader.clear(all);
          shader.draw(i - first, 1);
          samples = read(all);
        }
        if (!samples.empty()) sink(samples);
      }
    }
  }

 private:
  DrawState draw_state(int attributes) const {
    DrawState state = settings_.state;
    state.attributes = attributes;
    return state;
  }

  QuadShader::Settings shader_settings(int attributes, bool weights) const {
    return {.state = draw_state(attributes), .weights = weights, .snapped = settings_.snap};
  }

  struct Place {
    ShaderRect rect;
    /// A vertex is beyond the guard band or not before the eye: what OpenGL makes of that in single precision may be
    /// elsewhere. Then fragments that the rectangle does not show (or two at a pixel) have the whole picture read.
    bool far = false;
  };

  static bool is_empty(const ShaderRect& rect) { return rect.x0 >= rect.x1 || rect.y0 >= rect.y1; }

  /// The implementation's own grid of positions may move an edge over the next pixel centre.
  static Place place_of(const golden::CoverageRows& rows, const DrawState& state) {
    const golden::PixelRect& bounds = rows.bounds();
    if (bounds.empty()) return {};
    return {{std::max(state.scissor_x0, bounds.x0 - 1), std::max(state.scissor_y0, bounds.y0 - 1),
             std::min(state.scissor_x1, bounds.x1 + 1), std::min(state.scissor_y1, bounds.y1 + 1)}};
  }

  static std::vector<EngineSample> samples_of(std::span<const ShaderPixel> pixels, const ShaderRect& rect,
                                              std::uint32_t index, std::uint32_t quad, bool weights, int attributes) {
    std::vector<EngineSample> samples;
    const int width = rect.x1 - rect.x0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const ShaderPixel& pixel = pixels[i];
      if (!pixel.drawn) continue;
      EngineSample sample;
      sample.index = index;
      sample.quad = quad;
      sample.x = static_cast<std::uint16_t>(rect.x0 + static_cast<int>(i) % width);
      sample.y = static_cast<std::uint16_t>(rect.y0 + static_cast<int>(i) / width);
      sample.front = pixel.front;
      sample.z = pixel.z;
      bool finite = std::isfinite(pixel.z);
      for (std::size_t c = 0; c < 4 && weights; ++c) {
        sample.lambda[c] = pixel.lambda[c];
        finite = finite && std::isfinite(pixel.lambda[c]);
      }
      for (std::size_t a = 0; a < static_cast<std::size_t>(attributes); ++a) {
        sample.attribute[a] = pixel.attribute[a];
        finite = finite && std::isfinite(pixel.attribute[a]);
      }
      sample.undefined = !finite;
      samples.push_back(sample);
    }
    return samples;
  }

  EngineSettings settings_;
};

}  // namespace

std::unique_ptr<Engine> make_shader_engine(const EngineSettings& settings) {
  return std::make_unique<ShaderEngine>(settings);
}

}  // namespace quadrille::tb
