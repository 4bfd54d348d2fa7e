#pragma once

#include "model/clocked.hpp"
#include "model/fast/pixels_ahead.hpp"
#include "model/pixel/pixel_pipeline.hpp"
#include "model/port/latency.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::clocked {

/// A pixel on its way.
struct Pixel {
  bool valid = false, end = false;
  std::uint8_t kind = 0;       ///< PixelKind bits
  std::uint32_t slot = 0;      ///< of an end
  std::uint32_t fragment = 0;  ///< its place

  bool drawn() const { return valid && (kind & pixel_drawn) != 0; }
};

/// A delay line from emission to the last register; it never waits. Its stages' counters follow from what was sent.
class PixelPipeline {
 public:
  static constexpr int last_stage = latency::fragment_stage;
  static constexpr std::size_t fragment_places = std::bit_ceil(
      static_cast<std::size_t>(latency::emission + latency::pipeline + latency::fragment_fifo + latency::place_back));

  PixelPipeline(const PipelineContext& context, Probes probes);

  void reset() {
    for (Pixel& p : pixels_) p = {};
    sent_ = {};
    probes_ = {};
  }
  /// The context gets another draw state; `counters` take what was sent in the old one.
  void count_before_change(PerformanceCounters& counters) {
    count(counters);
    sent_ = {};
  }
  /// It has another draw state.
  void set_state();

  std::size_t lanes() const { return lanes_; }
  /// The pixels in register n.
  std::span<const Pixel> stage(int n) const { return {&pixels_[place(n)], lanes_}; }
  /// The pixels of the last register are all discarded.
  bool discards() const {
    bool pixel = false, drawn = false;
    for (const Pixel& last : stage(last_stage)) {
      pixel |= last.valid;
      drawn |= last.drawn();
    }
    return pixel && !drawn;
  }
  const Fragment& fragment(std::uint32_t place) const { return fragments_[place]; }

  /// The edge; then pixels enter the first register.
  void clock() {
    head_ = (head_ + registers - 1) % registers;
    for (std::size_t lane = 0; lane < lanes_; ++lane) pixels_[head_ * lanes_ + lane].valid = false;
    pixels_[head_ * lanes_].end = false;
  }
  void send(std::size_t lane, std::uint8_t kind, const Fragment& fragment) {
    Pixel& p = pixels_[head_ * lanes_ + lane];
    p.valid = true;
    p.kind = kind;
    ++sent_[lane][kind];
    if ((kind & pixel_drawn) == 0) return;
    p.fragment = next_place_;
    fragments_[next_place_] = fragment;
    next_place_ = (next_place_ + 1) & static_cast<std::uint32_t>(fragments_.size() - 1);
  }
  void send_end(std::uint32_t slot) {
    pixels_[head_ * lanes_].end = true;
    pixels_[head_ * lanes_].slot = slot;
  }

  /// With probes of pixels: all numbers of the pixel that is sent next in this lane.
  bool traced() const { return !traces_.empty(); }
  PixelTrace& trace(std::size_t lane) { return traces_[head_ * lanes_ + lane]; }
  /// What the probes show, after the edge; nullptr without.
  const LaneProbes* probes() const { return traced() ? probes_.data() : nullptr; }
  void show_probes();

  /// Adds what the stages' counters have of the pixels sent, of each stage all but those before it or in it.
  void count(PerformanceCounters& to) const;

 private:
  static constexpr int emission = latency::emission;
  /// At least one for each stage.
  static constexpr std::size_t registers = std::bit_ceil(static_cast<std::size_t>(emission + last_stage + 1));

  std::size_t place(int n) const { return (head_ + static_cast<std::size_t>(emission + n)) % registers * lanes_; }

  const PipelineContext& context_;
  std::size_t lanes_;
  std::vector<Pixel> pixels_;  ///< `lanes` for each register: those of stage n begin at place(n)
  std::size_t head_ = 0;
  std::vector<Fragment> fragments_;  ///< of pixels on their way and in the FIFO
  std::uint32_t next_place_ = 0;
  std::vector<PixelTrace> traces_;  ///< beside the pixels, with probes of them
  std::array<LaneProbes, Config::most_pixels_per_clock> probes_{};
  /// Pixels that were sent, by lane and kind.
  std::array<std::array<std::uint64_t, pixel_kinds>, Config::most_pixels_per_clock> sent_{};
  std::array<WantedSums, 2> wanted_;  ///< of pixels of a quad without and with the eye in its hull
  UnitProducts products_;
};

}  // namespace quadrille::clocked
