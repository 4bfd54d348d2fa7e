#include "model/quad_reject.hpp"

#include "model/quad_setup.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>

namespace quadrille {
namespace {

/// The number's place among all positive numbers of S bits, next ones apart by 1: exp 2^(S-1) + (sig - 2^(S-1)).
std::int64_t rank(std::int64_t exp, std::uint64_t sig, const Config& config) {
  const std::int64_t binade = std::int64_t{1} << (config.significand_bits - 1);
  return exp * binade + static_cast<std::int64_t>(sig) - binade;
}

/// Of code 2^-depth_bits, truncated to S bits; the code is not 0.
std::int64_t rank_of_code(std::uint32_t code, const Config& config) {
  const int top = std::bit_width(code) - 1, shift = top - (config.significand_bits - 1);
  const std::uint64_t sig = shift >= 0 ? std::uint64_t{code} >> shift : std::uint64_t{code} << -shift;
  return rank(top - config.depth_bits, sig, config);
}

/// The ranks of |Z / W| from which, or up to which, every code that can come of it is outside.
struct DepthLimits {
  std::optional<std::int64_t> near;  ///< up to this, and zero, below znear
  std::int64_t far;                  ///< from this beyond zfar
  std::int64_t some;                 ///< from this the code is not 0: outside when negative

  DepthLimits(const Config& config, const DrawState& state) {
    // A step is more than u/2; one step more than the margin for what products of losses add, and where a limit was
    // truncated one for that.
    const int steps = 2 * depth_margin(config) + 1;
    const std::uint32_t znear = depth_code(state.znear, config), zfar = depth_code(state.zfar, config);
    if (znear != 0) near = rank_of_code(znear, config) - steps;
    far = rank_of_code(zfar + 1, config) + 1 + steps;
    some = rank_of_code(1, config) + steps;
  }
};

bool outside_depth(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  if (!state.depth || !rejects_by_depth(config)) return false;
  const DepthLimits limits(config, state);
  bool below = true, beyond = true, some = true, all_negative = true, none_negative = true;
  for (const SnappedVertex& v : quad.vertex) {
    if (v.w <= 0) return false;
    const auto w = static_cast<std::uint32_t>(v.w);  // between two powers of two
    const int floor_w = std::bit_width(w) - 1 - config.frac(), ceil_w = floor_w + (std::has_single_bit(w) ? 0 : 1);
    const bool zero = v.z.sig == 0;
    const std::int64_t least = rank(v.z.exp - ceil_w, v.z.sig, config),
                       greatest = rank(v.z.exp - floor_w, v.z.sig, config);
    below &= limits.near && (zero || greatest <= *limits.near);
    beyond &= !zero && least >= limits.far;
    some &= !zero && least >= limits.some;
    all_negative &= v.z.neg;
    none_negative &= !v.z.neg;
  }
  return below || (none_negative && beyond) || (all_negative && some);
}

}  // namespace

int depth_margin(const Config& config) {
  constexpr std::array<int, 3> with_guard_bits{6, 4, 3};  // 2 + 3·2^-G, rounded up with room for products of losses
  return with_guard_bits[static_cast<std::size_t>(std::min(config.align_guard_bits, 2))];
}

bool rejects_by_depth(const Config& config) {
  Config automatic = config;
  automatic.recip_segments_log2 = -1;
  return config.recip_segments() >= automatic.recip_segments();
}

QuadReject reject_by_vertices(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  if ((state.skip & skip_quads) == 0) return QuadReject::none;
  if (bounding_tiles(quad, config, state).columns == 0) return QuadReject::empty;
  if (std::ranges::all_of(quad.vertex, [](const SnappedVertex& v) { return v.w <= 0; })) return QuadReject::behind;
  return outside_depth(quad, config, state) ? QuadReject::depth : QuadReject::none;
}

QuadReject reject_by_areas(const SetupResult& setup, const DrawState& state) {
  if ((state.skip & skip_quads) == 0) return QuadReject::none;
  if (setup.clauses == 0) return QuadReject::line;
  constexpr unsigned back_clauses = 0b0011, front_clauses = 0b1100;
  unsigned wanted = setup.clauses;
  if (state.cull == Cull::back) wanted &= front_clauses;
  if (state.cull == Cull::front) wanted &= back_clauses;
  return wanted == 0 ? QuadReject::culled : QuadReject::none;
}

QuadReject quad_reject(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  const QuadReject reject = reject_by_vertices(quad, config, state);
  return reject != QuadReject::none ? reject : reject_by_areas(quad_setup(quad, config, state), state);
}

}  // namespace quadrille
