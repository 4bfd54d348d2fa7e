// What `quadrille fragments --errors` writes: every value of every fragment beside the truth.
#pragma once

#include "tb/engines/engine.hpp"

#include <span>
#include <string>

namespace quadrille::tb {

/// A row for each weight, window z and attribute by its name: quad,x,y,value,drawn,truth,error,of_bound; reals with 17
/// significant digits. `drawn` holds what the engine of `settings` drew of the quads, `truth` the engine truth under
/// the same settings; where one of them has no such pixel its column says "missing", where the engine divides by zero
/// "undefined", and the row has no error. of_bound is |error| in units of what the bound allows (AllowedErrors).
std::string fragment_errors_csv(std::span<const WindowQuad> quads, std::span<const std::string> attributes,
                                const EngineSettings& settings, std::span<const EngineSample> drawn,
                                std::span<const EngineSample> truth);

}  // namespace quadrille::tb
