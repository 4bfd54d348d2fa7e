// Lockstep: the Verilated RTL and the clocked model get the same inputs in every clock and must give the same outputs.
//
// In each clock: drive the inputs, settle both sides with the clock low, compare everything, then clock both. With two
// threads the RTL does its part of that some clocks ahead (device_ahead.hpp).
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/device/device.hpp"
#include "tb/device/verilate.hpp"
#include "tb/lockstep/monitor.hpp"
#include "tb/lockstep/port_waits.hpp"
#include "tb/lockstep/scoreboard.hpp"
#include "tb/lockstep/wait_pattern.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille::tb {

struct LockstepOptions {
  Config config;
  DrawState state;
  std::uint64_t seed = 1;
  double stall = 0;                        ///< probability per clock that fragment_ready is low; in [0, 1)
  double gap = 0;                          ///< probability per clock that vertex_valid is low before a beat; in [0, 1)
  PortWaits waits;                         ///< these instead; of a port that has some the chance must be 0
  double clear = 0;                        ///< probability per clock, busy or not, that clear_hidden is high; in [0, 1)
  double flush = 0;                        ///< the same of flush: the driver begins a quad anew of which beats are gone
  WaitKind pattern = WaitKind::chance;     ///< another kind: what draws the waits of a port that has none of these
  std::optional<std::string> trace;        ///< FST waveform file
  std::uint64_t trace_from = 0;            ///< of run_lockstep(): the clock in which it begins
  std::uint64_t limit_fragments = 0;       ///< end after so many fragments; 0: no limit
  bool stop_at_first = true;               ///< end at the first difference
  std::uint64_t limit_differences = 1000;  ///< else end after so many clocks with a difference; 0: no limit
  bool probes = true;                      ///< compare at the stage boundaries too
  bool compare = true;                     ///< false, without probes: the RTL alone, whatever the model has
  std::uint64_t watchdog = 0;  ///< clocks without progress after which a run is given up; 0: from the viewport
  std::function<void(double)> progress;  ///< called now and then with the part done, 0 to 1
  std::filesystem::path source;          ///< RTL instead of the project's: directory, or one Verilog file
  int optimise = 2;                      ///< see VerilateOptions
  unsigned threads = 1;                  ///< 2 and more: the device has one of its own; the report is the same
  bool go_on = false;                    ///< no reset before it (LockstepSession sets this)
  bool clear_hidden = false;             ///< with go_on: clear_hidden_i in the first clock
};

/// Neither side did anything for so long that the run was given up.
struct WatchdogError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct LockstepReport {
  std::uint64_t quads = 0;             ///< whose four beats were taken
  std::uint64_t fragments = 0;         ///< handed over and compared; zero is a failure, for the caller to say so
  std::uint64_t pixels = 0;            ///< covered pixels that went through the pipeline, discarded ones included
  std::uint64_t mismatches = 0;        ///< payloads that differ (and 1 if the RTL stopped on an assertion)
  std::uint64_t cycle_mismatches = 0;  ///< clocks in which a valid, ready, mask or busy differs
  std::uint64_t cycles_rtl = 0;        ///< clocks until that side had nothing left to do
  std::uint64_t cycles_model = 0;
  bool complete = false;  ///< every quad was drawn: not ended by a limit, a difference or the watchdog
  std::optional<std::string> first_divergence;
  std::optional<DivergentPixel> first_pixel;  ///< that it is about
  std::vector<BoundaryCount> boundaries;
  PerformanceCounters counters;     ///< of the model; the RTL's were the same if the configuration has them
  std::uint64_t compared_bits = 0;  ///< over all boundaries
  double wall_seconds = 0;          ///< of the loop; building the RTL is not in it
  std::uint64_t fragment_hash = 0;  ///< of the fragment stream, bits and order

  bool agreed() const { return mismatches == 0 && cycle_mismatches == 0; }
};

/// Verilates what `options` ask for and runs both sides. The sink (may be empty) gets the RTL's fragments in order.
/// Throws EnvironmentError (no tool), SystemError (no room for the waveform), VerilateError, DeviceError (widths
/// differ), WatchdogError (when nothing differed before) and std::invalid_argument. An assertion of the RTL that fails
/// counts as a mismatch and ends the run.
LockstepReport run_lockstep(std::span<const SnappedQuad> quads, const LockstepOptions& options,
                            const FragmentSink& sink = {});

/// The same in two steps, for many runs of one machine: finding a simulator in the cache takes longer than a short run.
/// Both options must ask for the same machine.
Simulator simulator_in_lockstep(const LockstepOptions& options);
LockstepReport run_lockstep(const Simulator& simulator, std::span<const SnappedQuad> quads,
                            const LockstepOptions& options, const FragmentSink& sink = {});

/// The same with a device that exists already (its probes must be there when options.probes is set).
LockstepReport run_lockstep(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& options,
                            const FragmentSink& sink = {});

/// Draws one after the other in one machine: registers, memories and what is hidden stay from draw to draw.
class LockstepSession {
 public:
  /// All draws must ask for the same machine. A waveform of the options is of all of them.
  LockstepSession(const Simulator& simulator, const LockstepOptions& options);
  /// With a device that exists already and must outlive it.
  LockstepSession(Device& device, const LockstepOptions& options);
  ~LockstepSession();

  /// As run_lockstep(); the first draw, and the one that follows reset(), begins with a reset, any other with `clears`
  /// clears of what is hidden, the last of them in the first clock of the draw. Counters are those since the reset.
  LockstepReport draw(std::span<const SnappedQuad> quads, LockstepOptions options, unsigned clears,
                      const FragmentSink& sink = {});
  /// The next draw begins with a reset: whatever the machine is doing, where a limit ended the draw before.
  void reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One side alone.
struct AloneRun {
  std::uint64_t quads = 0, fragments = 0, cycles = 0;
  bool complete = false;  ///< every quad was drawn: not ended by a limit
  double seconds = 0;     ///< of the loop
  std::uint64_t fragment_hash = 0;
  PerformanceCounters counters;  ///< of the clocked model; of the RTL if the configuration has them, else 0
};

/// The RTL without probes and without comparison: its own speed, and `--engine rtl`. Of the options probes and the
/// limits of differences are ignored. Throws as run_lockstep() does; a failed assertion is a DeviceError here.
AloneRun run_rtl_alone(std::span<const SnappedQuad> quads, const LockstepOptions& options,
                       const FragmentSink& sink = {});

/// The same in two steps, for many runs of one machine: finding a simulator in the cache takes longer than a short run.
Simulator simulator_alone(const LockstepOptions& options);
AloneRun run_rtl_alone(const Simulator& simulator, std::span<const SnappedQuad> quads, const LockstepOptions& options,
                       const FragmentSink& sink = {});

/// Both simulators, built in parallel, for most of a build is one process; the one alone without waveforms.
struct Simulators {
  Simulator in_lockstep, alone;
};
Simulators build_simulators(const LockstepOptions& options);

/// The clocked model without the RTL.
AloneRun run_clocked_model_alone(std::span<const SnappedQuad> quads, const LockstepOptions& options,
                                 const FragmentSink& sink = {});

}  // namespace quadrille::tb
