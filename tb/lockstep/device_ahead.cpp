#include "tb/lockstep/device_ahead.hpp"

#include "model/port/bit_vector.hpp"

#include <algorithm>

namespace quadrille::tb {

namespace {

std::size_t lanes_of(std::size_t boundary, std::size_t lanes) {
  return has_lanes(static_cast<Boundary>(boundary)) ? lanes : 1;
}

}  // namespace

/// The device as drive() sees it in its thread. A batch goes over when the clock behind its last sample has been: what
/// that clock throws belongs to the sample.
struct DeviceAhead::Recorder {
  DeviceAhead& ahead;
  DrivenDevice device;
  std::size_t lanes;
  bool in_clock = false, idle = false;

  const DeviceSample& settle(const Stimulus& stimulus) {
    if (idle || ahead.filling_->clocks == batch_clocks) {
      ahead.hand_over(ahead.filling_);
      ahead.filling_ = nullptr;
      if (idle) {  // it need not go on unless somebody asks for it
        std::unique_lock lock(ahead.mutex_);
        ahead.changed_.wait(lock, [&] { return ahead.stop_ || ahead.starved_; });
      }
      ahead.filling_ = ahead.empty_batch();
    }
    const DeviceSample& sample = device.settle(stimulus);
    idle = stimulus.done() && !sample.busy;
    if (ahead.filling_ != nullptr) ahead.record(sample, lanes);
    return sample;
  }
  void clock() {
    in_clock = true;
    device.clock();
    in_clock = false;
  }
};

DeviceAhead::DeviceAhead(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& options) {
  const auto lanes = static_cast<std::size_t>(options.config.pixels_per_clock);
  std::size_t words = 0;
  for (std::size_t i = 0; i <= probe_count; ++i) {
    widths_[i] = words_for(boundary_layout(static_cast<Boundary>(i), options.config).bits());
    words += lanes_of(i, lanes) * widths_[i];
  }
  for (Batch& batch : batch_) {
    batch.sample.resize(batch_clocks);
    batch.words.resize(batch_clocks * words);
    empty_.push_back(&batch);
  }
  thread_ = std::thread([this, &device, quads, &options] { run(device, quads, options); });
}

DeviceAhead::~DeviceAhead() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void DeviceAhead::run(Device& device, std::span<const SnappedQuad> quads, const LockstepOptions& options) {
  filling_ = empty_batch();
  bool in_clock = false;
  try {
    Stimulus stimulus(quads, options);
    Recorder recorder{*this, DrivenDevice(device, options), static_cast<std::size_t>(options.config.pixels_per_clock)};
    try {
      drive(recorder, stimulus, [&](std::uint64_t, const DeviceSample&, bool) { return filling_ != nullptr; });
    } catch (...) {
      in_clock = recorder.in_clock;
      throw;
    }
  } catch (...) {
    if (filling_ == nullptr) return;  // nobody looks any more
    filling_->error = std::current_exception();
    filling_->error_in_clock = in_clock;
    hand_over(filling_);
  }
}

void DeviceAhead::record(const DeviceSample& sample, std::size_t lanes) {
  Batch& batch = *filling_;
  DeviceSample& kept = batch.sample[batch.clocks++];
  kept = sample;
  const auto keep = [&](const std::uint32_t*& words, std::size_t boundary) {
    std::uint32_t* const to = batch.words.data() + batch.words_used;
    std::copy_n(words, widths_[boundary], to);
    batch.words_used += widths_[boundary];
    words = to;
  };
  for (std::size_t i = 0; i < probe_count; ++i)
    for (std::size_t lane = 0; lane < lanes_of(i, lanes); ++lane)
      if ((sample.probe[i].valid >> lane & 1) != 0 && sample.probe[i].words[lane] != nullptr)
        keep(kept.probe[i].words[lane], i);
  for (std::size_t lane = 0; lane < lanes; ++lane) keep(kept.fragment[lane], probe_count);
}

/// Null when the run has ended.
DeviceAhead::Batch* DeviceAhead::empty_batch() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stop_ || !empty_.empty(); });
  if (stop_) return nullptr;
  Batch* const batch = empty_.back();
  empty_.pop_back();
  batch->clocks = batch->words_used = 0;
  return batch;
}

void DeviceAhead::hand_over(Batch* batch) {
  {
    const std::lock_guard lock(mutex_);
    full_.push_back(batch);
    starved_ = false;
  }
  changed_.notify_all();
}

DeviceAhead::Batch* DeviceAhead::next_batch() {
  std::unique_lock lock(mutex_);
  if (full_.empty()) {
    starved_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !full_.empty(); });
  }
  Batch* const batch = full_.front();
  full_.erase(full_.begin());
  return batch;
}

const DeviceSample& DeviceAhead::settle(const Stimulus&) {
  if (looked_at_ == nullptr || at_ == looked_at_->clocks) {
    if (looked_at_ != nullptr) {
      if (looked_at_->error) std::rethrow_exception(looked_at_->error);
      const std::lock_guard lock(mutex_);
      empty_.push_back(looked_at_);
    }
    changed_.notify_all();
    looked_at_ = next_batch();
    at_ = 0;
    if (looked_at_->clocks == 0) std::rethrow_exception(looked_at_->error);
  }
  return looked_at_->sample[at_];
}

void DeviceAhead::clock() {
  ++at_;
  if (at_ == looked_at_->clocks && looked_at_->error && looked_at_->error_in_clock)
    std::rethrow_exception(looked_at_->error);
}

}  // namespace quadrille::tb
