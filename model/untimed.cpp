#include "model/untimed.hpp"

#include "model/pixel_pipeline.hpp"
#include "model/quad_setup.hpp"
#include "model/stamp_coverage.hpp"

#include <bit>

namespace quadrille {

DrawStats& DrawStats::operator+=(const DrawStats& o) {
  quads += o.quads;
  homogeneous_quads += o.homogeneous_quads;
  hull_quads += o.hull_quads;
  blocks_tested += o.blocks_tested;
  tiles_tested += o.tiles_tested;
  tiles_entered += o.tiles_entered;
  stamps_covered += o.stamps_covered;
  pixels += o.pixels;
  fragments += o.fragments;
  on_edge += o.on_edge;
  on_vertex += o.on_vertex;
  two_corner += o.two_corner;
  two_edge += o.two_edge;
  tie += o.tie;
  cured += o.cured;
  saturated += o.saturated;
  return *this;
}

struct UntimedModel::Impl {
  PipelineContext context;
  TileWalk walk;
  DrawStats stats;
  std::vector<Fragment> batch;

  Impl(const Config& config, const DrawState& state) : context(config, state), walk(config, state) {}

  void count(const PixelTrace& p) {
    ++stats.pixels;
    stats.fragments += p.drawn;
    const unsigned flags = p.fragment.flags;
    stats.on_edge += (flags & flag_on_edge) != 0;
    stats.on_vertex += (flags & flag_on_vertex) != 0;
    stats.two_corner += (flags & flag_two_corner) != 0;
    stats.two_edge += (flags & flag_two_edge) != 0;
    stats.tie += (flags & flag_tie) != 0;
    stats.cured += (flags & flag_cured) != 0;
    stats.saturated += (flags & flag_saturated) != 0;
  }

  void draw_tile(const TileEntry& tile, const QuadData& data) {
    ++stats.tiles_entered;
    for (int row = 0; row < context.config.tile(); ++row) {
      const StampMasks masks = stamp_coverage(tile, walk.constants(), row, context.config, context.state);
      stats.stamps_covered += masks.mask != 0;
      for (std::uint32_t rest = masks.mask; rest != 0; rest &= rest - 1) {
        const int dx = std::countr_zero(rest);
        PixelTrace p;
        p.front = masks.front >> dx & 1;
        p.tie = masks.tie >> dx & 1;
        pixel_pipeline(p, tile, walk.constants(), data, dx, row, context);
        count(p);
        if (p.drawn) batch.push_back(p.fragment);
      }
    }
  }
};

UntimedModel::UntimedModel(const Config& config, const DrawState& state) {
  config.validate();
  impl_ = std::make_unique<Impl>(config, state);
}
UntimedModel::~UntimedModel() = default;
UntimedModel::UntimedModel(UntimedModel&&) noexcept = default;
UntimedModel& UntimedModel::operator=(UntimedModel&&) noexcept = default;

const DrawStats& UntimedModel::stats() const { return impl_->stats; }

void UntimedModel::draw(const SnappedQuad& quad, const std::function<void(std::span<const Fragment>)>& sink) {
  Impl& m = *impl_;
  const SetupResult setup = quad_setup(quad, m.context.config, m.context.state);
  const QuadData data = quad_data(quad, setup, m.context.config, m.context.state);
  ++m.stats.quads;
  m.stats.homogeneous_quads += setup.homogeneous;
  m.stats.hull_quads += setup.hull;
  m.walk.take(setup);
  while (m.walk.state() != TileWalk::State::end) {
    const bool tile = m.walk.state() == TileWalk::State::tile;
    ++(tile ? m.stats.tiles_tested : m.stats.blocks_tested);
    if (tile && m.walk.hit()) {
      m.draw_tile(m.walk.entry(), data);
      if (!m.batch.empty()) sink(m.batch);
      m.batch.clear();
    }
    m.walk.advance();
  }
  m.walk.advance();
}

}  // namespace quadrille
