// The fewest quads, pixels and stalls of a draw that fails, which still fail.
#pragma once

#include "model/records.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace quadrille::cli {

/// A draw that fails: of all inputs of a co-simulation those that can be made less.
struct FailingDraw {
  std::vector<WindowQuad> quads;
  DrawState state;
  double stall = 0, gap = 0;
};

/// Makes `draw` less as long as `fails` says true of what is left, which must hold of `draw` itself: stalls and gaps
/// none, the draw state's options as by default, the first quads, then without runs of others (delta debugging: Zeller
/// and Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", 2002), the scissor halved from each side, the
/// viewport to it. Nothing that is left can be left out by itself. At most `tries` calls of `fails`; the same draw and
/// answers give the same result.
FailingDraw shrink(FailingDraw draw, const std::function<bool(const FailingDraw&)>& fails, std::uint64_t tries = 1000);

}  // namespace quadrille::cli
