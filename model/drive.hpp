// The one loop that drives a machine, whatever its body: vertex beats in, clock after clock, until somebody has seen
// enough.
#pragma once

#include "model/clocked.hpp"
#include "model/port/records.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille {

/// In each clock: settle, look, clock.
///
/// stimulus.valid()        a vertex beat is on offer in this clock
/// stimulus.advance(taken) after the edge; `taken`: the beat on offer was accepted by it
/// machine.settle(stimulus) drives the inputs and returns what leaves the machine then, vertex_ready among it
/// machine.clock()         the rising edge
/// look(cycle, outputs, taken) sees every clock before its edge; false ends the run there
///
/// Returns the number of clocks before the one in which the run ended.
template <class Machine, class Stimulus, class Look>
std::uint64_t drive(Machine& machine, Stimulus& stimulus, Look&& look) {
  for (std::uint64_t cycle = 0;; ++cycle) {
    const auto& outputs = machine.settle(stimulus);
    const bool taken = stimulus.valid() && outputs.vertex_ready;
    if (!look(cycle, outputs, taken)) return cycle;
    machine.clock();
    stimulus.advance(taken);
  }
}

/// The clocked model as a machine for drive(), after reset. Of a stimulus it also wants ready() of the fragment port,
/// changed() of the beat() on offer; clear_hidden() and flush() where it has them.
class DrivenModel {
 public:
  DrivenModel(const Config& config, const DrawState& state, Probes probes = Probes::without_pixels)
      : model_(config, state, probes) {
    inputs_.reset = true;
    model_.clock(inputs_);
    inputs_.reset = false;
  }

  template <class Stimulus>
  ClockedOutputs settle(const Stimulus& stimulus) {
    inputs_.vertex_valid = stimulus.valid();
    inputs_.fragment_ready = stimulus.ready();
    if constexpr (requires { stimulus.flush(); }) {
      inputs_.clear_hidden = stimulus.clear_hidden();
      inputs_.flush = stimulus.flush();
    }
    if (stimulus.changed() && stimulus.valid()) inputs_.vertex = stimulus.beat();
    return model_.comb();
  }
  void clock() { model_.clock(inputs_); }
  void set_state(const DrawState& state) { model_.set_state(state); }
  /// Clocks until the places of hidden tiles are wiped: at once without them.
  void wait_idle() {
    while (model_.comb().busy) model_.clock(inputs_);
  }
  PerformanceCounters counters() const { return model_.counters(); }

 private:
  ClockedModel model_;
  ClockedInputs inputs_;
};

/// The beats of a list of quads, four each, on offer without a gap; every fragment is taken.
class SteadyBeats {
 public:
  explicit SteadyBeats(std::span<const SnappedQuad> quads) : quads_(quads) {}

  bool done() const { return next_ == 4 * quads_.size(); }
  bool valid() const { return !done(); }
  bool ready() const { return true; }
  bool changed() const { return true; }
  VertexBeat beat() const { return beat_of(quads_[next_ / 4], next_ % 4); }
  std::size_t taken() const { return next_; }
  void advance(bool taken) { next_ += taken ? 1 : 0; }

 private:
  std::span<const SnappedQuad> quads_;
  std::size_t next_ = 0;
};

}  // namespace quadrille
