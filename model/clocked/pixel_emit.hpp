#pragma once

#include "model/clocked/pixel_pipeline.hpp"
#include "model/clocked/quad_slots.hpp"
#include "model/clocked/sync_fifo.hpp"
#include "model/clocked/tile_ring.hpp"

namespace quadrille::clocked {

/// Takes stamps apart. Without probes of pixels their fragments are computed together before it comes to them.
struct PixelEmit {
  std::uint32_t rest = 0;  ///< bits of the head's mask still to be emitted; valid when !first
  bool first = true;
  int part = 0;                                 ///< parts of the pixels that were sent, of a homogeneous quad
  int places = PixelPipeline::fragment_places;  ///< that neither fragments have nor pixels on their way
  PixelsAhead ahead;

  explicit PixelEmit(const PipelineContext& context) : ahead(context) {}
  void reset() {
    first = true;
    part = 0;
    places = PixelPipeline::fragment_places;
    ahead.clear();
  }

  /// Computes the head's row and those behind it up to their quad's end.
  void compute_ahead(const SyncFifo<StampEntry>& stamps, const TileRing& ring, const PixelQuad& quad) {
    ahead.begin();
    for (std::size_t n = 0; n < stamps.words() && !ahead.full(); ++n) {
      const StampEntry& row = stamps.word(n);
      if (row.end) break;
      ahead.add(ring.at(row.tile_ptr), row);
    }
    ahead.compute(quad);
  }

  /// The edge, after the pipeline's: pixels enter it. `back`: places of the fragment FIFO that are free again. Returns
  /// whether the head leaves.
  bool clock(int back, const SyncFifo<StampEntry>& stamps, const TileRing& ring, const QuadSlots& slots,
             PixelPipeline& pipeline, const PipelineContext& context) {
    bool pop = false;
    if (stamps.valid()) {
      const StampEntry& s = stamps.head();
      const TileRing::Entry& tile = ring.at(s.tile_ptr);
      if (s.end) {
        pipeline.send_end(tile.slot);
        pop = true;
      } else if (places > 0 && tile.homogeneous && part < latency::homogeneous_parts - 1) {
        ++part;
      } else if (places > 0) {
        part = 0;
        const PixelQuad& quad = slots[tile.slot];
        std::uint32_t mask = first ? s.mask : rest;
        if (!pipeline.traced()) {
          if (ahead.empty()) compute_ahead(stamps, ring, quad);
          for (std::size_t lane = 0; lane < pipeline.lanes() && mask != 0; ++lane, mask &= mask - 1, ahead.advance())
            pipeline.send(lane, ahead.kind(), ahead.fragment());
        } else {
          const TileRow row = forward_difference_row(tile, quad.constants, s.row);
          for (std::size_t lane = 0; lane < pipeline.lanes() && mask != 0; ++lane, mask &= mask - 1) {
            const int dx = std::countr_zero(mask);
            PixelTrace& trace = pipeline.trace(lane);
            trace.front = (s.front >> dx & 1) != 0;
            trace.tie = (s.tie >> dx & 1) != 0;
            pixel_lane(trace, row, quad.constants, quad.data, dx, context);
            pipeline.send(lane, kind_of(trace), trace.fragment);
          }
        }
        rest = mask;
        pop = rest == 0;
        first = pop;
        --back;
      }
    }
    places += back;
    return pop;
  }
};

}  // namespace quadrille::clocked
