#include "model/fast/pixels_ahead.hpp"

#include <algorithm>
#include <bit>

namespace quadrille {

std::uint8_t kind_of(const PixelTrace& p) {
  const bool corner = p.two_corner || p.on_vertex;
  return static_cast<std::uint8_t>((p.drawn ? pixel_drawn : 0) | (p.plane ? pixel_plane : 0) |
                                   (p.plane && !corner && !p.two_edge ? pixel_areas : 0) | (corner ? pixel_corner : 0) |
                                   (p.hull ? pixel_hull : 0));
}

PixelsAhead::PixelsAhead(const PipelineContext& context)
    : context_(context), tables_(context), floats_(context), results_(context.state.attributes) {}

void PixelsAhead::set_state() {
  floats_ = FloatLanes(context_);
  results_ = FloatResults(context_.state.attributes);
}

void PixelsAhead::take(const SetupResult& setup, PixelQuad& quad) const {
  quad.lanes = QuadLanes(quad.data, context_);
  quad.by_floats = floats_.usable() && floats_.take(setup, quad.data, quad.lanes, quad.floats);
}

void PixelsAhead::begin() {
  rows_.clear();
  pixels_ = 0;
}

void PixelsAhead::add(const TileEntry& tile, const StampEntry& stamp, const PixelQuad& quad) {
  if (quad.by_floats) {
    if (pixels_ == 0) list_.count = 0;
    const int log2 = context_.config.tile_log2;
    const int x = (tile.tile_x << log2) - quad.floats.x0, y = (tile.tile_y << log2) + stamp.row - quad.floats.y0;
    for (std::uint32_t mask = stamp.mask; mask != 0; mask &= mask - 1) {
      const int dx = std::countr_zero(mask);
      list_.add(x + dx, y, (stamp.front >> dx & 1) != 0, (stamp.tie >> dx & 1) != 0);
    }
  }
  rows_.push_back({&tile, &stamp});
  pixels_ += std::popcount(stamp.mask);
}

void PixelsAhead::compute(const PixelQuad& quad) {
  next_ = 0;
  kind_.clear();
  if (quad.by_floats) {
    compute_floats(quad);
  } else {
    for (const Row& row : rows_) compute_row(row, quad);
  }
  batch_ = results_.fragments.view(quad.data.id, kind_.size());
}

void PixelsAhead::compute_floats(const PixelQuad& quad) {
  floats_.draw(quad.floats, list_, list_.count, results_);
  const auto count = static_cast<std::size_t>(list_.count);
  const std::uint8_t kind = quad.floats.areas ? pixel_plane | pixel_areas : 0;
  kind_.resize(count, kind | pixel_drawn);
  if (results_.all_drawn && !results_.any_plain) return;
  for (std::size_t i = 0; i < count; ++i)
    if ((results_.drawn[i / 8] >> i % 8 & 1) == 0) kind_[i] = kind;
  if (!results_.any_plain) return;
  std::size_t i = 0;
  for (const Row& row : rows_)
    for (std::uint32_t mask = row.stamp->mask; mask != 0; mask &= mask - 1, ++i) {
      if ((results_.plain[i / 8] >> i % 8 & 1) == 0) continue;
      const int dx = std::countr_zero(mask);
      plain(row, {dx, row.stamp->row, (row.stamp->front >> dx & 1) != 0, (row.stamp->tie >> dx & 1) != 0}, quad, i);
    }
}

void PixelsAhead::compute_row(const Row& row, const PixelQuad& quad) {
  const StampEntry& s = *row.stamp;
  const auto common =
      static_cast<std::uint8_t>((quad.data.plane ? pixel_plane | pixel_areas : 0) | (quad.data.hull ? pixel_hull : 0));
  std::uint32_t mask = s.mask;
  while (mask != 0) {
    std::array<CoveredPixel, lane_count> at;
    int dx[lane_count], rows[lane_count], count = 0;
    for (; count < lane_count && mask != 0; ++count, mask &= mask - 1) {
      const int column = std::countr_zero(mask);
      at[static_cast<std::size_t>(count)] = {column, s.row, (s.front >> column & 1) != 0, (s.tie >> column & 1) != 0};
    }
    for (int l = 0; l < lane_count; ++l) {
      dx[l] = at[static_cast<std::size_t>(std::min(l, count - 1))].dx;
      rows[l] = s.row;
    }
    LaneResult r;
    pixel_lanes(*row.tile, quad.constants, quad.data, quad.lanes, context_, tables_, dx, rows, r);
    for (int l = 0; l < count; ++l) {
      const CoveredPixel& pixel = at[static_cast<std::size_t>(l)];
      const std::size_t place = kind_.size();
      kind_.push_back(static_cast<std::uint8_t>(common | ((r.drawn >> l & 1) != 0 ? pixel_drawn : 0)));
      if ((r.singular >> l & 1) != 0)
        plain(row, pixel, quad, place);
      else
        results_.fragments.put(place, lane_fragment(r, l, *row.tile, pixel, quad.data, context_));
    }
  }
}

void PixelsAhead::plain(const Row& row, const CoveredPixel& at, const PixelQuad& quad, std::size_t place) {
  PixelTrace p;
  p.front = at.front;
  p.tie = at.tie;
  pixel_pipeline(p, *row.tile, quad.constants, quad.data, at.dx, at.row, context_);
  kind_[place] = kind_of(p);
  results_.fragments.put(place, p.fragment);
}

}  // namespace quadrille
