#include "tb/lockstep/pixel_watch.hpp"

#include "model/clocked.hpp"
#include "model/port/latency.hpp"

#include <utility>

namespace quadrille::tb {
namespace {

constexpr std::size_t boundary_index(Boundary b) { return static_cast<std::size_t>(b); }

/// Clocks behind `diff`: the pipeline never waits.
constexpr std::array<std::pair<Boundary, int>, 5> behind_diff{{
    {Boundary::norm, latency::norm_stage - latency::diff_stage},
    {Boundary::sqrt, latency::root_stage - latency::diff_stage},
    {Boundary::ratio, latency::ratio_stage - latency::diff_stage},
    {Boundary::weight, latency::weight_stage - latency::diff_stage},
    {Boundary::sum, latency::sum_stage - latency::diff_stage},
}};

}  // namespace

PixelWatch::PixelWatch(Device& device, const Config& config, int x, int y)
    : ForwardingDevice(device),
      tile_log2_(config.tile_log2),
      x_(x),
      y_(y),
      ring_(static_cast<std::size_t>(2 * ring_entries(config))) {
  for (std::size_t i = 0; i <= probe_count; ++i) layouts_.push_back(boundary_layout(static_cast<Boundary>(i), config));
}

const DeviceSample& PixelWatch::sample() {
  const DeviceSample& sample = ForwardingDevice::sample();
  look(sample);
  return sample;
}

void PixelWatch::clock() {
  ForwardingDevice::clock();
  ++clock_;
}

std::optional<Record> PixelWatch::record_of(Boundary boundary, std::size_t lane, const DeviceSample& sample) const {
  const bool port = boundary == Boundary::fragment;
  const std::uint32_t valid = port ? sample.fragment_mask : sample.probe[boundary_index(boundary)].valid;
  const std::uint32_t* words = port ? sample.fragment[lane] : sample.probe[boundary_index(boundary)].words[lane];
  if ((valid >> lane & 1) == 0 || words == nullptr) return std::nullopt;
  return Record::from_words(words, layout(boundary).bits());
}

std::int64_t PixelWatch::field(Boundary boundary, const Record& record, const char* name) const {
  return static_cast<std::int64_t>(record.get(layout(boundary).field(name)));
}

void PixelWatch::look(const DeviceSample& sample) {
  look_at_front(sample);
  for (std::size_t lane = 0; lane < most_lanes; ++lane)
    for (const Boundary b : {Boundary::diff, Boundary::fragment}) {
      auto record = record_of(b, lane, sample);
      if (!record || field(b, *record, "x") != x_ || field(b, *record, "y") != y_) continue;
      if (b == Boundary::diff && !entered_) {
        entered_ = clock_;
        lane_ = lane;
      }
      record_[boundary_index(b)] = std::move(record);
    }
  for (const auto& [boundary, clocks] : behind_diff)
    if (entered_ && clock_ == *entered_ + static_cast<std::uint64_t>(clocks))
      record_[boundary_index(boundary)] = record_of(boundary, lane_, sample);
}

void PixelWatch::look_at_front(const DeviceSample& sample) {
  if (auto setup = record_of(Boundary::setup, 0, sample)) record_[boundary_index(Boundary::setup)] = std::move(setup);
  if (auto tile = record_of(Boundary::tile, 0, sample)) {
    // A tile of a homogeneous quad takes an entry for each part of its functions.
    const std::optional<Record>& setup = record_[boundary_index(Boundary::setup)];
    const bool parts =
        field(Boundary::tile, *tile, "end_token") == 0 && setup && field(Boundary::setup, *setup, "homogeneous") != 0;
    ring_[ring_write_] = std::move(tile);
    ring_write_ = (ring_write_ + (parts ? latency::homogeneous_parts : 1)) % ring_.size();
  }
  auto stamp = record_of(Boundary::stamp, 0, sample);
  if (!stamp || field(Boundary::stamp, *stamp, "end_token") != 0) return;
  const std::optional<Record>& tile =
      ring_[static_cast<std::size_t>(field(Boundary::stamp, *stamp, "tile_ptr")) % ring_.size()];
  if (!tile || field(Boundary::tile, *tile, "tile_x") != x_ >> tile_log2_ ||
      field(Boundary::tile, *tile, "tile_y") != y_ >> tile_log2_ ||
      field(Boundary::stamp, *stamp, "row") != (y_ & ((1 << tile_log2_) - 1)))
    return;
  record_[boundary_index(Boundary::tile)] = tile;
  record_[boundary_index(Boundary::stamp)] = std::move(stamp);
}

}  // namespace quadrille::tb
