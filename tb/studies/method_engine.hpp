// A method of the papers (golden/methods) as an engine: the quads as given, in floating point.
#pragma once

#include "golden/methods/method.hpp"
#include "tb/engines/engine.hpp"

#include <memory>
#include <string>
#include <vector>

namespace quadrille::tb {

/// The view of a draw state.
golden::methods::View method_view(const DrawState& state);

/// Draws with `method`, `quads` as it takes them; draw() must be given the same quads. Uses of the settings only state
/// and threads: cull mode, scissor, znear and zfar are applied to the method's fragments. Throws std::invalid_argument
/// for an unknown method.
std::unique_ptr<Engine> make_method_engine(const std::string& method, std::vector<golden::methods::Quad> quads,
                                           const EngineSettings& settings);

}  // namespace quadrille::tb
