// The input of a command as the papers' methods take it.
#pragma once

#include "tb/options/input.hpp"
#include "tb/studies/method_engine.hpp"

namespace quadrille::tb {

/// The input's quads as the methods take them: with corners in object space, texture coordinates and attributes. Throws
/// UsageError when the input has no object space (--quads, --stress) and `method` needs it.
std::vector<golden::methods::Quad> method_quads(const DrawInput& input, const std::string& method);

/// make_method_engine() for the quads of an input.
std::unique_ptr<Engine> make_method_engine(const std::string& method, const DrawInput& input,
                                           const EngineSettings& settings);

}  // namespace quadrille::tb
