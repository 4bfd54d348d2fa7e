// Corner quads: small directed draws, each of which reaches a case that random quads meet by luck or not at all. Where
// the stress families are wide (stress.hpp), a group here is exact: its condition holds in the machine's integers.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::golden {

enum class CornerGroup {
  face_plane,
  flat,
  den_w_zero,
  negative_r2,
  z_limits,
  minus_zero,
  two_corner,
  two_edge,
  tall,
  burst,
  extreme,
  far_corner,
  constant_depth,
  one_corner,
  far_base,
  ties,
  saturation,
  box,
  plane,
  coarse_depth,
  far_depth,
};

struct CornerGroupInfo {
  CornerGroup group;
  std::string_view name;
  std::string_view holds;  ///< what occurs in it
  std::string_view needs;  ///< of configuration and draw state, so that it does; empty: nothing
};

/// All groups in the order of the enumeration.
std::span<const CornerGroupInfo> corner_groups();
/// Throws std::invalid_argument listing the groups for an unknown name.
CornerGroup parse_corner_group(std::string_view name);

/// The quads of a group, ids 0, 1, 2 …, with `attributes` attributes per vertex. They lie in the upper left 32 pixels
/// of the viewport (`box` 40), on its whole height (`tall`), at its end (`far_corner`) or reach beyond it
/// (`far_depth`); z_limits, constant_depth and far_depth take znear and zfar from the state. Snapping them with this
/// configuration is exact in x, y and w. The same arguments give the same bits everywhere.
std::vector<WindowQuad> make_corner(CornerGroup group, const Config& config, const DrawState& state, std::uint64_t seed,
                                    int attributes);

/// A group in the state that it needs, ready for the machine. Some quads of `saturation` and `den_w_zero` are then
/// changed to what the port may be given but no vertices give.
struct CornerDraw {
  std::string_view group;
  DrawState state;
  double stall = 0;  ///< of the output; see LockstepOptions
  std::vector<SnappedQuad> quads;
};

/// Every group, small viewports. Between them the draws use every attribute count from 1 to the slots.
std::vector<CornerDraw> corner_draws(const Config& config, std::uint64_t seed);

}  // namespace quadrille::golden
