#include "golden/vectors/machine_run.hpp"

#include "model/drive.hpp"
#include "model/support/prng.hpp"

#include <string>

namespace quadrille::vectors {

std::vector<StallClock> make_stalls(std::uint64_t seed, std::size_t length) {
  golden::Prng random(seed, 0x5741);
  std::vector<StallClock> stalls(length);
  // Each side changes between a lively and a sleepy spell, so that queues run full and empty.
  double offer = 0.9, ready = 0.9;
  for (StallClock& clock : stalls) {
    if (random.chance(1.0 / 32)) offer = random.chance(0.5) ? 0.95 : 0.3;
    if (random.chance(1.0 / 32)) ready = random.chance(0.5) ? 0.95 : 0.3;
    clock = {random.chance(offer), random.chance(ready)};
  }
  if (!stalls.empty()) stalls.front() = {};
  return stalls;
}

namespace {

/// Beats of the quads as a pattern of clocks lets them through.
class PatternBeats : public SteadyBeats {
 public:
  PatternBeats(std::span<const SnappedQuad> quads, std::span<const StallClock> stalls)
      : SteadyBeats(quads), stalls_(stalls) {
    begin_clock();
  }

  bool valid() const { return offered_; }
  bool ready() const { return now_.ready; }
  void advance(bool taken) {
    SteadyBeats::advance(taken);
    if (taken) offered_ = false;
    ++clock_;
    begin_clock();
  }

 private:
  void begin_clock() {
    if (!stalls_.empty()) now_ = stalls_[clock_ % stalls_.size()];
    offered_ = offered_ || (!done() && now_.offer);  // once on offer it stays
  }

  std::span<const StallClock> stalls_;
  StallClock now_;
  std::uint32_t clock_ = 0;
  bool offered_ = false;
};

}  // namespace

MachineRun run_machine(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state,
                       std::span<const StallClock> stalls) {
  DrivenModel model(config, state);
  model.wait_idle();
  PatternBeats beats(quads, stalls);
  MachineRun run;
  drive(model, beats, [&](std::uint64_t cycle, const ClockedOutputs& out, bool taken) {
    const auto clock = static_cast<std::uint32_t>(cycle);
    if (beats.ready()) out.for_each_fragment([&](const Fragment& f) { run.fragments.push_back({f, clock}); });
    if (taken) run.taken.push_back(clock);
    return !beats.done() || out.busy;
  });
  return run;
}

DrawRun run_both(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state,
                 std::span<const StallClock> stalls) {
  DrawRun run{run_machine(quads, config, state, {}), run_machine(quads, config, state, stalls)};
  if (const std::size_t free = run.free.fragments.size(), stalled = run.stalled.fragments.size(); free != stalled)
    throw MachineError("the machine draws " + std::to_string(free) + " fragments, with stalls " +
                       std::to_string(stalled));
  return run;
}

}  // namespace quadrille::vectors
