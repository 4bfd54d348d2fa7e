// A whole draw of the untimed model judged as `cosim` judges the RTL: the truth alone, no second machine. What RTL and
// model have wrong alike must show here.
#pragma once

#include "model/untimed.hpp"
#include "tb/judge/check.hpp"

#include <span>

namespace quadrille::tb {

/// Draws the quads (numbered by position; their ids are for messages) with the untimed model and compares every
/// fragment with the truth: the weights in passes of their own, then the first `attributes` attributes.
/// `state.attributes` is set here. The plain engine is the one that shares its functions with the clocked model.
/// Snapping errors are not measured. Throws SnapError for a quad that cannot be drawn.
CheckResult judge_untimed(std::span<const WindowQuad> quads, int attributes, const Config& config,
                          const DrawState& state, PixelEngine engine = PixelEngine::plain);

/// The same of quads at the port, which snapping need not be able to make: the weights (k, or W without perspective, in
/// slot i of vertex i), then the attributes that stand in their first `state.attributes` slots.
CheckResult judge_untimed(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state,
                          PixelEngine engine = PixelEngine::plain);

}  // namespace quadrille::tb
