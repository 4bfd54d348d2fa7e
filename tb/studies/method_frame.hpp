// An input drawn by an engine or a method into a depth-tested frame, and that frame as numbers to compare.
#pragma once

#include "tb/render/frame.hpp"
#include "tb/studies/compare/attribute_image.hpp"

#include <string>

namespace quadrille::tb {

/// Everything drawn, depth-tested as the state says. Throws UsageError for a quad that cannot be drawn.
FrameBuffer draw_frame(Engine& engine, const DrawInput& input, const DrawState& state);
FrameBuffer draw_method(const std::string& method, const DrawInput& input, const EngineSettings& settings);
/// 113 bits, on the quads as given.
FrameBuffer draw_truth(const DrawInput& input, const EngineSettings& settings);

/// What is compared of an input: "the attributes", "window depth" (shading depth) or "the weights" (no attributes).
const char* compared_values(const DrawInput& input);
/// Those values of what each pixel shows.
compare::AttributeImage attribute_image(const FrameBuffer& frame, const DrawInput& input);

}  // namespace quadrille::tb
