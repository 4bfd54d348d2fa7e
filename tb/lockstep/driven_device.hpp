// The device under test as a machine for model/drive.hpp, and what drives its inputs.
#pragma once

#include "model/drive.hpp"
#include "tb/device/device.hpp"
#include "tb/lockstep/driver.hpp"
#include "tb/lockstep/lockstep.hpp"

#include <cstdint>
#include <span>

namespace quadrille::tb {

/// What drives the inputs: of quads and options alone, so that two of them that saw the same beats taken are
/// alike. Both must outlive it.
struct Stimulus {
  VertexDriver vertices;
  ReadyDriver stalls;
  PulseDriver clears, flushes;
  bool clear_first;  ///< in the first clock whatever `clears` says

  Stimulus(std::span<const SnappedQuad> quads, const LockstepOptions& o)
      : vertices(quads, o.config, o.state.attributes, o.seed, o.gap, o.waits.gap_beats, o.pattern),
        stalls(o.seed, o.stall, o.waits.stall_clocks, o.pattern),
        clears(o.seed, 7, o.clear, "clear"),
        flushes(o.seed, 8, o.flush, "flush"),
        clear_first(o.clear_hidden) {}

  bool done() const { return vertices.done(); }
  bool valid() const { return vertices.valid(); }
  bool ready() const { return stalls.ready(); }
  bool changed() const { return vertices.changed(); }
  bool clear_hidden() const { return clear_first || clears.high(); }
  bool flush() const { return flushes.high(); }
  const VertexBeat& beat() const { return vertices.beat(); }
  void advance(bool taken) {
    vertices.advance(taken, flush());
    stalls.advance();
    clears.advance();
    flushes.advance();
    clear_first = false;
  }
};

/// The waits that the first `clocks` clocks of a run have, up to the beat number `beats` (counted from 0): the run with
/// these listed in the place of its chances is the same bit by bit, as far as that.
PortWaits recorded_waits(std::span<const SnappedQuad> quads, const LockstepOptions& o, std::uint64_t clocks,
                         std::uint64_t beats);

/// The device as a machine for drive(): after reset or, with LockstepOptions::go_on, as the draw before left it.
class DrivenDevice {
 public:
  DrivenDevice(Device& device, const LockstepOptions& o);

  const DeviceSample& settle(const Stimulus& stimulus) {
    if (stimulus.changed()) device_.set_vertex(stimulus.vertices.words());
    device_.set_handshake(stimulus.valid(), stimulus.ready());
    device_.set_clear_hidden(stimulus.clear_hidden());
    device_.set_flush(stimulus.flush());
    device_.settle();
    return device_.sample();
  }
  void clock() { device_.clock(); }

 private:
  Device& device_;
};

}  // namespace quadrille::tb
