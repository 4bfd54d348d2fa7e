// The triangle machine (rtl/triangles), simulated: what a quad machine is compared with.
#pragma once

#include "model/port/performance_counters.hpp"
#include "tb/device/verilate.hpp"
#include "tb/lockstep/monitor.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::tb {

/// A triangle a, b, c is the snapped quad a, b, c, c: its first three beats.
using SnappedTriangle = SnappedQuad;

/// Both triangles of every quad, 0-1-2 and 0-2-3; ids count them.
std::vector<WindowQuad> split_quads(std::span<const WindowQuad> quads);

/// Chances per clock that fragment_ready is low, that a beat is not there yet.
struct TriangleWaits {
  std::uint64_t seed = 1;
  double stall = 0, gap = 0;
};

struct TriangleRun {
  std::uint64_t clocks = 0;      ///< until nothing is left to do
  PerformanceCounters counters;  ///< 0 in a configuration without them
};

class TriangleMachine {
 public:
  /// Builds the simulator of `config`, of the sources in `folder` (rtl/triangles/machine.py). Throws as verilate().
  TriangleMachine(const Config& config, const std::filesystem::path& folder);

  /// One draw from reset. Throws DeviceError for an assertion of the RTL, or when nothing moves any more.
  TriangleRun draw(std::span<const SnappedTriangle> triangles, const DrawState& state, const FragmentSink& sink,
                   const TriangleWaits& waits = {}) const;

 private:
  Config config_;
  Simulator simulator_;
};

}  // namespace quadrille::tb
