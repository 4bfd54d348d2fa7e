// A device that keeps what its boundaries had for one pixel, of a draw with one quad.
#pragma once

#include "model/port/boundaries.hpp"
#include "tb/device/forwarding_device.hpp"

#include <optional>
#include <vector>

namespace quadrille::tb {

class PixelWatch final : public ForwardingDevice {
 public:
  /// Pixel (x, y). `device` has probes (else the fragment port alone is watched) and must outlive it.
  PixelWatch(Device& device, const Config& config, int x, int y);

  /// The record at a boundary, if the pixel's came there. Of the fragment port the fragment, if it was not discarded.
  const std::optional<Record>& at(Boundary boundary) const { return record_[static_cast<std::size_t>(boundary)]; }

  const DeviceSample& sample() override;
  void clock() override;

 private:
  std::optional<Record> record_of(Boundary boundary, std::size_t lane, const DeviceSample& sample) const;
  void look(const DeviceSample& sample);
  void look_at_front(const DeviceSample& sample);
  const RecordLayout& layout(Boundary boundary) const { return layouts_[static_cast<std::size_t>(boundary)]; }
  std::int64_t field(Boundary boundary, const Record& record, const char* name) const;

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
