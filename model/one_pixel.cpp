#include "model/one_pixel.hpp"

#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"

namespace quadrille {

OnePixel one_pixel(const SnappedQuad& quad, const PipelineContext& context, int x, int y) {
  const Config& config = context.config;
  OnePixel out;
  out.setup = quad_setup(quad, config, context.state);
  out.constants = QuadConstants(out.setup);
  TileEntry& tile = out.tile;
  tile.tile_x = x >> config.tile_log2;
  tile.tile_y = y >> config.tile_log2;
  const int from_x = (tile.tile_x - out.setup.tile_x0) * config.tile(),
            from_y = (tile.tile_y - out.setup.tile_y0) * config.tile();
  WalkState walk;
  for (std::size_t k = 0; k < linear_count; ++k) walk.linear[k] = out.setup.linear[k].value;
  walk_step(walk, out.constants, from_x, from_y);
  tile.linear = walk.linear;
  tile.quadratic = tile_context(out.constants, from_x, from_y, config.qdrop());
  const int dx = x & (config.tile() - 1), row = y & (config.tile() - 1);
  out.row = stamp_coverage(tile, out.constants, row, config, context.state);
  out.covered = (out.row.mask >> dx & 1) != 0;
  out.trace.front = (out.row.front >> dx & 1) != 0;
  out.trace.tie = (out.row.tie >> dx & 1) != 0;
  out.data = quad_data(quad, out.setup, config, context.state);
  pixel_pipeline(out.trace, tile, out.constants, out.data, dx, row, context);
  return out;
}

}  // namespace quadrille
