#include "model/fast/lanes.hpp"

namespace quadrille {

Lanes::Lanes(const PipelineContext& context)
    : context_(&context), floats_(context), wide_(context), small_results_(context.state.attributes) {}

void Lanes::take(const SetupResult& setup, const QuadData& data, LanesQuad& out) const {
  const QuadLanes values(data, *context_);
  out.by_floats = floats_.take(setup, data, values, out.floats);
  if (!out.by_floats) wide_.take(setup, data, values, out.wide);
}

void Lanes::draw(const LanesQuad& quad, const PixelList& list, int count, LaneResults& out) const {
  if (quad.by_floats)
    floats_.draw(quad.floats, list, count, out);
  else
    wide_.draw(quad.wide, list, count, out);
}

int Lanes::draw_small(const SetupResult& setup, const QuadData& data, const PixelList& list, int count,
                      LaneResults& results) {
  const auto each = [&](auto&& use) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      if (LaneResults::has(results.small, i)) use(i);
  };
  small_list_.count = 0;
  each([&](std::size_t i) {
    const auto to = static_cast<std::size_t>(small_list_.count++);
    small_list_.place[to] = list.place[i];
    small_list_.marks[to] = list.marks[i];
  });
  wide_.take(setup, data, QuadLanes(data, *context_), small_quad_);
  wide_.draw(small_quad_, small_list_, small_list_.count, small_results_);
  std::size_t from = 0;
  each([&](std::size_t i) {
    results.fragments.copy(small_results_.fragments, from, i);
    LaneResults::put(results.drawn, i, LaneResults::has(small_results_.drawn, from++));
  });
  results.all_drawn &= small_results_.all_drawn;
  results.on_edge += small_results_.on_edge;
  results.notch += small_results_.notch;
  results.saturated += small_results_.saturated;
  return small_list_.count;
}

}  // namespace quadrille
