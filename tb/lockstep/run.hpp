// What every run of a machine has, in lockstep or alone: inputs, monitor, watchdog.
#pragma once

#include "model/front/tile_context.hpp"
#include "model/port/bit_vector.hpp"
#include "tb/lockstep/driven_device.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

namespace quadrille::tb {

inline int fragment_width(const Config& config) { return boundary_layout(Boundary::fragment, config).bits(); }

/// Gives a run up when nothing enters or leaves the machine for longer than its longest silent walk.
class Watchdog {
 public:
  explicit Watchdog(const LockstepOptions& o) : limit_(o.watchdog) {
    if (limit_ != 0) return;
    // With the skips off each homogeneous quad takes its steps in every tile of the viewport, and its rows, without a
    // fragment perhaps; so do, one after the other, all that have a slot and the two before setup.
    const Config& config = o.config;
    const auto tiles = [&](int pixels) { return static_cast<std::uint64_t>(pixels / config.tile() + 2); };
    const int clocks =
        tile_context_last_step(true, config.product_pairs()) + tile_context_result_clocks + config.tile() + 2;
    limit_ = 100'000 + static_cast<std::uint64_t>(config.quad_slots() + 2) * tiles(o.state.width) *
                           tiles(o.state.height) * static_cast<std::uint64_t>(clocks);
  }

  /// True when the run is to be given up.
  bool silent(bool progress) {
    silent_ = progress ? 0 : silent_ + 1;
    return silent_ > limit_;
  }
  [[noreturn]] void give_up(std::uint64_t cycle, std::uint64_t beats, std::uint64_t fragments) const {
    throw WatchdogError("the machine hangs: busy, but no vertex, tile or fragment moved for " + std::to_string(limit_) +
                        " clocks, up to cycle " + std::to_string(cycle) + " (" + std::to_string(beats) +
                        " vertices in, " + std::to_string(fragments) + " fragments out)");
  }

 private:
  std::uint64_t limit_, silent_ = 0;
};

/// What every run has besides its machine.
struct MachineRun {
  const LockstepOptions& options;
  Stimulus stimulus;
  FragmentMonitor monitor;
  Watchdog watchdog;
  Stopwatch stopwatch{};

  MachineRun(std::span<const SnappedQuad> quads, const LockstepOptions& o, const FragmentSink& sink)
      : options(o), stimulus(quads, o), monitor(o.config, fragment_width(o.config), sink), watchdog(o) {}

  bool enough() const { return options.limit_fragments != 0 && monitor.fragments() >= options.limit_fragments; }
  [[noreturn]] void give_up(std::uint64_t cycle) const {
    watchdog.give_up(cycle, stimulus.vertices.beats_taken(), monitor.fragments());
  }
  /// Calls the progress function at most every 2^14 clocks.
  void show_progress(std::uint64_t cycle) const {
    if ((cycle & 0x3fff) != 0 || !options.progress) return;
    double part = stimulus.vertices.fraction();
    if (options.limit_fragments != 0) {
      part = std::max(part, static_cast<double>(monitor.fragments()) / static_cast<double>(options.limit_fragments));
    }
    options.progress(std::min(part, 1.0));
  }
};

/// Calls f(lane, words) for the fragments of this clock, in their order.
template <class F>
void for_each_lane(const DeviceSample& out, F&& f) {
  for (std::size_t lane = 0; lane < most_lanes; ++lane)
    if ((out.fragment_mask >> lane & 1) != 0) f(lane, out.fragment[lane]);
}

/// The RTL of the device alone as a report without a comparison; only an assertion that fails is a mismatch.
LockstepReport run_uncompared(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& options,
                              const FragmentSink& sink);

}  // namespace quadrille::tb
