// A device that passes everything on to another: what watches or traces one overrides what it needs.
#pragma once

#include "tb/device/device.hpp"

namespace quadrille::tb {

class ForwardingDevice : public Device {
 public:
  /// `device` must outlive it.
  explicit ForwardingDevice(Device& device) : device_(device) {}

  void set_reset(bool active) override { device_.set_reset(active); }
  void set_state(std::span<const std::uint32_t> words) override { device_.set_state(words); }
  void set_vertex(std::span<const std::uint32_t> words) override { device_.set_vertex(words); }
  void set_clear_hidden(bool active) override { device_.set_clear_hidden(active); }
  void set_flush(bool active) override { device_.set_flush(active); }
  void set_handshake(bool vertex_valid, bool fragment_ready) override {
    device_.set_handshake(vertex_valid, fragment_ready);
  }
  void settle() override { device_.settle(); }
  const DeviceSample& sample() override { return device_.sample(); }
  std::uint32_t counter(std::size_t index) override { return device_.counter(index); }
  void clock() override { device_.clock(); }

 private:
  Device& device_;
};

}  // namespace quadrille::tb
