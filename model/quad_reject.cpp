#include "model/quad_reject.hpp"

#include "model/quad_setup.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>

namespace quadrille {
namespace {

/// Of code 2^-depth_bits, truncated to S bits; the code is not 0.
std::int64_t rank_of_code(std::uint32_t code, const Config& config) {
  const int top = std::bit_width(code) - 1, shift = top - (config.significand_bits - 1);
  const std::uint64_t sig = shift >= 0 ? std::uint64_t{code} >> shift : std::uint64_t{code} << -shift;
  return depth_rank(top - config.depth_bits, sig, config);
}

}  // namespace

DepthReject::DepthReject(const Config& config, const DrawState& state)
    : config_(config), possible_(state.depth && depth_margin_holds(config)) {
  // Where a limit was truncated one step more.
  const int steps = depth_margin_steps(config);
  const std::uint32_t znear = depth_code(state.znear, config), zfar = depth_code(state.zfar, config);
  if (znear != 0) near_ = rank_of_code(znear, config) - steps;
  far_ = rank_of_code(zfar + 1, config) + 1 + steps;
  some_ = rank_of_code(1, config) + steps;
}

bool DepthReject::operator()(const SnappedQuad& quad) const {
  if (!possible_) return false;
  bool below = true, beyond = true, some = true, all_negative = true, none_negative = true;
  for (const SnappedVertex& v : quad.vertex) {
    if (v.w <= 0) return false;
    const auto w = static_cast<std::uint32_t>(v.w);  // between two powers of two
    const int floor_w = std::bit_width(w) - 1 - config_.frac(), ceil_w = floor_w + ((w & (w - 1)) == 0 ? 0 : 1);
    const bool zero = v.z.sig == 0;
    const std::int64_t least = depth_rank(v.z.exp - ceil_w, v.z.sig, config_),
                       greatest = depth_rank(v.z.exp - floor_w, v.z.sig, config_);
    below &= near_ && (zero || greatest <= *near_);
    beyond &= !zero && least >= far_;
    some &= !zero && least >= some_;
    all_negative &= v.z.neg;
    none_negative &= !v.z.neg;
  }
  return below || (none_negative && beyond) || (all_negative && some);
}

QuadReject reject_by_vertices(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  if ((state.skip & skip_quads) == 0) return QuadReject::none;
  if (bounding_tiles(quad, config, state).columns == 0) return QuadReject::empty;
  if (std::ranges::all_of(quad.vertex, [](const SnappedVertex& v) { return v.w <= 0; })) return QuadReject::behind;
  return DepthReject(config, state)(quad) ? QuadReject::depth : QuadReject::none;
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
