// One side without the other.
#include "tb/lockstep/run.hpp"

#include "model/drive.hpp"
#include "tb/device/verilated_device.hpp"

#include <cstring>
#include <string>
#include <vector>

namespace quadrille::tb {
namespace {

/// `hand_over(monitor, outputs)` in every clock in which fragments leave.
template <class Machine, class HandOver>
AloneRun run_alone(Machine& machine, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                   const FragmentSink& sink, HandOver&& hand_over) {
  MachineRun run(quads, o, sink);
  AloneRun result;
  result.cycles = drive(machine, run.stimulus, [&](std::uint64_t cycle, const auto& out, bool taken) {
    const bool moved = out.fragment_valid && run.stimulus.ready();
    if (moved) hand_over(run.monitor, out);
    result.complete = run.stimulus.done() && !out.busy;
    if (result.complete || run.enough()) return false;
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

AloneRun run_device_alone(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                          const FragmentSink& sink) {
  DrivenDevice machine(device, o);
  AloneRun run = run_alone(machine, quads, o, sink, [](FragmentMonitor& monitor, const DeviceSample& out) {
    for_each_lane(out, [&](std::size_t, const std::uint32_t* words) { monitor.handed_over(words, nullptr); });
  });
  if (o.config.performance_counters != 0)
    for (std::size_t i = 0; i < counter_count; ++i) run.counters.value[i] = device.counter(i);
  return run;
}

}  // namespace

LockstepReport run_uncompared(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                              const FragmentSink& sink) {
  LockstepReport report;
  std::uint64_t fragments = 0;
  try {
    const AloneRun run = run_device_alone(device, quads, o, [&](const Fragment& fragment) {
      ++fragments;
      if (sink) sink(fragment);
    });
    report.quads = run.quads;
    report.cycles_rtl = run.cycles;
    report.complete = run.complete;
    report.counters = run.counters;
    report.wall_seconds = run.seconds;
    report.fragment_hash = run.fragment_hash;
  } catch (const DeviceError& stop) {
    report.mismatches = 1;
    report.first_divergence = std::string("the RTL stopped: ") + stop.what() + "; seed " + std::to_string(o.seed);
  }
  report.fragments = fragments;
  return report;
}

AloneRun run_rtl_alone(const Simulator& simulator, std::span<const SnappedQuad> quads, const LockstepOptions& o,
                       const FragmentSink& sink) {
  VerilatedDevice device(simulator, o.config, o.seed);
  if (o.trace) device.open_trace(*o.trace);
  const AloneRun run = run_device_alone(device, quads, o, sink);
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
