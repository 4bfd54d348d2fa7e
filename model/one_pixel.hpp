// The machine's way to one pixel of one quad: the pure functions of all stages, without the walk that finds it.
#pragma once

#include "model/front/stamp_coverage.hpp"
#include "model/pixel/pixel_pipeline.hpp"

namespace quadrille {

struct OnePixel {
  SetupResult setup;
  QuadConstants constants;
  TileEntry tile;
  StampMasks row;  ///< of the tile's row with the pixel
  QuadData data;
  bool covered = false;  ///< by expression (12), not behind the eye, culled or outside the scissor
  PixelTrace trace;      ///< as if it were covered
};

/// Pixel (x, y) of the viewport. Whether the whole quad is left out (quad_reject.hpp) does not matter; skips of a
/// pixel's operands do. `context` is that of the configuration and state.
OnePixel one_pixel(const SnappedQuad& quad, const PipelineContext& context, int x, int y);

}  // namespace quadrille
