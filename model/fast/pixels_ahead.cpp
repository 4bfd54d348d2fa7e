#include "model/fast/pixels_ahead.hpp"

#include <bit>

namespace quadrille {

std::uint8_t kind_of(const PixelTrace& p) {
  const bool corner = p.two_corner || p.on_vertex;
  return static_cast<std::uint8_t>((p.drawn ? pixel_drawn : 0) | (p.plane ? pixel_plane : 0) |
                                   (p.plane && !corner && !p.two_edge ? pixel_areas : 0) | (corner ? pixel_corner : 0) |
                                   (p.hull ? pixel_hull : 0));
}

PixelsAhead::PixelsAhead(const PipelineContext& context)
    : context_(context), lanes_(context), results_(context.state.attributes), of_tile_(context.state.attributes) {}

void PixelsAhead::set_state() {
  lanes_ = Lanes(context_);
  results_ = LaneResults(context_.state.attributes);
  of_tile_ = LaneResults(context_.state.attributes);
}

void PixelsAhead::take(const SetupResult& setup, PixelQuad& quad) const {
  quad.setup = setup;
  lanes_.take(setup, quad.data, quad.lanes);
}

void PixelsAhead::begin() {
  rows_.clear();
  pixels_ = 0;
}

void PixelsAhead::add(const TileEntry& tile, const StampEntry& stamp) {
  rows_.push_back({&tile, &stamp});
  pixels_ += std::popcount(stamp.mask);
}

void PixelsAhead::compute(const PixelQuad& quad) {
  next_ = 0;
  kind_.clear();
  list_.count = 0;
  if (lanes_.by_tile(quad.lanes))
    compute_by_tile(quad);
  else
    compute_lanes(quad);
  batch_ = results_.fragments.view(quad.data.id, kind_.size());
}

void PixelsAhead::list_row(const Row& row, const PixelBounds& bounds) {
  const StampEntry& stamp = *row.stamp;
  const int log2 = context_.config.tile_log2;
  const int x = (row.tile->tile_x << log2) - bounds.x0, y = (row.tile->tile_y << log2) + stamp.row - bounds.y0;
  for (std::uint32_t mask = stamp.mask; mask != 0; mask &= mask - 1) {
    const int dx = std::countr_zero(mask);
    list_.add(x + dx, y, (stamp.front >> dx & 1) != 0, (stamp.tie >> dx & 1) != 0);
  }
}

void PixelsAhead::compute_lanes(const PixelQuad& quad) {
  for (const Row& row : rows_) list_row(row, quad.lanes.bounds());
  lanes_.draw(quad.lanes, list_, list_.count, results_);
  if (results_.any_small) lanes_.draw_small(quad.setup, quad.data, list_, list_.count, results_);
  take_kinds(results_, 0, quad);
}

void PixelsAhead::compute_by_tile(const PixelQuad& quad) {
  WideQuad at_tile = quad.lanes.wide;
  for (std::size_t begin = 0, end = 0; begin < rows_.size(); begin = end) {
    lanes_.wide().move_to(*rows_[begin].tile, at_tile);
    list_.count = 0;
    for (; end < rows_.size() && rows_[end].tile == rows_[begin].tile; ++end) list_row(rows_[end], at_tile);
    lanes_.wide().draw(at_tile, list_, list_.count, of_tile_);
    const std::size_t from = kind_.size();
    for (std::size_t i = 0; i < static_cast<std::size_t>(list_.count); ++i)
      results_.fragments.copy(of_tile_.fragments, i, from + i);
    take_kinds(of_tile_, begin, quad);
  }
}

void PixelsAhead::take_kinds(const LaneResults& results, std::size_t first_row, const PixelQuad& quad) {
  const auto kind =
      static_cast<std::uint8_t>((quad.data.plane ? pixel_plane | pixel_areas : 0) | (quad.data.hull ? pixel_hull : 0));
  const std::size_t from = kind_.size();
  const auto count = static_cast<std::size_t>(list_.count);
  kind_.resize(from + count, kind | pixel_drawn);
  if (!results.all_drawn)
    for (std::size_t i = 0; i < count; ++i)
      if (!LaneResults::has(results.drawn, i)) kind_[from + i] = kind;
  if (!results.any_plain) return;
  std::size_t i = 0;
  for (std::size_t n = first_row; i < count; ++n)
    for (std::uint32_t mask = rows_[n].stamp->mask; mask != 0; mask &= mask - 1, ++i)
      if (LaneResults::has(results.plain, i)) plain(rows_[n], std::countr_zero(mask), quad, from + i);
}

void PixelsAhead::plain(const Row& row, int dx, const PixelQuad& quad, std::size_t place) {
  PixelTrace p;
  p.front = (row.stamp->front >> dx & 1) != 0;
  p.tie = (row.stamp->tie >> dx & 1) != 0;
  pixel_pipeline(p, *row.tile, quad.constants, quad.data, dx, row.stamp->row, context_);
  kind_[place] = kind_of(p);
  results_.fragments.put(place, p.fragment);
}

}  // namespace quadrille
