// What the tests of corner groups share: the draws, and every covered pixel of one.
#pragma once

#include "golden/scenes/corner_quads.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/pixel/pixel_pipeline.hpp"

#include <functional>

namespace quadrille::golden {

inline CornerDraw draw_of(const Config& config, CornerGroup group, std::uint64_t seed = 1) {
  return corner_draws(config, seed).at(static_cast<std::size_t>(group));
}

inline Config narrow_config() {
  Config config;
  config.set("significand_bits", 12);
  return config;
}

/// Every covered pixel of a draw, discarded ones included, with what led to it.
inline void for_each_pixel(const CornerDraw& draw, const Config& config,
                           const std::function<void(const SnappedQuad&, const TileEntry&, const PixelTrace&)>& f) {
  const PipelineContext context(config, draw.state);
  TileWalk walk(config, draw.state);
  for (const SnappedQuad& quad : draw.quads) {
    const SetupResult setup = quad_setup(quad, config, draw.state);
    const QuadData data = quad_data(quad, setup, config, draw.state);
    walk_tiles(walk, setup, [&](const TileEntry& tile) {
      for_each_covered_pixel(tile, walk.constants(), config, draw.state, [&](const CoveredPixel& at) {
        PixelTrace p;
        p.valid = true;
        pixel_pipeline(p, tile, walk.constants(), data, at.dx, at.row, context);
        f(quad, tile, p);
      });
    });
  }
}

}  // namespace quadrille::golden
