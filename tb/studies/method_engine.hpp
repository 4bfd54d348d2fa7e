// A method of the papers (golden/methods) as an engine: the quads as given, in floating point.
#pragma once

#include "golden/methods/method.hpp"
#include "tb/engines/engine.hpp"
#include "tb/options/input.hpp"

#include <memory>
#include <string>
#include <vector>

namespace quadrille::tb {

/// The input's quads as the methods take them: with corners in object space, texture coordinates and attributes. Throws
/// UsageError when the input has no object space (--quads, --stress) and `method` needs it.
std::vector<golden::methods::Quad> method_quads(const DrawInput& input, const std::string& method);

/// The view of a draw state.
golden::methods::View method_view(const DrawState& state);

/// Draws with `method`. The quads given to draw() must be those of `input`, which must outlive the engine. Uses of the
/// settings only state and threads: cull mode, scissor, znear and zfar are applied to the method's fragments.
std::unique_ptr<Engine> make_method_engine(const std::string& method, const DrawInput& input,
                                           const EngineSettings& settings);

}  // namespace quadrille::tb
