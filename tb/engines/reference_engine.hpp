// The floating-point engines: the paper's formulas in double and single precision, and the truth.
#pragma once

#include "tb/engines/engine.hpp"

namespace quadrille::tb {

std::unique_ptr<Engine> make_reference_engine(const EngineSettings& settings);

}  // namespace quadrille::tb
