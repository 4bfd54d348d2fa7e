#include "tb/studies/skip_picture.hpp"

#include "model/front/covered_pixels.hpp"
#include "model/front/quad_reject.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_walk.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "model/skips/masked_depth.hpp"
#include "tb/render/frame.hpp"
#include "tb/studies/compare/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace quadrille::tb {
namespace {

/// Of the fates, in their order: grey where work was done, a hue of its own for each reason.
constexpr std::array<std::array<double, 3>, tile_fate_count> colours{{{0.75, 0.75, 0.75},
                                                                      {0.60, 0.25, 0.80},
                                                                      {0.20, 0.75, 0.30},
                                                                      {0.15, 0.35, 0.90},
                                                                      {0.95, 0.55, 0.10},
                                                                      {0.95, 0.90, 0.20},
                                                                      {0.85, 0.15, 0.20}}};

std::uint32_t& at(TileFates& fates, TileFate fate, int x, int y) {
  return fates.count[static_cast<std::size_t>(
      fate)][static_cast<std::size_t>(y) * static_cast<std::size_t>(fates.columns) + static_cast<std::size_t>(x)];
}

/// As a legend has them.
constexpr std::array<std::string_view, tile_fate_count> fate_texts{
    "entered", "hidden", "not hit", "in a block not hit", "outside znear, zfar", "on a line", "culled"};

/// All tiles of a box, those beyond the viewport apart.
template <class F>
void for_each_tile(const TileFates& fates, int x0, int y0, int columns, int rows, F&& f) {
  for (int y = y0; y < std::min(y0 + rows, fates.rows); ++y)
    for (int x = x0; x < std::min(x0 + columns, fates.columns); ++x) f(x, y);
}

/// The fate of every tile of a quad that was left out; those without a pixel centre or behind the eye have no tiles.
TileFate fate_of(QuadReject reject) {
  return reject == QuadReject::depth ? TileFate::depth : reject == QuadReject::line ? TileFate::line : TileFate::culled;
}

/// Of a tile that the walk pushes: coverage leaves its rows out.
bool hides_rows(MaskedDepth& memory, const TileEntry& tile, const DepthInterval& depth, const QuadConstants& quad,
                const Config& config, const DrawState& state) {
  memory.begin(tile.tile_x, tile.tile_y, depth);
  if (memory.hidden()) return true;
  for_each_covered_pixel(
      tile, quad, config, state, [](const CoveredPixel&) {},
      [&](int row, std::uint32_t mask) { return memory.row(row, mask); });
  memory.end();
  return false;
}

}  // namespace

std::uint64_t TileFates::total(TileFate fate) const {
  const auto& counts = count[static_cast<std::size_t>(fate)];
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

TileFates tile_fates(std::span<const SnappedQuad> quads, const Config& config, const DrawState& state) {
  const int edge = config.tile();
  TileFates fates;
  fates.columns = (state.width + edge - 1) / edge;
  fates.rows = (state.height + edge - 1) / edge;
  const std::size_t tiles = static_cast<std::size_t>(fates.columns) * static_cast<std::size_t>(fates.rows);
  for (std::vector<std::uint32_t>& counts : fates.count) counts.assign(tiles, 0);
  std::vector<bool> tested(tiles);
  TileWalk walk(config, state);
  HierarchicalZ memory(config);
  MaskedDepth masked(config);
  HierarchicalZ* const hiding = skips_hidden(config, state) ? &memory : nullptr;
  for (const SnappedQuad& quad : quads) {
    const QuadReject reject = quad_reject(quad, config, state);
    const SetupResult setup = quad_setup(quad, config, state);
    if (reject != QuadReject::none) {
      if (!setup.homogeneous)
        for_each_tile(fates, setup.tile_x0, setup.tile_y0, setup.tiles_x, setup.tiles_y,
                      [&](int x, int y) { ++at(fates, fate_of(reject), x, y); });
      continue;
    }
    std::fill(tested.begin(), tested.end(), false);
    const DepthInterval depth = hiding != nullptr ? depth_interval(quad, config, state) : DepthInterval{};
    for (walk.take(setup, hiding, depth); walk.state() != TileWalk::State::end; walk.advance()) {
      if (walk.state() == TileWalk::State::block && walk.hidden()) {
        const TileBlock block = walk.block();
        for_each_tile(fates, block.tile_x, block.tile_y, block.columns, block.rows, [&](int x, int y) {
          tested[static_cast<std::size_t>(y * fates.columns + x)] = true;
          ++at(fates, TileFate::hidden, x, y);
        });
      }
      if (walk.state() != TileWalk::State::tile) continue;
      const TileEntry tile = walk.entry();
      if (tile.tile_x >= fates.columns || tile.tile_y >= fates.rows) continue;
      tested[static_cast<std::size_t>(tile.tile_y * fates.columns + tile.tile_x)] = true;
      const bool hidden = walk.hit()
                              ? hiding != nullptr && hides_rows(masked, tile, depth, walk.constants(), config, state)
                              : walk.hidden();
      ++at(fates,
           hidden       ? TileFate::hidden
           : walk.hit() ? TileFate::entered
                        : TileFate::tile,
           tile.tile_x, tile.tile_y);
    }
    walk.advance();
    for_each_tile(fates, setup.tile_x0, setup.tile_y0, setup.tiles_x, setup.tiles_y, [&](int x, int y) {
      if (!tested[static_cast<std::size_t>(y * fates.columns + x)]) ++at(fates, TileFate::block, x, y);
    });
  }
  return fates;
}

golden::FrameImage skip_picture(const TileFates& fates, const Config& config, const DrawState& state) {
  golden::FrameImage image(state.width, state.height);
  const std::size_t tiles = fates.count.front().size();
  std::vector<double> quads(tiles);
  for (const auto& counts : fates.count)
    for (std::size_t i = 0; i < tiles; ++i) quads[i] += counts[i];
  const double most = std::max(1.0, *std::max_element(quads.begin(), quads.end()));
  for (std::size_t fate = 0; fate < tile_fate_count; ++fate)
    image.layer["skip." + std::string(tile_fate_names[fate])].assign(image.pixels(), 0);
  for (int y = 0; y < state.height; ++y) {
    for (int x = 0; x < state.width; ++x) {
      const std::size_t pixel = image.index(x, y);
      const auto tile = static_cast<std::size_t>(y / config.tile() * fates.columns + x / config.tile());
      std::array<double, 3> colour{};
      for (std::size_t fate = 0; fate < tile_fate_count; ++fate) {
        const double count = fates.count[fate][tile];
        image.layer["skip." + std::string(tile_fate_names[fate])][pixel] = static_cast<float>(count);
        for (std::size_t c = 0; c < 3; ++c) colour[c] += count * colours[fate][c];
      }
      image.a[pixel] = 1;
      if (quads[tile] == 0) continue;
      const double shade = (0.3 + 0.7 * std::sqrt(quads[tile] / most)) / quads[tile];
      image.r[pixel] = static_cast<float>(shade * colour[0]);
      image.g[pixel] = static_cast<float>(shade * colour[1]);
      image.b[pixel] = static_cast<float>(shade * colour[2]);
    }
  }
  return image;
}

golden::Image8 skip_sheet(const TileFates& fates, const Config& config, const DrawState& state,
                          const std::string& title) {
  compare::Sheet sheet;
  sheet.title = title;
  sheet.subtitle = "Tiles by what became of them, over all quads whose box they are in";
  compare::SheetRow row;
  const auto add = [&](const std::string& name, const TileFates& shown) {
    sheet.columns.push_back(name);
    row.cells.push_back(compare::SheetCell{frame_picture(skip_picture(shown, config, state)), {}});
  };
  add("all", fates);
  for (std::size_t fate = 0; fate < tile_fate_count; ++fate) {
    const std::string text(fate_texts[fate]);
    const std::uint64_t total = fates.total(static_cast<TileFate>(fate));
    compare::SheetKey key{{}, text + ": " + std::to_string(total)};
    for (std::size_t c = 0; c < 3; ++c) key.colour[c] = static_cast<std::uint8_t>(std::lround(255 * colours[fate][c]));
    sheet.keys.push_back(std::move(key));
    if (total == 0) continue;
    TileFates alone = fates;
    for (std::size_t other = 0; other < tile_fate_count; ++other)
      if (other != fate) std::fill(alone.count[other].begin(), alone.count[other].end(), 0);
    add(text, alone);
  }
  sheet.rows.push_back(std::move(row));
  return compare::draw_sheet(sheet, std::clamp(state.width, 192, 384));
}

}  // namespace quadrille::tb
