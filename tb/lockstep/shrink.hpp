// The fewest quads, pixels, stalls and gaps of a draw that fails, which still fail.
#pragma once

#include "model/port/records.hpp"
#include "tb/lockstep/port_waits.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace quadrille::tb {

/// A draw that fails: of all inputs of a co-simulation those that can be made less.
struct FailingDraw {
  std::vector<WindowQuad> quads;
  DrawState state;
  std::uint64_t seed = 1;          ///< of the waits at random, and of what the machine must not look at
  double stall = 0, gap = 0;       ///< chances of waits. With `waits`: what drew them, 0 once they are others
  std::optional<PortWaits> waits;  ///< the waits one by one: these are driven
};

/// What a run that fails says of itself.
struct Failure {
  std::uint64_t quads = 0;  ///< that the machine had taken whole
  PortWaits waits;          ///< that its ports had, drawn or listed: with these listed it must fail alike
};

/// Runs a draw; nothing when it does not fail.
using FailingRun = std::function<std::optional<Failure>(const FailingDraw&)>;

struct ShrinkLimits {
  std::uint64_t tries = 100'000;                             ///< runs
  unsigned redraws = 12;                                     ///< of the waits, before a step is given up
  std::function<bool()> out_of_time = [] { return false; };  ///< ends the search, too
};

struct Shrunk {
  FailingDraw draw;
  std::uint64_t tries = 0;
  bool ended = false;  ///< by a limit: there may be less
};

/// Makes `draw` less as long as `run` fails with what is left: only the first quads, without waits, the draw state's
/// options as by default; then again and again, until nothing shrinks, without runs of quads (delta debugging: Zeller
/// and Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", 2002), the scissor halved from each side, the
/// viewport to it, without runs of waits. Waits at random are taken down one by one from the run that failed, so that a
/// step does not draw others. But a wait that met a fragment of many quads may meet none of one: a step that passes
/// with the waits listed is tried with some drawn anew, more and more of them, before it is given up. In the end no
/// quad, no stall and no gap can be left out by itself. The same draw and answers give the same result; nothing when
/// the draw does not fail when it is run again.
std::optional<Shrunk> shrink(FailingDraw draw, const FailingRun& run, const ShrinkLimits& limits = {});

}  // namespace quadrille::tb
