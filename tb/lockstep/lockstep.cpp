#include "tb/lockstep/lockstep.hpp"

#include "model/drive.hpp"
#include "model/port/bit_vector.hpp"
#include "tb/device/forwarding_device.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/device_ahead.hpp"
#include "tb/lockstep/driven_device.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <cstring>
#include <future>
#include <optional>
#include <system_error>
#include <utility>

namespace quadrille::tb {

namespace {

int fragment_width(const Config& config) { return boundary_layout(Boundary::fragment, config).bits(); }

/// Gives a run up when nothing enters or leaves the machine for longer than its longest silent walk.
class Watchdog {
 public:
  explicit Watchdog(const LockstepOptions& o) : limit_(o.watchdog) {
    if (limit_ != 0) return;
    // A homogeneous quad without a fragment walks every tile of the viewport and, with the hierarchy switched off,
    // every row.
    const auto tiles = [&](int pixels) { return static_cast<std::uint64_t>(pixels / o.config.tile() + 2); };
    limit_ =
        100'000 + 4 * tiles(o.state.width) * tiles(o.state.height) * static_cast<std::uint64_t>(o.config.tile() + 2);
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

/// Both side by side. The device leads: it takes the beats, so that its side can be ahead of the model's.
template <class DeviceSide>
class DrivenPair {
 public:
  /// `cycle` counts the clocks, for whoever catches what the device throws.
  DrivenPair(DeviceSide& device, DrivenModel& model, std::uint64_t& cycle)
      : device_(device), model_(model), cycle_(cycle) {}

  struct Outputs {
    const DeviceSample& actual;
    ClockedOutputs expected;
    bool vertex_ready;
  };
  Outputs settle(const Stimulus& stimulus) {
    const DeviceSample& actual = device_.settle(stimulus);
    return {actual, model_.settle(stimulus), actual.vertex_ready};
  }
  void clock() {
    device_.clock();
    model_.clock();
    ++cycle_;
  }
  PerformanceCounters counters() const { return model_.counters(); }

 private:
  DeviceSide& device_;
  DrivenModel& model_;
  std::uint64_t& cycle_;
};

/// What every run has besides its machine.
struct Run {
  const LockstepOptions& options;
  Stimulus stimulus;
  FragmentMonitor monitor;
  Watchdog watchdog;
  Stopwatch stopwatch{};

  Run(std::span<const SnappedQuad> quads, const LockstepOptions& o, const FragmentSink& sink)
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

/// `hand_over(monitor, outputs)` in every clock in which fragments leave.
template <class Machine, class HandOver>
AloneRun run_alone(Machine& machine, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                   const FragmentSink& sink, HandOver&& hand_over) {
  Run run(quads, o, sink);
  AloneRun result;
  result.cycles = drive(machine, run.stimulus, [&](std::uint64_t cycle, const auto& out, bool taken) {
    const bool moved = out.fragment_valid && run.stimulus.ready();
    if (moved) hand_over(run.monitor, out);
    if ((run.stimulus.done() && !out.busy) || run.enough()) return false;
    if (run.watchdog.silent(taken || moved)) run.give_up(cycle);
    run.show_progress(cycle);
    return true;
  });
  result.seconds = run.stopwatch.seconds();
  result.quads = run.stimulus.vertices.beats_taken() / 4;
  result.fragments = run.monitor.fragments();
  result.fragment_hash = run.monitor.hash();
  return result;
}

/// A device whose waveform begins with a clock of the run.
class TracedLater : public ForwardingDevice {
 public:
  TracedLater(VerilatedDevice& device, const std::string& file, std::uint64_t from)
      : ForwardingDevice(device), traced_(device), file_(file), from_(from) {}

  void set_reset(bool active) override {
    if (!active) clocks_ = 0;  // counted from the end of reset
    ForwardingDevice::set_reset(active);
  }
  void settle() override {
    if (!open_ && clocks_ == from_) {
      traced_.open_trace(file_);
      open_ = true;
    }
    ForwardingDevice::settle();
  }
  void clock() override {
    ForwardingDevice::clock();
    ++clocks_;
  }

 private:
  VerilatedDevice& traced_;
  const std::string& file_;
  std::uint64_t from_, clocks_ = ~std::uint64_t{0} / 2;  ///< before the end of reset beyond every clock
  bool open_ = false;
};

VerilateOptions build_options(const LockstepOptions& o, bool probes) {
  VerilateOptions build;
  build.probes = probes;
  build.trace = o.trace.has_value();
  build.source = o.source;
  build.optimise = o.optimise;
  return build;
}

Probes probes_of(const LockstepOptions& o) { return o.probes ? Probes::all : Probes::without_pixels; }

/// A waveform and the counters of the RTL end where the run does.
bool has_thread(const LockstepOptions& o) { return o.threads > 1 && !o.trace && o.config.performance_counters == 0; }

/// One draw of both machines, as `model` is: after reset, or as the draw before left it. `another` may follow.
LockstepReport run_both(Device& device, DrivenModel& model, Scoreboard& scoreboard, std::span<const SnappedQuad> quads,
                        const LockstepOptions& o, const FragmentSink& sink, bool another) {
  Run run(quads, o, sink);
  LockstepReport report;
  std::uint64_t clocks = 0, differing_clocks = 0;
  const auto look = [&](std::uint64_t cycle, const auto& out, bool taken) {
    const ClockedOutputs& expected = out.expected;
    const DeviceSample& actual = out.actual;

    // 1. Compare.
    const Scoreboard::Verdict verdict = scoreboard.compare(cycle, expected, actual);
    const bool moved = actual.fragment_valid && run.stimulus.ready();
    if (moved)
      for_each_lane(actual, [&](std::size_t lane, const std::uint32_t* words) {
        run.monitor.handed_over(words, verdict.fragment ? expected.fragment[lane] : nullptr);
      });
    report.pixels += static_cast<std::uint64_t>(expected.probes.pixels);

    // 2. Whether and how the run ends. The model says when all is drawn.
    const bool model_idle = run.stimulus.done() && !expected.busy, rtl_idle = run.stimulus.done() && !actual.busy;
    if (!model_idle) report.cycles_model = cycle + 1;
    if (!rtl_idle) report.cycles_rtl = cycle + 1;
    report.complete = model_idle && rtl_idle && !(o.clear_hidden && cycle == 0);
    if (report.complete) return false;
    if (!verdict.timing || !verdict.payload) {
      ++differing_clocks;
      if (o.stop_at_first || differing_clocks == o.limit_differences) return false;
    }
    if (run.enough()) return false;
    if (run.watchdog.silent(taken || moved || expected.probes.tile != nullptr || expected.probes.stamp != nullptr)) {
      if (scoreboard.first_divergence()) return false;  // that says more than the hang that came of it
      run.give_up(cycle);
    }
    run.show_progress(cycle);
    return true;
  };
  try {
    const auto run_pair = [&](auto& side) {
      DrivenPair pair(side, model, clocks);
      const std::uint64_t end = drive(pair, run.stimulus, look);
      report.counters = pair.counters();
      return end;
    };
    std::optional<DeviceAhead> ahead;
    if (has_thread(o)) try {
        ahead.emplace(device, quads, o);
      } catch (const std::system_error&) {  // no thread to be had: both in this one
      }
    // Before another draw both take the edge of the last clock, which a device ahead has taken.
    if (ahead) {
      run_pair(*ahead);
      if (another) model.clock();
    } else {
      DrivenDevice side(device, o);
      const std::uint64_t end = run_pair(side);
      if (o.config.performance_counters != 0) scoreboard.compare_counters(end, report.counters, device);
      if (another) side.clock(), model.clock();
    }
  } catch (const DeviceError& stop) {
    scoreboard.device_stopped(clocks, stop.what());
  }

  report.wall_seconds = run.stopwatch.seconds();
  report.quads = run.stimulus.vertices.beats_taken() / 4;
  report.fragments = run.monitor.fragments();
  report.fragment_hash = run.monitor.hash();
  report.mismatches = scoreboard.mismatches();
  report.cycle_mismatches = scoreboard.cycle_mismatches();
  report.first_divergence = scoreboard.first_divergence();
  report.first_pixel = scoreboard.first_pixel();
  report.boundaries = scoreboard.counts();
  for (const BoundaryCount& count : report.boundaries) report.compared_bits += count.bits;
  return report;
}

}  // namespace

LockstepReport run_lockstep(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                            const FragmentSink& sink) {
  DrivenModel model(o.config, o.state, probes_of(o));
  Scoreboard scoreboard(o.config, quads, o.probes, o.seed);
  return run_both(device, model, scoreboard, quads, o, sink, false);
}

struct LockstepSession::Impl {
  std::unique_ptr<VerilatedDevice> owned;
  Device& device;
  std::optional<DrivenModel> model;      ///< none: the next draw begins with a reset
  std::optional<Scoreboard> scoreboard;  ///< of the draw before

  Impl(std::unique_ptr<VerilatedDevice> made, Device& given) : owned(std::move(made)), device(given) {}

  LockstepReport draw(std::span<const SnappedQuad> quads, LockstepOptions o, bool clear, const FragmentSink& sink) {
    o.go_on = model.has_value();
    o.clear_hidden = o.go_on && clear;
    Scoreboard board(o.config, quads, o.probes, o.seed);
    if (o.go_on) {
      model->set_state(o.state);
      board.follows(*scoreboard);
    } else {
      model.emplace(o.config, o.state, probes_of(o));
    }
    const LockstepReport report = run_both(device, *model, board, quads, o, sink, true);
    scoreboard.emplace(board);
    return report;
  }
};

LockstepSession::LockstepSession(const Simulator& simulator, const LockstepOptions& o) {
  auto device = std::make_unique<VerilatedDevice>(simulator, o.config, o.seed);
  if (o.trace) device->open_trace(*o.trace);
  Device& machine = *device;
  impl_ = std::make_unique<Impl>(std::move(device), machine);
}

LockstepSession::LockstepSession(Device& device, const LockstepOptions&)
    : impl_(std::make_unique<Impl>(nullptr, device)) {}

LockstepSession::~LockstepSession() {
  if (impl_->owned) impl_->owned->close_trace();
}

LockstepReport LockstepSession::draw(std::span<const SnappedQuad> quads, LockstepOptions o, unsigned clears,
                                     const FragmentSink& sink) {
  for (; clears > 1 && impl_->model; --clears) {
    LockstepOptions alone = o;
    alone.threads = 1;  // a few clocks
    alone.progress = nullptr;
    if (LockstepReport report = impl_->draw({}, alone, true, {}); !report.agreed()) return report;
  }
  return impl_->draw(quads, std::move(o), clears > 0, sink);
}

void LockstepSession::reset() {
  impl_->model.reset();
  impl_->scoreboard.reset();
}

Simulator simulator_in_lockstep(const LockstepOptions& o) { return verilate(o.config, build_options(o, o.probes)); }

LockstepReport run_lockstep(std::span<const SnappedQuad> quads, const LockstepOptions& o, const FragmentSink& sink) {
  return run_lockstep(simulator_in_lockstep(o), quads, o, sink);
}

LockstepReport run_lockstep(const Simulator& simulator, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                            const FragmentSink& sink) {
  VerilatedDevice device(simulator, o.config, o.seed);
  LockstepReport report;
  if (o.trace && o.trace_from > 0) {
    TracedLater later(device, *o.trace, o.trace_from);
    report = run_lockstep(later, quads, o, sink);
  } else {
    if (o.trace) device.open_trace(*o.trace);
    report = run_lockstep(device, quads, o, sink);
  }
  device.close_trace();
  return report;
}

Simulator simulator_alone(const LockstepOptions& o) { return verilate(o.config, build_options(o, false)); }

Simulators build_simulators(const LockstepOptions& o) {
  LockstepOptions untraced = o;
  untraced.trace.reset();
  std::future<Simulator> alone = std::async(std::launch::async, [&] { return simulator_alone(untraced); });
  Simulator in_lockstep = simulator_in_lockstep(o);
  return {std::move(in_lockstep), alone.get()};
}

AloneRun run_rtl_alone(const Simulator& simulator, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                       const FragmentSink& sink) {
  VerilatedDevice device(simulator, o.config, o.seed);
  if (o.trace) device.open_trace(*o.trace);
  DrivenDevice machine(device, o);
  AloneRun run = run_alone(machine, quads, o, sink, [](FragmentMonitor& monitor, const DeviceSample& out) {
    for_each_lane(out, [&](std::size_t, const std::uint32_t* words) { monitor.handed_over(words, nullptr); });
  });
  if (o.config.performance_counters != 0)
    for (std::size_t i = 0; i < counter_count; ++i) run.counters.value[i] = device.counter(i);
  device.close_trace();
  return run;
}

AloneRun run_rtl_alone(std::span<const SnappedQuad> quads, const LockstepOptions& o, const FragmentSink& sink) {
  return run_rtl_alone(simulator_alone(o), quads, o, sink);
}

AloneRun run_clocked_model_alone(std::span<const SnappedQuad> quads, const LockstepOptions& o,
                                 const FragmentSink& sink) {
  const int width = fragment_width(o.config);
  std::vector<std::uint64_t> packed(static_cast<std::size_t>((width + 63) / 64));
  std::vector<std::uint32_t> words(words_for(width));
  DrivenModel machine(o.config, o.state);
  AloneRun run = run_alone(machine, quads, o, sink, [&](FragmentMonitor& monitor, const ClockedOutputs& out) {
    out.for_each_fragment([&](const Fragment& fragment) {
      pack_fragment(fragment, o.config, packed.data(), width);
      std::memcpy(words.data(), packed.data(), words.size() * sizeof words[0]);
      monitor.handed_over(words.data(), &fragment);
    });
  });
  run.counters = machine.counters();
  return run;
}

}  // namespace quadrille::tb
