// The device in a thread of its own, ahead of whoever compares: it needs nothing from the model, since what it takes
// decides when a beat goes on, and what leaves it in each clock is kept until it is looked at.
#pragma once

#include "tb/lockstep/driven_device.hpp"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace quadrille::tb {

/// A machine for drive() like DrivenDevice, with the same samples in the same clocks and the same exceptions. When it
/// is destroyed the device is at most `batches` batches of clocks further, or, where it had nothing left to do, one
/// clock.
class DeviceAhead {
 public:
  /// All three must outlive it; nobody else may use the device meanwhile.
  DeviceAhead(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& options);
  ~DeviceAhead();
  DeviceAhead(const DeviceAhead&) = delete;
  DeviceAhead& operator=(const DeviceAhead&) = delete;

  /// The stimulus is the caller's own: that of the device saw the same beats taken.
  const DeviceSample& settle(const Stimulus&);
  void clock();

 private:
  static constexpr std::size_t batch_clocks = 256, batches = 3;

  /// What left the device in some clocks, and what it threw behind the last of them, in its clock() or, if not, in the
  /// settle() that followed.
  struct Batch {
    std::vector<DeviceSample> sample;
    std::vector<std::uint32_t> words;  ///< what the samples point to
    std::size_t clocks = 0, words_used = 0;
    std::exception_ptr error;
    bool error_in_clock = false;
  };

  struct Recorder;
  void run(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& options);
  void record(const DeviceSample& sample, std::size_t lanes);
  Batch* empty_batch();
  void hand_over(Batch* batch);
  Batch* next_batch();

  std::array<Batch, batches> batch_;
  std::array<std::size_t, probe_count + 1> widths_{};  ///< words of a lane's vector, by Boundary
  Batch* filling_ = nullptr;                           ///< of the device's thread
  Batch* looked_at_ = nullptr;                         ///< of the caller's
  std::size_t at_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Batch*> empty_, full_;  ///< guarded, as what follows
  bool stop_ = false, starved_ = false;
  std::thread thread_;
};

}  // namespace quadrille::tb
