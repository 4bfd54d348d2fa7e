#include "model/untimed.hpp"

#include "model/fast/lanes.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_reject.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/tile_context.hpp"
#include "model/port/draw_state.hpp"
#include "model/skips/masked_depth.hpp"

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
  blocks_hidden += o.blocks_hidden;
  tiles_tested += o.tiles_tested;
  tiles_entered += o.tiles_entered;
  tiles_hidden += o.tiles_hidden;
  tiles_masked += o.tiles_masked;
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
  Lanes lanes;
  bool plain;
  TileWalk walk;
  WholeTiles whole;
  HierarchicalZ memory;
  MaskedDepth masked;
  DrawStats stats;
  LanePixels by_lane;
  std::vector<Fragment> records;  ///< of a batch, for those who take records; attributes not in use are 0

  // Covered pixels of the current tile, in order, and their fragments.
  int pixels = 0;
  std::array<CoveredPixel, PixelList::widest> pixel{};
  std::size_t drawn = 0;
  FragmentBuffer batch;

  // Of a quad by lanes.
  LanesQuad lanes_quad;
  NarrowEdges edges;
  SmallQuad small_quad;
  SmallWalk small_walk;
  PixelList list;
  LaneResults results;

  Impl(const Config& config, const DrawState& state, PixelEngine engine)
      : context(config, state),
        lanes(context),
        plain(engine == PixelEngine::plain),
        walk(config, state, FloatLanes::place_signs),
        whole(config, state),
        memory(config),
        masked(config),
        batch(PixelList::widest, state.attributes),
        results(state.attributes) {}

  /// Every flag but tie, which coverage gives.
  void tally(unsigned flags) {
    stats.on_edge += (flags & flag_on_edge) != 0;
    stats.on_vertex += (flags & flag_on_vertex) != 0;
    stats.two_corner += (flags & flag_two_corner) != 0;
    stats.two_edge += (flags & flag_two_edge) != 0;
    stats.notch += (flags & flag_notch) != 0;
    stats.saturated += (flags & flag_saturated) != 0;
  }

  void deliver(const Fragment& fragment, bool draws) {
    ++stats.pixels;
    stats.fragments += draws;
    tally(fragment.flags);
    stats.tie += (fragment.flags & flag_tie) != 0;
    if (draws) batch.put(drawn++, fragment);
  }

  void draw_plain(const TileEntry& tile, const QuadData& data, int i) {
    ++by_lane.plain;
    const CoveredPixel& at = pixel[static_cast<std::size_t>(i)];
    PixelTrace p;
    p.front = at.front;
    p.tie = at.tie;
    pixel_pipeline(p, tile, walk.constants(), data, at.dx, at.row, context);
    deliver(p.fragment, p.drawn);
  }

  using Sink = std::function<void(const FragmentArrays&)>;

  /// Draws the list's whole blocks, with `all` its rest too.
  void draw_list(const SnappedQuad& quad, bool all, const Sink& sink) {
    const int count = all ? list.count : list.count / FloatLanes::block * FloatLanes::block;
    if (count == 0) return;
    auto size = static_cast<std::size_t>(count);
    lanes.draw(lanes_quad, list, count, results);
    drawn_by_lanes() += size;
    if (results.any_plain || results.any_small || !results.all_drawn) size = settle(quad, count);
    stats.on_edge += results.on_edge;
    stats.notch += results.notch;
    stats.saturated += results.saturated;
    stats.fragments += size;
    if (size != 0) sink(results.fragments.view(quad.id, size));
    list.drop(count);
  }

  std::uint64_t& drawn_by_lanes() { return lanes_quad.by_floats ? by_lane.single : by_lane.wide; }

  /// Draws what the lanes left, and closes the gaps of what is not drawn. Returns what is.
  std::size_t settle(const SnappedQuad& quad, int count) {
    SetupResult setup;
    QuadConstants constants;
    QuadData data;
    if (results.any_plain || results.any_small) {
      setup = quad_setup(quad, context.config, context.state);
      constants = QuadConstants(setup);
      data = quad_data(quad, setup, context.config, context.state);
    }
    if (results.any_small) {
      const auto small = static_cast<std::uint64_t>(lanes.draw_small(setup, data, list, count, results));
      by_lane.single -= small;
      by_lane.wide += small;
    }
    std::size_t kept = 0;
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      bool draws = LaneResults::has(results.drawn, at);
      if (LaneResults::has(results.plain, at)) draws = draw_singular(at, setup, constants, data);
      if (draws && at != kept) results.fragments.move(at, kept);
      kept += draws;
    }
    return kept;
  }

  /// Pixel `at` of the list by the plain pipeline; returns whether it is drawn.
  bool draw_singular(std::size_t at, const SetupResult& setup, const QuadConstants& constants, const QuadData& data) {
    const int tile = context.config.tile();
    const PixelBounds& origin = lanes_quad.bounds();
    const int x = origin.x0 + static_cast<int>(list.place[at] & 0xffff),
              y = origin.y0 + static_cast<int>(list.place[at] >> 16);
    TileEntry entry;
    entry.tile_x = x / tile;
    entry.tile_y = y / tile;
    const int dx = (entry.tile_x - setup.tile_x0) * tile, dy = (entry.tile_y - setup.tile_y0) * tile;
    WalkState linear;
    for (std::size_t k = 0; k < linear_count; ++k) linear.linear[k] = setup.linear[k].value;
    walk_step(linear, constants, dx, dy);
    entry.linear = linear.linear;
    entry.quadratic = tile_context(constants, dx, dy, context.config.qdrop());
    PixelTrace p;
    p.front = results.fragments.marks(at).front;
    p.tie = (results.fragments.marks(at).flags & flag_tie) != 0;
    pixel_pipeline(p, entry, constants, data, x % tile, y % tile, context);
    --drawn_by_lanes();
    ++by_lane.plain;
    results.fragments.put(at, p.fragment);
    tally(p.fragment.flags);
    return p.drawn;
  }

  /// The pixels of a tile are in the list.
  void count_tile(const SnappedQuad& quad, const FloatLanes::TileCounts& tile, const Sink& sink) {
    ++stats.tiles_entered;
    stats.stamps_covered += static_cast<std::uint64_t>(tile.stamps);
    stats.pixels += static_cast<std::uint64_t>(tile.pixels);
    stats.tie += static_cast<std::uint64_t>(tile.ties);
    if (list.count > PixelList::capacity - PixelList::widest) draw_list(quad, false, sink);
  }

  /// A quad that FloatLanes::take_small took.
  void draw_small(const SnappedQuad& quad, bool hidden, const Sink& sink) {
    lanes.floats().walk_small(small_quad, small_walk);
    stats.blocks_tested += static_cast<std::uint64_t>(small_walk.blocks_tested);
    list.count = 0;  // a sink that threw left some
    if (hidden) {
      if (small_walk.tiles_tested != 0) draw_small_seen(quad, sink);
    } else {
      stats.tiles_tested += static_cast<std::uint64_t>(small_walk.tiles_tested);
      for (int i = 0; i < small_walk.hits; ++i)
        count_tile(quad,
                   lanes.floats().cover_small(lanes_quad.floats, small_quad,
                                              small_walk.hit[static_cast<std::size_t>(i)], nullptr, list),
                   sink);
    }
    draw_list(quad, true, sink);
  }

  /// Its tiles in the walk's order, without what is hidden: each test of one teaches what is known of tiles.
  void draw_small_seen(const SnappedQuad& quad, const Sink& sink) {
    const DepthInterval depth = depth_interval(quad, context.config, context.state);
    const int x0 = lanes_quad.floats.x0 >> SmallQuad::tile_log2, y0 = lanes_quad.floats.y0 >> SmallQuad::tile_log2;
    if (memory.block_hidden(x0, y0, small_quad.tiles_x, small_quad.tiles_y, depth)) {
      ++stats.blocks_hidden;
      return;
    }
    stats.tiles_tested += static_cast<std::uint64_t>(small_walk.tiles_tested);
    int hits = 0;
    for (int row = 0; row < small_quad.tiles_y; ++row)
      for (int n = 0; n < small_quad.tiles_x; ++n) {
        const int column = row % 2 == 0 ? n : small_quad.tiles_x - 1 - n;
        const SmallWalk::Tile tile{static_cast<std::uint8_t>(column), static_cast<std::uint8_t>(row)};
        const bool hit = hits < small_walk.hits && small_walk.hit[static_cast<std::size_t>(hits)] == tile;
        hits += hit;
        bool covered = false;
        if (hit && memory.hidden(x0 + column, y0 + row, depth)) {
          ++stats.tiles_hidden;  // whether it is covered does not matter: it teaches nothing that is nearer
        } else if (hit) {
          masked.begin(x0 + column, y0 + row, depth);
          const FloatLanes::TileCounts counts =
              lanes.floats().cover_small(lanes_quad.floats, small_quad, tile, &masked, list);
          covered = counts.covered && whole.hold(x0 + column, y0 + row);
          if (masked.hidden())
            ++stats.tiles_masked;
          else
            masked.end();
          count_tile(quad, counts, sink);
        }
        memory.tested(x0 + column, y0 + row, covered, depth);
      }
  }

  /// Calls add(CoveredPixel) for what of the tile is covered and may be seen; returns its stamps. `depth`: of the quad,
  /// or nullptr where nothing is hidden.
  template <class Add>
  int cover_tile(const TileEntry& tile, const DepthInterval* depth, Add&& add) {
    if (depth == nullptr) return for_each_covered_pixel(tile, walk.constants(), context.config, context.state, add);
    masked.begin(tile.tile_x, tile.tile_y, *depth);
    if (masked.hidden()) {
      ++stats.tiles_masked;
      return 0;
    }
    const int stamps = for_each_covered_pixel(tile, walk.constants(), context.config, context.state, add,
                                              [this](int row, std::uint32_t mask) { return masked.row(row, mask); });
    masked.end();
    return stamps;
  }

  /// FloatLanes::cover of the tile under test. `depth`: of the quad, or nullptr where nothing is hidden.
  FloatLanes::TileCounts cover_lanes(const DepthInterval* depth) {
    const TileCorner corner = walk.corner();
    const PixelBounds& bounds = lanes_quad.bounds();
    if (depth == nullptr) return lanes.floats().cover(bounds, corner, walk.constants(), edges, nullptr, list);
    masked.begin(corner.tile_x, corner.tile_y, *depth);
    if (masked.hidden()) {
      ++stats.tiles_masked;
      return {};
    }
    const FloatLanes::TileCounts counts = lanes.floats().cover(bounds, corner, walk.constants(), edges, &masked, list);
    masked.end();
    return counts;
  }

  void draw_tile(const TileEntry& tile, const QuadData& data, const DepthInterval* depth) {
    ++stats.tiles_entered;
    pixels = 0;
    drawn = 0;
    const int stamps =
        cover_tile(tile, depth, [&](const CoveredPixel& at) { pixel[static_cast<std::size_t>(pixels++)] = at; });
    stats.stamps_covered += static_cast<std::uint64_t>(stamps);
    for (int i = 0; i < pixels; ++i) draw_plain(tile, data, i);
  }
};

UntimedModel::UntimedModel(const Config& config, const DrawState& state, PixelEngine engine) {
  config.validate();
  check_draw_state(state, config);
  impl_ = std::make_unique<Impl>(config, state, engine);
}
UntimedModel::~UntimedModel() = default;
UntimedModel::UntimedModel(UntimedModel&&) noexcept = default;
UntimedModel& UntimedModel::operator=(UntimedModel&&) noexcept = default;

const DrawStats& UntimedModel::stats() const { return impl_->stats; }
const LanePixels& UntimedModel::lane_pixels() const { return impl_->by_lane; }

void UntimedModel::set_state(const DrawState& state) {
  const Config config = impl_->context.config;
  check_draw_state(state, config);
  impl_->context = PipelineContext(config, state);
  impl_->lanes = Lanes(impl_->context);
  impl_->records.clear();
  impl_->batch = FragmentBuffer(PixelList::widest, state.attributes);
  impl_->results = LaneResults(state.attributes);
  impl_->walk = TileWalk(config, state, FloatLanes::place_signs);
  impl_->whole = WholeTiles(config, state);
}

void UntimedModel::clear_hidden() {
  impl_->memory.clear();
  impl_->masked.clear();
}

void UntimedModel::draw(const SnappedQuad& quad, const std::function<void(std::span<const Fragment>)>& sink) {
  std::vector<Fragment>& records = impl_->records;
  draw_arrays(quad, [&](const FragmentArrays& fragments) {
    if (records.size() < fragments.size) records.resize(fragments.size);
    fragments.copy_to(records.data());
    sink(std::span(records).first(fragments.size));
  });
}

void UntimedModel::draw_arrays(const SnappedQuad& quad, const std::function<void(const FragmentArrays&)>& sink) {
  Impl& m = *impl_;
  ++m.stats.quads;
  const bool hidden = skips_hidden(m.context.config, m.context.state);
  if (!m.plain && m.lanes.floats().small())
    if (const auto taken = m.lanes.floats().take_small(quad, m.lanes_quad.floats, m.small_quad)) {
      ++m.stats.rejected[static_cast<std::size_t>(*taken)];
      m.lanes_quad.by_floats = true;
      if (*taken == QuadReject::none) m.draw_small(quad, hidden, sink);
      return;
    }
  QuadReject reject = reject_by_vertices(quad, m.context.config, m.context.state);
  SetupResult setup;
  if (reject == QuadReject::none) {
    setup = quad_setup(quad, m.context.config, m.context.state);
    reject = reject_by_areas(setup, m.context.state);
  }
  ++m.stats.rejected[static_cast<std::size_t>(reject)];
  if (reject != QuadReject::none) return;
  const QuadData data = quad_data(quad, setup, m.context.config, m.context.state);
  m.stats.homogeneous_quads += setup.homogeneous;
  m.stats.hull_quads += setup.hull;
  const DepthInterval depth = hidden ? depth_interval(quad, m.context.config, m.context.state) : DepthInterval{};
  const bool by_lanes = !m.plain;
  if (by_lanes) {
    m.lanes.take(setup, data, m.lanes_quad);
    m.edges = m.lanes.floats().edges(setup);
  }
  const bool by_tile = by_lanes && m.lanes.by_tile(m.lanes_quad);
  m.list.count = 0;  // a sink that threw left some
  const WalkCounts counts = walk_quad(
      m.walk, setup,
      [&] {
        if (by_tile) m.lanes.wide().move_to(m.walk.entry(), m.lanes_quad.wide);
        if (by_lanes) {
          m.count_tile(quad, m.cover_lanes(hidden ? &depth : nullptr), sink);
          if (by_tile) m.draw_list(quad, true, sink);
          return;
        }
        m.draw_tile(m.walk.entry(), data, hidden ? &depth : nullptr);
        if (m.drawn != 0) sink(m.batch.view(quad.id, m.drawn));
      },
      hidden ? &m.memory : nullptr, depth);
  if (by_lanes) m.draw_list(quad, true, sink);
  m.stats.blocks_hidden += counts.blocks_hidden;
  m.stats.tiles_hidden += counts.tiles_hidden;
  m.stats.blocks_tested += counts.blocks_tested;
  m.stats.tiles_tested += counts.tiles_tested;
}

}  // namespace quadrille
