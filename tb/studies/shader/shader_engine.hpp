// The papers' fp32 shader on OpenGL as an engine.
#pragma once

#include "tb/engines/engine.hpp"

namespace quadrille::tb {

/// Throws EnvironmentError where there is no OpenGL.
std::unique_ptr<Engine> make_shader_engine(const EngineSettings& settings);

}  // namespace quadrille::tb
