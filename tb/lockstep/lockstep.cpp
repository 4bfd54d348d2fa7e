#include "tb/lockstep/lockstep.hpp"

#include "model/bit_vector.hpp"
#include "model/clocked.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/driver.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <memory>

namespace quadrille::tb {

namespace {

constexpr int reset_clocks = 4;

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
  std::string text(std::uint64_t cycle, std::uint64_t beats, std::uint64_t fragments) const {
    return "the machine hangs: busy, but no vertex, tile or fragment moved for " + std::to_string(limit_) +
           " clocks, up to cycle " + std::to_string(cycle) + " (" + std::to_string(beats) + " vertices in, " +
           std::to_string(fragments) + " fragments out)";
  }

 private:
  std::uint64_t limit_, silent_ = 0;
};

/// Calls the progress function at most every 2^14 clocks.
void show_progress(const LockstepOptions& o, std::uint64_t cycle, const VertexDriver& vertices,
                   const FragmentMonitor& monitor) {
  if ((cycle & 0x3fff) != 0 || !o.progress) return;
  double part = vertices.fraction();
  if (o.limit_fragments != 0) {
    part = std::max(part, static_cast<double>(monitor.fragments()) / static_cast<double>(o.limit_fragments));
  }
  o.progress(std::min(part, 1.0));
}

void reset(Device& device, const LockstepOptions& o) {
  const std::vector<std::uint32_t> state = pack_state(o.state, o.config);
  device.set_state(state);
  device.set_handshake(false, false);
  device.set_reset(true);
  for (int i = 0; i < reset_clocks; ++i) {
    device.settle();
    device.clock();
  }
  device.set_reset(false);
}

void reset(ClockedModel& model) {
  ClockedInputs inputs;
  inputs.reset = true;
  for (int i = 0; i < reset_clocks; ++i) model.clock(inputs);
}

std::unique_ptr<VerilatedDevice> make_device(const LockstepOptions& o, bool probes) {
  VerilateOptions build;
  build.probes = probes;
  build.trace = o.trace.has_value();
  build.source = o.source;
  build.optimise = o.optimise;
  auto device = std::make_unique<VerilatedDevice>(o.config, build, o.seed);
  if (o.trace) device->open_trace(*o.trace);
  return device;
}

int fragment_width(const Config& config) { return boundary_layout(Boundary::fragment, config).bits(); }

}  // namespace

LockstepReport run_lockstep(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                            const FragmentSink& sink) {
  VertexDriver vertices(quads, o.config, o.seed, o.gap);
  ReadyDriver stalls(o.seed, o.stall);
  FragmentMonitor monitor(o.config, fragment_width(o.config), sink);
  Scoreboard scoreboard(o.config, quads, o.probes, o.seed);
  ClockedModel model(o.config, o.state);
  Watchdog watchdog(o);
  LockstepReport report;
  const Stopwatch stopwatch;

  std::uint64_t cycle = 0, differing_clocks = 0;
  try {
    reset(device, o);
    reset(model);
    ClockedInputs inputs;
    for (;; ++cycle) {
      // 1. Drive.
      inputs.vertex_valid = vertices.valid();
      inputs.fragment_ready = stalls.ready();
      if (vertices.changed()) {
        device.set_vertex(vertices.words());
        if (vertices.valid()) {
          inputs.vertex_id = vertices.id();
          inputs.vertex = vertices.vertex();
        }
      }
      device.set_handshake(inputs.vertex_valid, inputs.fragment_ready);

      // 2. Settle.
      device.settle();
      const ClockedOutputs expected = model.comb();
      const DeviceSample& actual = device.sample();

      // 3. Compare.
      const Scoreboard::Verdict verdict = scoreboard.compare(cycle, expected, actual);
      const bool moved = actual.fragment_valid && inputs.fragment_ready;
      if (moved) monitor.handed_over(actual.fragment, verdict.fragment ? &expected.fragment : nullptr);
      if (expected.probes.diff != nullptr && (!expected.fragment_valid || inputs.fragment_ready)) ++report.pixels;

      // 4. Whether and how the run ends. The model leads: it takes the beats, and it says when all is drawn.
      const bool model_idle = vertices.done() && !expected.busy, rtl_idle = vertices.done() && !actual.busy;
      if (!model_idle) report.cycles_model = cycle + 1;
      if (!rtl_idle) report.cycles_rtl = cycle + 1;
      if (model_idle && rtl_idle) {
        report.complete = true;
        break;
      }
      if (!verdict.timing || !verdict.payload) {
        ++differing_clocks;
        if (o.stop_at_first || differing_clocks == o.limit_differences) break;
      }
      if (o.limit_fragments != 0 && monitor.fragments() >= o.limit_fragments) break;
      const bool taken = inputs.vertex_valid && expected.vertex_ready;
      const bool progress = taken || moved || expected.probes.tile != nullptr || expected.probes.stamp != nullptr;
      if (watchdog.silent(progress)) {
        if (scoreboard.first_divergence()) break;  // that says more than the hang that came of it
        throw WatchdogError(watchdog.text(cycle, vertices.beats_taken(), monitor.fragments()));
      }

      // 5. Clock.
      device.clock();
      model.clock(inputs);
      vertices.advance(taken);
      stalls.advance();
      show_progress(o, cycle, vertices, monitor);
    }
  } catch (const DeviceError& stop) {
    scoreboard.device_stopped(cycle, stop.what());
  }

  report.wall_seconds = stopwatch.seconds();
  report.quads = vertices.beats_taken() / 4;
  report.fragments = monitor.fragments();
  report.fragment_hash = monitor.hash();
  report.mismatches = scoreboard.mismatches();
  report.cycle_mismatches = scoreboard.cycle_mismatches();
  report.first_divergence = scoreboard.first_divergence();
  report.boundaries = scoreboard.counts();
  for (const BoundaryCount& count : report.boundaries) report.compared_bits += count.bits;
  return report;
}

LockstepReport run_lockstep(std::span<const SnappedQuad> quads, const LockstepOptions& options,
                            const FragmentSink& sink) {
  const std::unique_ptr<VerilatedDevice> device = make_device(options, options.probes);
  return run_lockstep(*device, quads, options, sink);
}

RtlRun run_rtl_alone(std::span<const SnappedQuad> quads, const LockstepOptions& o, const FragmentSink& sink) {
  const std::unique_ptr<VerilatedDevice> device = make_device(o, false);
  VertexDriver vertices(quads, o.config, o.seed, o.gap);
  ReadyDriver stalls(o.seed, o.stall);
  FragmentMonitor monitor(o.config, fragment_width(o.config), sink);
  Watchdog watchdog(o);
  RtlRun run;
  const Stopwatch stopwatch;

  reset(*device, o);
  for (;; ++run.cycles) {
    if (vertices.changed()) device->set_vertex(vertices.words());
    device->set_handshake(vertices.valid(), stalls.ready());
    device->settle();
    const DeviceSample& out = device->sample();
    const bool moved = out.fragment_valid && stalls.ready();
    if (moved) monitor.handed_over(out.fragment, nullptr);
    if (vertices.done() && !out.busy) break;
    if (o.limit_fragments != 0 && monitor.fragments() >= o.limit_fragments) break;
    const bool taken = vertices.valid() && out.vertex_ready;
    if (watchdog.silent(taken || moved)) {
      throw WatchdogError(watchdog.text(run.cycles, vertices.beats_taken(), monitor.fragments()));
    }
    device->clock();
    vertices.advance(taken);
    stalls.advance();
    show_progress(o, run.cycles, vertices, monitor);
  }
  run.seconds = stopwatch.seconds();
  run.quads = vertices.beats_taken() / 4;
  run.fragments = monitor.fragments();
  run.fragment_hash = monitor.hash();
  return run;
}

AloneRun run_clocked_model_alone(std::span<const SnappedQuad> quads, const LockstepOptions& o,
                                 const FragmentSink& sink) {
  ClockedModel model(o.config, o.state);
  VertexDriver vertices(quads, o.config, o.seed, o.gap);
  ReadyDriver stalls(o.seed, o.stall);
  const int width = fragment_width(o.config);
  FragmentMonitor monitor(o.config, width, sink);
  Watchdog watchdog(o);
  std::vector<std::uint64_t> packed(static_cast<std::size_t>((width + 63) / 64));
  std::vector<std::uint32_t> words(words_for(width));
  AloneRun run;
  const Stopwatch stopwatch;

  reset(model);
  ClockedInputs inputs;
  for (;; ++run.cycles) {
    inputs.vertex_valid = vertices.valid();
    inputs.fragment_ready = stalls.ready();
    if (vertices.changed() && vertices.valid()) {
      inputs.vertex_id = vertices.id();
      inputs.vertex = vertices.vertex();
    }
    const ClockedOutputs out = model.comb();
    const bool moved = out.fragment_valid && inputs.fragment_ready;
    if (moved) {
      pack_fragment(out.fragment, o.config, packed.data(), width);
      std::copy_n(reinterpret_cast<const char*>(packed.data()), words.size() * sizeof words[0],
                  reinterpret_cast<char*>(words.data()));
      monitor.handed_over(words.data(), &out.fragment);
    }
    if (vertices.done() && !out.busy) break;
    if (o.limit_fragments != 0 && monitor.fragments() >= o.limit_fragments) break;
    const bool taken = inputs.vertex_valid && out.vertex_ready;
    if (watchdog.silent(taken || moved)) {
      throw WatchdogError(watchdog.text(run.cycles, vertices.beats_taken(), monitor.fragments()));
    }
    model.clock(inputs);
    vertices.advance(taken);
    stalls.advance();
    show_progress(o, run.cycles, vertices, monitor);
  }
  run.seconds = stopwatch.seconds();
  run.quads = vertices.beats_taken() / 4;
  run.fragments = monitor.fragments();
  run.fragment_hash = monitor.hash();
  return run;
}

}  // namespace quadrille::tb
