#include "golden/scenes/shading.hpp"
#include "model/front/quad_reject.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_walk.hpp"
#include "model/page/views.hpp"
#include "model/support/json.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace quadrille::page {
namespace {

/// What became of a tile; of several quads the greatest counts.
enum Fate : std::uint8_t { untouched, block_left_out, left_out, empty, drawn };

}  // namespace

View tiles_view(const Drawing& drawing) {
  const Config& config = drawing.request.config;
  const auto [state, quads] = bare_quads(drawing);
  const int edge = config.tile(), columns = (state.width + edge - 1) / edge, rows = (state.height + edge - 1) / edge;
  std::vector<Fate> fate(static_cast<std::size_t>(columns * rows), untouched);
  const auto raise = [&](int x, int y, Fate to) {
    if (x < 0 || y < 0 || x >= columns || y >= rows) return;
    Fate& at = fate[static_cast<std::size_t>(y * columns + x)];
    at = std::max(at, to);
  };
  UntimedModel model(config, state);
  TileWalk walk(config, state);
  for (const SnappedQuad& quad : quads) {
    model.draw_arrays(quad, [&](const FragmentArrays& f) {
      for (std::size_t n = 0; n < f.size; ++n) raise(f.place[n].x / edge, f.place[n].y / edge, drawn);
    });
    if (reject_by_vertices(quad, config, state) != QuadReject::none) continue;
    const SetupResult setup = quad_setup(quad, config, state);
    if (reject_by_areas(setup, state) != QuadReject::none) continue;
    // The walk's machine as the model runs it, and what it leaves out.
    walk.take(setup);
    while (walk.state() != TileWalk::State::end) {
      const TileBlock block = walk.block();
      if (walk.state() == TileWalk::State::block && !walk.hit())
        for (int y = 0; y < block.rows; ++y)
          for (int x = 0; x < block.columns; ++x) raise(block.tile_x + x, block.tile_y + y, block_left_out);
      if (walk.state() == TileWalk::State::tile) {
        const TileCorner tile = walk.corner();
        raise(tile.tile_x, tile.tile_y, walk.hit() ? empty : left_out);
      }
      walk.advance();
    }
    walk.advance();
  }

  // Of Okabe and Ito's colours, which colour-blind people tell apart.
  static constexpr std::array<golden::Vec3, 5> colours{golden::background_colour, golden::Vec3{0.34, 0.34, 0.36},
                                                       golden::Vec3{0.34, 0.71, 0.91}, golden::Vec3{0.84, 0.37, 0.00},
                                                       golden::Vec3{0.00, 0.45, 0.70}};
  View view;
  view.rgba.resize(static_cast<std::size_t>(4 * state.width * state.height));
  for (int y = 0; y < state.height; ++y)
    for (int x = 0; x < state.width; ++x) {
      const Fate of = fate[static_cast<std::size_t>(y / edge * columns + x / edge)];
      const bool border = of != untouched && (x % edge == 0 || y % edge == 0);
      const auto at = static_cast<std::size_t>(4 * (y * state.width + x));
      for (std::size_t c = 0; c < 3; ++c) view.rgba[at + c] = golden::to_byte(colours[of][c] * (border ? 0.75 : 1.0));
      view.rgba[at + 3] = 255;
    }
  const auto count = [&](Fate of) { return std::ranges::count(fate, of); };
  const DrawStats& stats = model.stats();
  view.json = Json()
                  .put("tile", edge)
                  .put("block_left_out", count(block_left_out))
                  .put("left_out", count(left_out))
                  .put("empty", count(empty))
                  .put("drawn", count(drawn))
                  .put("tiles_tested", stats.tiles_tested)
                  .put("tiles_entered", stats.tiles_entered)
                  .text();
  return view;
}

}  // namespace quadrille::page
