#include "tb/lockstep/driven_device.hpp"

#include <stdexcept>
#include <vector>

namespace quadrille::tb {

PortWaits recorded_waits(std::span<const SnappedQuad> quads, const LockstepOptions& o, std::uint64_t clocks,
                         std::uint64_t beats) {
  if (o.flush != 0) throw std::invalid_argument("waits are not recorded of a run with flushes");
  Stimulus stimulus(quads, o);
  PortWaits waits;
  for (std::uint64_t clock = 0; clock < clocks; ++clock, stimulus.stalls.advance())
    if (!stimulus.ready()) waits.stall_clocks.push_back(clock);
  // How long a beat waits to be taken changes no gap, so here each is taken at once.
  VertexDriver& vertices = stimulus.vertices;
  for (; !vertices.done() && vertices.beats_taken() <= beats; vertices.advance(vertices.valid()))
    if (!vertices.valid()) waits.gap_beats.push_back(vertices.beats_taken());
  return waits;
}

DrivenDevice::DrivenDevice(Device& device, const LockstepOptions& o) : device_(device) {
  constexpr int reset_clocks = 4;
  const std::vector<std::uint32_t> state = pack_state(o.state, o.config);
  device_.set_state(state);
  if (o.go_on) return;
  device_.set_handshake(false, false);
  device_.set_clear_hidden(false);
  device_.set_flush(false);
  device_.set_reset(true);
  for (int i = 0; i < reset_clocks; ++i) {
    device_.settle();
    device_.clock();
  }
  device_.set_reset(false);
}

}  // namespace quadrille::tb
