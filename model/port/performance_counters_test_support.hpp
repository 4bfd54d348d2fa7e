// What the tests of performance counters share.
#pragma once

#include "model/drive.hpp"
#include "model/port/performance_counters.hpp"
#include "model/port/snap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <vector>

namespace quadrille {
namespace {

using Point = std::array<double, 2>;
using enum PerformanceCounter;

inline WindowQuad quad_of(const std::array<Point, 4>& points, double z = 0.5) {
  WindowQuad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i] = {points[i][0], points[i][1], z, 1};
    quad.attribute[i].assign(4, 0.25);
  }
  return quad;
}

/// Counter-clockwise on the screen: a front face.
inline WindowQuad square(double x, double y, double edge) {
  return quad_of({{{x, y + edge}, {x + edge, y + edge}, {x + edge, y}, {x, y}}});
}

/// When beats are on offer, and the port ready: in the first `burst` of `every` clocks, in one of `ready`.
struct Rhythm {
  int every = 1, burst = 1, ready = 1;
};

class Paused {
 public:
  Paused(std::span<const SnappedQuad> quads, const Rhythm& rhythm) : beats_(quads), rhythm_(rhythm) {}
  bool done() const { return beats_.done(); }
  bool valid() const { return !done() && clock_ % rhythm_.every < rhythm_.burst; }
  bool ready() const { return clock_ % rhythm_.ready == 0; }
  bool changed() const { return true; }
  VertexBeat beat() const { return beats_.beat(); }
  void advance(bool taken) {
    beats_.advance(taken);
    ++clock_;
  }

 private:
  SteadyBeats beats_;
  Rhythm rhythm_;
  int clock_ = 0;
};

/// Draws to the end.
inline PerformanceCounters count(const std::vector<WindowQuad>& quads, const Config& config = {},
                                 const DrawState& state = {}, const Rhythm& rhythm = {}) {
  std::vector<SnappedQuad> snapped;
  for (const WindowQuad& quad : quads) snapped.push_back(snap_quad(quad, config, state));
  DrivenModel machine(config, state);
  Paused stimulus(snapped, rhythm);
  std::uint64_t clocks = 0;
  drive(machine, stimulus, [&](std::uint64_t cycle, const ClockedOutputs& out, bool) {
    clocks = cycle;
    return !stimulus.done() || out.busy;
  });
  const PerformanceCounters& c = machine.counters();
  EXPECT_EQ(c[PerformanceCounter::clocks], clocks);
  // Each clock is charged once, each quad is left out or taken.
  const auto begin = c.value.begin();
  EXPECT_EQ(
      std::accumulate(begin + static_cast<int>(PerformanceCounter::bound_pixels), c.value.end(), std::uint64_t{0}),
      clocks);
  EXPECT_EQ(c[PerformanceCounter::quads], quads.size());
  EXPECT_EQ(c.quads_left_out() + c[PerformanceCounter::quads_ordinary] + c[PerformanceCounter::quads_homogeneous],
            quads.size());
  return c;
}

}  // namespace
}  // namespace quadrille
