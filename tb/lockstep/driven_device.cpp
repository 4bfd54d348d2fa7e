#include "tb/lockstep/driven_device.hpp"

#include <vector>

namespace quadrille::tb {

DrivenDevice::DrivenDevice(Device& device, const LockstepOptions& o) : device_(device) {
  constexpr int reset_clocks = 4;
  const std::vector<std::uint32_t> state = pack_state(o.state, o.config);
  device_.set_state(state);
  device_.set_handshake(false, false);
  device_.set_reset(true);
  for (int i = 0; i < reset_clocks; ++i) {
    device_.settle();
    device_.clock();
  }
  device_.set_reset(false);
}

}  // namespace quadrille::tb
