#include "model/front/quad_reject.hpp"

#include "model/front/quad_setup.hpp"
#include "model/port/depth_limits.hpp"

#include <algorithm>

namespace quadrille {
QuadReject reject_by_vertices(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  if ((state.skip & skip_quads) == 0) return QuadReject::none;
  if (bounding_tiles(quad, config, state).columns == 0) return QuadReject::empty;
  if (std::ranges::all_of(quad.vertex, [](const SnappedVertex& v) { return v.w <= 0; })) return QuadReject::behind;
  return DepthLimits(config, state).outside(quad.base) ? QuadReject::depth : QuadReject::none;
}

QuadReject reject_by_areas(const SetupResult& setup, const DrawState& state) {
  constexpr unsigned back_clauses = 0b0011, front_clauses = 0b1100;
  unsigned wanted = setup.clauses;
  if (state.cull == Cull::back) wanted &= front_clauses;
  if (state.cull == Cull::front) wanted &= back_clauses;
  const bool turned = wanted != 0;
  if ((state.skip & skip_quads) != 0 && !turned) return setup.clauses == 0 ? QuadReject::line : QuadReject::culled;
  const unsigned missing = setup.separated * 0b101u;  // the clauses of either sign
  return turned && (wanted & ~missing) == 0 ? QuadReject::outside : QuadReject::none;
}

QuadReject quad_reject(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  const QuadReject reject = reject_by_vertices(quad, config, state);
  return reject != QuadReject::none ? reject : reject_by_areas(quad_setup(quad, config, state), state);
}

}  // namespace quadrille
