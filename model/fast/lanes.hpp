// A quad by the quickest lanes that take it: single precision where everything fits, else double, and double for the
// pixels that single precision leaves.
#pragma once

#include "model/fast/float_lanes.hpp"
#include "model/fast/wide_lanes.hpp"

namespace quadrille {

struct LanesQuad {
  bool by_floats = false;  ///< `floats` has it, else `wide`
  FloatQuad floats;
  WideQuad wide;

  const PixelBounds& bounds() const { return by_floats ? static_cast<const PixelBounds&>(floats) : wide; }
};

class Lanes {
 public:
  /// Keeps the address of `context`.
  explicit Lanes(const PipelineContext& context);

  const FloatLanes& floats() const { return floats_; }
  const WideLanes& wide() const { return wide_; }

  void take(const SetupResult& setup, const QuadData& data, LanesQuad& out) const;
  /// Each tile is a list of its own (WideLanes::by_tile).
  bool by_tile(const LanesQuad& quad) const { return !quad.by_floats && wide_.by_tile(); }

  /// As FloatLanes::draw.
  void draw(const LanesQuad& quad, const PixelList& list, int count, LaneResults& out) const;
  /// Draws what draw() left as small of the first `count` pixels, to `results`; returns how many that are.
  int draw_small(const SetupResult& setup, const QuadData& data, const PixelList& list, int count,
                 LaneResults& results);

 private:
  const PipelineContext* context_;
  FloatLanes floats_;
  WideLanes wide_;
  // Of the pixels that were left.
  WideQuad small_quad_;
  PixelList small_list_;
  LaneResults small_results_;
};

}  // namespace quadrille
