#include "tb/lockstep/lockstep.hpp"

#include "model/drive.hpp"
#include "tb/device/forwarding_device.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/device_ahead.hpp"
#include "tb/lockstep/driven_device.hpp"
#include "tb/lockstep/run.hpp"

#include <future>
#include <optional>
#include <system_error>
#include <utility>

namespace quadrille::tb {

namespace {

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
  MachineRun run(quads, o, sink);
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
  if (!o.compare) return run_uncompared(device, quads, o, sink);
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

}  // namespace quadrille::tb
