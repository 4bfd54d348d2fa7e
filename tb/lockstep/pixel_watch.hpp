// A device that keeps what its boundaries had for one pixel, of a draw with one quad.
#pragma once

#include "model/port/boundaries.hpp"
#include "tb/device/device.hpp"

#include <optional>
#include <vector>

namespace quadrille::tb {

class PixelWatch final : public Device {
 public:
  /// Pixel (x, y). `device` has probes (else the fragment port alone is watched) and must outlive it.
  PixelWatch(Device& device, const Config& config, int x, int y);

  /// The record at a boundary, if the pixel's came there. Of the fragment port the fragment, if it was not discarded.
  const std::optional<Record>& at(Boundary boundary) const { return record_[static_cast<std::size_t>(boundary)]; }

  void set_reset(bool active) override { device_.set_reset(active); }
  void set_state(std::span<const std::uint32_t> words) override { device_.set_state(words); }
  void set_vertex(std::span<const std::uint32_t> words) override { device_.set_vertex(words); }
  void set_clear_hidden(bool active) override { device_.set_clear_hidden(active); }
  void set_flush(bool active) override { device_.set_flush(active); }
  void set_handshake(bool vertex_valid, bool fragment_ready) override {
    device_.set_handshake(vertex_valid, fragment_ready);
  }
  void settle() override { device_.settle(); }
  const DeviceSample& sample() override;
  std::uint32_t counter(std::size_t index) override { return device_.counter(index); }
  void clock() override;

 private:
  std::optional<Record> record_of(Boundary boundary, std::size_t lane, const DeviceSample& sample) const;
  void look(const DeviceSample& sample);
  void look_at_front(const DeviceSample& sample);
  const RecordLayout& layout(Boundary boundary) const { return layouts_[static_cast<std::size_t>(boundary)]; }
  std::int64_t field(Boundary boundary, const Record& record, const char* name) const;

  Device& device_;
  int tile_log2_, x_, y_;
  std::vector<RecordLayout> layouts_;                            ///< by Boundary
  std::array<std::optional<Record>, probe_count + 1> record_{};  ///< likewise
  std::vector<std::optional<Record>> ring_;                      ///< tiles by their place in the ring
  std::size_t ring_write_ = 0;
  std::uint64_t clock_ = 0;
  std::optional<std::uint64_t> entered_;  ///< the clock in which the pixel was at `diff`
  std::size_t lane_ = 0;                  ///< it is in
};

}  // namespace quadrille::tb
