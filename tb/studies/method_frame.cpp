#include "tb/studies/method_frame.hpp"

#include "model/port/snap.hpp"
#include "tb/studies/method_input.hpp"
#include "tb/support/errors.hpp"

#include <array>

namespace quadrille::tb {

FrameBuffer draw_frame(Engine& engine, const DrawInput& input, const DrawState& state) {
  FrameBuffer frame(state.width, state.height, state.depth);
  try {
    engine.draw(input.quads, input.attributes, true,
                [&](std::span<const EngineSample> samples) { frame.add(samples); });
  } catch (const SnapError& error) {
    throw UsageError(describe(error, input));
  }
  return frame;
}

FrameBuffer draw_method(const std::string& method, const DrawInput& input, const EngineSettings& settings) {
  return draw_frame(*make_method_engine(method, input, settings), input, settings.state);
}

FrameBuffer draw_truth(const DrawInput& input, const EngineSettings& settings) {
  EngineSettings truth = settings;
  truth.kind = EngineKind::truth;
  truth.snap = false;
  return draw_frame(*make_engine(truth), input, settings.state);
}

const char* compared_values(const DrawInput& input) {
  if (input.shade == "depth") return "window depth";
  return input.attributes > 0 ? "the attributes" : "the weights";
}

compare::AttributeImage attribute_image(const FrameBuffer& frame, const DrawInput& input) {
  const bool depth = input.shade == "depth";
  const int channels = depth ? 1 : input.attributes > 0 ? input.attributes : 4;
  compare::AttributeImage image(frame.width(), frame.height(), channels);
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      if (!frame.drawn(x, y)) continue;
      const EngineSample& sample = frame.shown(x, y);
      if (sample.undefined)
        image.set_undefined(x, y, sample.index);
      else if (depth)
        image.set(x, y, sample.index, std::array{sample.z});
      else if (input.attributes > 0)
        image.set(x, y, sample.index, sample.attribute);
      else
        image.set(x, y, sample.index, sample.lambda);
    }
  }
  return image;
}

}  // namespace quadrille::tb
