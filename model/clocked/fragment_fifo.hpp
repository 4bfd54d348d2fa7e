#pragma once

#include "model/clocked/pixel_pipeline.hpp"
#include "model/clocked/sync_fifo.hpp"

namespace quadrille::clocked {

/// What left the pipeline and waits for the port. It has a place for each clock's pixels on their way (pixel_emit
/// counts them).
struct FragmentFifo {
  /// quadrille_pkg::FRAGMENT_FIFO_LOG2: at full rate a place is free again so many clocks after its pixel was sent.
  static constexpr std::size_t places = PixelPipeline::fragment_places;

  /// The fragments of a clock's lanes, those that are drawn, by their places in the pipeline's memory.
  struct Beat {
    std::uint32_t drawn = 0;
    std::array<std::uint32_t, Config::most_pixels_per_clock> fragment;
  };

  SyncFifo<Beat> beats{places};
  bool freed = false;  ///< fragments left in the clock before

  void reset() {
    beats.clear();
    freed = false;
  }

  /// The edge; `last`: the pipeline's last register.
  void clock(bool ready, std::span<const Pixel> last) {
    freed = beats.valid() && ready;
    Beat& beat = beats.next();
    beat.drawn = 0;
    for (std::size_t lane = 0; lane < last.size(); ++lane) {
      if (!last[lane].drawn()) continue;
      beat.drawn |= 1u << lane;
      beat.fragment[lane] = last[lane].fragment;
    }
    beats.clock(freed, beat.drawn != 0);
  }
};

}  // namespace quadrille::clocked
