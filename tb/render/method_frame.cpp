#include "tb/render/method_frame.hpp"

#include "model/snap.hpp"
#include "tb/commands/errors.hpp"
#include "tb/render/method_engine.hpp"

namespace quadrille::cli {

FrameBuffer draw_frame(Engine& engine, const DrawInput& input, const DrawState& state) {
  FrameBuffer frame(state.width, state.height, state.depth);
  try {
    engine.draw(input.quads, input.attributes, true, [&](std::span<const Sample> samples) { frame.add(samples); });
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

compare::AttributeImage attribute_image(const FrameBuffer& frame, const DrawInput& input) {
  compare::AttributeImage image(frame.width(), frame.height(), input.attributes > 0 ? input.attributes : 4);
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      if (!frame.drawn(x, y)) continue;
      const Sample& sample = frame.shown(x, y);
      if (sample.undefined)
        image.set_undefined(x, y, sample.index);
      else if (input.attributes > 0)
        image.set(x, y, sample.index, sample.attribute);
      else
        image.set(x, y, sample.index, sample.lambda);
    }
  }
  return image;
}

}  // namespace quadrille::cli
