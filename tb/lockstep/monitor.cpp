#include "tb/lockstep/monitor.hpp"

#include "model/port/bit_vector.hpp"

namespace quadrille::tb {

FragmentMonitor::FragmentMonitor(const Config& config, int width, const FragmentSink& sink)
    : config_(config), sink_(sink), width_(width) {}

void FragmentMonitor::handed_over(const std::uint32_t* words, const Fragment* known) {
  ++fragments_;
  for (std::size_t i = 0; i < words_for(width_); ++i) {
    hash_ = (hash_ ^ words[i]) * 0x100000001b3u;
    hash_ ^= hash_ >> 29;
  }
  if (!sink_) return;
  if (known != nullptr) {
    sink_(*known);
  } else {
    sink_(unpack_fragment(words, width_, config_));
  }
}

}  // namespace quadrille::tb
