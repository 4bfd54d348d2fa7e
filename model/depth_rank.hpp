// Ranks of depths: how the limits of a window z are compared without dividing (quad_reject, hierarchical_z).
#pragma once

#include "model/config.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille {

/// The number's place among all positive numbers of S bits, next ones apart by 1: exp 2^(S-1) + (sig - 2^(S-1)).
inline std::int64_t depth_rank(std::int64_t exp, std::uint64_t sig, const Config& config) {
  const std::int64_t binade = std::int64_t{1} << (config.significand_bits - 1);
  return exp * binade + static_cast<std::int64_t>(sig) - binade;
}

/// Relative margin of a depth code against Z_i / W_i of the corners, in units of 2^-(S-1); conservative.
///
/// A pixel's depth is (ΣMZ)(1/ΣMW) with weights M >= 0, so between the corners' but for what the operations lose, all
/// of it relative: a sum of four terms of one sign u (1 + 3·2^-G) at most, u = 2^-(S-1) (fp_sum), once above and once
/// below the line; the reciprocal's table u at most, where it has its automatic number of segments. Terms of unlike
/// signs only come closer to zero. The truncation to a code is monotonic.
inline int depth_margin(const Config& config) {
  constexpr std::array<int, 3> with_guard_bits{6, 4, 3};  // 2 + 3·2^-G, rounded up with room for products of losses
  return with_guard_bits[static_cast<std::size_t>(std::min(config.align_guard_bits, 2))];
}

/// The margin in ranks (quadrille_pkg::DEPTH_MARGIN_STEPS): a step is more than u/2; one step more for what products of
/// losses add.
inline int depth_margin_steps(const Config& config) { return 2 * depth_margin(config) + 1; }

/// Whether the margin holds (quadrille_pkg::DEPTH_MARGIN_HOLDS): of a table of reciprocals with fewer segments than the
/// automatic ones nothing is claimed.
inline bool depth_margin_holds(const Config& config) {
  Config automatic = config;
  automatic.recip_segments_log2 = -1;
  return config.recip_segments() >= automatic.recip_segments();
}

}  // namespace quadrille
