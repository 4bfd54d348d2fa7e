#include "model/untimed.hpp"

#include "model/covered_pixels.hpp"
#include "model/pixel_lanes.hpp"
#include "model/quad_reject.hpp"
#include "model/quad_setup.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace quadrille {

DrawStats& DrawStats::operator+=(const DrawStats& o) {
  quads += o.quads;
  for (std::size_t i = 0; i < rejected.size(); ++i) rejected[i] += o.rejected[i];
  homogeneous_quads += o.homogeneous_quads;
  hull_quads += o.hull_quads;
  blocks_tested += o.blocks_tested;
  tiles_tested += o.tiles_tested;
  tiles_entered += o.tiles_entered;
  tiles_hidden += o.tiles_hidden;
  stamps_covered += o.stamps_covered;
  pixels += o.pixels;
  fragments += o.fragments;
  on_edge += o.on_edge;
  on_vertex += o.on_vertex;
  two_corner += o.two_corner;
  two_edge += o.two_edge;
  tie += o.tie;
  notch += o.notch;
  saturated += o.saturated;
  return *this;
}

struct UntimedModel::Impl {
  PipelineContext context;
  LaneTables tables;
  bool plain;
  TileWalk walk;
  HierarchicalZ memory;
  DrawStats stats;
  std::vector<Fragment> batch;

  // Covered pixels of the current tile, in order.
  int pixels = 0;
  std::array<CoveredPixel, 256> pixel{};

  Impl(const Config& config, const DrawState& state, PixelEngine engine)
      : context(config, state),
        tables(context),
        plain(engine == PixelEngine::plain),
        walk(config, state),
        memory(config) {}

  void deliver(const Fragment& fragment, bool drawn) {
    ++stats.pixels;
    stats.fragments += drawn;
    const unsigned flags = fragment.flags;
    stats.on_edge += (flags & flag_on_edge) != 0;
    stats.on_vertex += (flags & flag_on_vertex) != 0;
    stats.two_corner += (flags & flag_two_corner) != 0;
    stats.two_edge += (flags & flag_two_edge) != 0;
    stats.tie += (flags & flag_tie) != 0;
    stats.notch += (flags & flag_notch) != 0;
    stats.saturated += (flags & flag_saturated) != 0;
    if (drawn) batch.push_back(fragment);
  }

  void draw_plain(const TileEntry& tile, const QuadData& data, int i) {
    const CoveredPixel& at = pixel[static_cast<std::size_t>(i)];
    PixelTrace p;
    p.front = at.front;
    p.tie = at.tie;
    pixel_pipeline(p, tile, walk.constants(), data, at.dx, at.row, context);
    deliver(p.fragment, p.drawn);
  }

  void draw_lanes(const TileEntry& tile, const QuadData& data, const QuadLanes& values, int begin) {
    const int count = std::min(lane_count, pixels - begin);
    int lane_dx[lane_count], lane_row[lane_count];
    for (int l = 0; l < lane_count; ++l) {
      const CoveredPixel& at = pixel[static_cast<std::size_t>(begin + std::min(l, count - 1))];
      lane_dx[l] = at.dx;
      lane_row[l] = at.row;
    }
    LaneResult r;
    pixel_lanes(tile, walk.constants(), data, values, context, tables, lane_dx, lane_row, r);
    for (int l = 0; l < count; ++l) {
      const int i = begin + l;
      if (r.singular >> l & 1) {
        draw_plain(tile, data, i);
        continue;
      }
      const CoveredPixel& at = pixel[static_cast<std::size_t>(i)];
      const auto bit = [&](unsigned mask, int flag) { return (mask >> l & 1) != 0 ? flag : 0; };
      Fragment g;
      g.quad = data.id;
      g.x = static_cast<std::uint16_t>((tile.tile_x << context.config.tile_log2) + lane_dx[l]);
      g.y = static_cast<std::uint16_t>((tile.tile_y << context.config.tile_log2) + lane_row[l]);
      g.front = at.front;
      g.flags = static_cast<std::uint8_t>(bit(r.on_edge, flag_on_edge) | bit(r.notch, flag_notch) |
                                          bit(r.saturated, flag_saturated) | (at.tie ? flag_tie : 0) |
                                          (data.homogeneous ? flag_homogeneous : 0));
      g.depth = r.depth[static_cast<std::size_t>(l)];
      for (std::size_t j = 0; j < static_cast<std::size_t>(context.state.attributes); ++j)
        g.attribute[j] = r.attribute[j][static_cast<std::size_t>(l)];
      deliver(g, r.drawn >> l & 1);
    }
  }

  void draw_tile(const TileEntry& tile, const QuadData& data, const QuadLanes& values) {
    ++stats.tiles_entered;
    pixels = 0;
    stats.stamps_covered += static_cast<std::uint64_t>(
        for_each_covered_pixel(tile, walk.constants(), context.config, context.state,
                               [&](const CoveredPixel& at) { pixel[static_cast<std::size_t>(pixels++)] = at; }));
    if (plain) {
      for (int i = 0; i < pixels; ++i) draw_plain(tile, data, i);
    } else {
      for (int i = 0; i < pixels; i += lane_count) draw_lanes(tile, data, values, i);
    }
  }
};

UntimedModel::UntimedModel(const Config& config, const DrawState& state, PixelEngine engine) {
  config.validate();
  impl_ = std::make_unique<Impl>(config, state, engine);
}
UntimedModel::~UntimedModel() = default;
UntimedModel::UntimedModel(UntimedModel&&) noexcept = default;
UntimedModel& UntimedModel::operator=(UntimedModel&&) noexcept = default;

const DrawStats& UntimedModel::stats() const { return impl_->stats; }

void UntimedModel::set_state(const DrawState& state) {
  const Config config = impl_->context.config;
  impl_->context = PipelineContext(config, state);
  impl_->tables = LaneTables(impl_->context);
  impl_->walk = TileWalk(config, state);
}

void UntimedModel::clear_hidden() { impl_->memory.clear(); }

void UntimedModel::draw(const SnappedQuad& quad, const std::function<void(std::span<const Fragment>)>& sink) {
  Impl& m = *impl_;
  ++m.stats.quads;
  QuadReject reject = reject_by_vertices(quad, m.context.config, m.context.state);
  SetupResult setup;
  if (reject == QuadReject::none) {
    setup = quad_setup(quad, m.context.config, m.context.state);
    reject = reject_by_areas(setup, m.context.state);
  }
  ++m.stats.rejected[static_cast<std::size_t>(reject)];
  if (reject != QuadReject::none) return;
  const QuadData data = quad_data(quad, setup, m.context.config, m.context.state);
  const QuadLanes values(data, m.context);
  m.stats.homogeneous_quads += setup.homogeneous;
  m.stats.hull_quads += setup.hull;
  const bool hidden = skips_hidden(m.context.config, m.context.state);
  const WalkCounts counts = walk_tiles(
      m.walk, setup,
      [&](const TileEntry& tile) {
        m.draw_tile(tile, data, values);
        if (!m.batch.empty()) sink(m.batch);
        m.batch.clear();
      },
      hidden ? &m.memory : nullptr, hidden ? depth_interval(quad, m.context.config, m.context.state) : DepthInterval{});
  m.stats.tiles_hidden += counts.tiles_hidden;
  m.stats.blocks_tested += counts.blocks_tested;
  m.stats.tiles_tested += counts.tiles_tested;
}

}  // namespace quadrille
