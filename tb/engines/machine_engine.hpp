// The machine as an engine: its untimed model, and the Verilated RTL.
#pragma once

#include "tb/engines/engine.hpp"

namespace quadrille::tb {

std::unique_ptr<Engine> make_model_engine(const EngineSettings& settings);
std::unique_ptr<Engine> make_rtl_engine(const EngineSettings& settings);

}  // namespace quadrille::tb
