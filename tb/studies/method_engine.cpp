#include "tb/studies/method_engine.hpp"

#include "model/support/parallel.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace quadrille::tb {
namespace {

namespace methods = golden::methods;

class MethodEngine final : public Engine {
 public:
  MethodEngine(const std::string& method, std::vector<methods::Quad> quads, const EngineSettings& settings)
      : method_(methods::make_method(method)), quads_(std::move(quads)), settings_(settings) {}

  void draw(std::span<const WindowQuad> quads, int attributes, bool, const SampleSink& sink) override {
    if (quads.size() != quads_.size()) throw std::logic_error("method engine: other quads than its input's");
    const methods::View view = method_view(settings_.state);
    ordered_parallel(
        quads.size(), settings_.threads,
        [&](std::size_t index) {
          std::vector<methods::MethodSample> drawn;
          method_->draw(quads_[index], view, drawn);
          std::vector<EngineSample> samples;
          samples.reserve(drawn.size());
          for (const methods::MethodSample& s : drawn)
            if (shown(s)) samples.push_back(converted(s, quads[index], index, attributes));
          return samples;
        },
        [&](std::size_t, std::vector<EngineSample>&& samples) {
          if (!samples.empty()) sink(samples);
        });
  }

 private:
  bool shown(const methods::MethodSample& s) const {
    const DrawState& state = settings_.state;
    if (s.x < state.scissor_x0 || s.x >= state.scissor_x1 || s.y < state.scissor_y0 || s.y >= state.scissor_y1)
      return false;
    if (state.cull == (s.front ? Cull::front : Cull::back)) return false;
    return !state.depth || s.undefined || (s.z >= state.znear && s.z <= state.zfar);
  }

  EngineSample converted(const methods::MethodSample& s, const WindowQuad& quad, std::size_t index,
                         int attributes) const {
    EngineSample sample;
    sample.index = static_cast<std::uint32_t>(index);
    sample.quad = quad.id;
    sample.x = static_cast<std::uint16_t>(s.x);
    sample.y = static_cast<std::uint16_t>(s.y);
    sample.front = s.front;
    sample.undefined = s.undefined;
    sample.z = settings_.state.depth ? s.z : 0;
    sample.lambda = s.lambda;
    for (std::size_t a = 0; a < static_cast<std::size_t>(attributes); ++a)
      for (std::size_t i = 0; i < 4; ++i) sample.attribute[a] += s.lambda[i] * quad.attribute[i][a];
    return sample;
  }

  std::unique_ptr<methods::Method> method_;
  std::vector<methods::Quad> quads_;
  EngineSettings settings_;
};

}  // namespace

methods::View method_view(const DrawState& state) { return {state.width, state.height, state.perspective}; }

std::unique_ptr<Engine> make_method_engine(const std::string& method, std::vector<methods::Quad> quads,
                                           const EngineSettings& settings) {
  return std::make_unique<MethodEngine>(method, std::move(quads), settings);
}

}  // namespace quadrille::tb
