#include "model/skips/hierarchical_z.hpp"

#include "model/port/depth_limits.hpp"
#include "model/port/snap.hpp"
#include "model/port/stages.hpp"

#include <algorithm>

namespace quadrille {
bool skips_hidden(const Config& config, const DrawState& state) {
  return config.hierarchical_z_bits != 0 && state.depth && (state.skip & skip_hidden) != 0;
}

DepthInterval depth_interval(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  const std::uint32_t unknown = (std::uint32_t{1} << config.hierarchical_z_bits) - 1;
  const int drop = config.depth_bits - config.hierarchical_z_bits;
  // Unsigned: without hidden tiles a code of 30 bits beyond 1, rounded up, needs all 32 bits.
  const auto low = static_cast<std::uint32_t>(std::max(quad.base.depth_low, 0)),
             high = static_cast<std::uint32_t>(std::max(quad.base.depth_high, 0));
  const std::uint32_t round_up = (std::uint32_t{1} << drop) - 1;
  DepthInterval depth;
  // 1 and beyond count as the code before all ones, which hides whatever an entry says.
  depth.near = std::min(low >> drop, unknown - 1);
  depth.far = std::min((high + round_up) >> drop, unknown);
  depth.lowers = is_ordinary(quad, config) && config.quadratic_frac() >= 2 * config.subpixel_bits &&
                 depth.far != unknown && DepthLimits(config, state).inside(quad.base);
  return depth;
}

HierarchicalZ::HierarchicalZ(const Config& config) : places_(config), blocks_(config) {
  if (config.hierarchical_z_bits != 0) entries_.resize(places_.count());
}

void HierarchicalZ::clear() {
  std::ranges::fill(entries_, Entry{});
  blocks_.clear();
}

bool HierarchicalZ::hidden(int tile_x, int tile_y, const DepthInterval& depth) const {
  const Entry& entry = entries_[places_.place(tile_x, tile_y)];
  return entry.tile == TilePlaces::name(tile_x, tile_y) && depth.near >= entry.far;
}

bool HierarchicalZ::block_hidden(int tile_x, int tile_y, int columns, int rows, const DepthInterval& depth) const {
  return blocks_.hidden(tile_x, tile_y, columns, rows, depth.near);
}

void HierarchicalZ::tested(int tile_x, int tile_y, bool covered, const DepthInterval& depth) {
  // What a quad teaches is behind its nearest depth: it hides nothing of the quad itself.
  if (hidden(tile_x, tile_y, depth))
    blocks_.learn(tile_x, tile_y, depth.near + 1);
  else if (covered && depth.lowers)
    blocks_.learn(tile_x, tile_y, depth.far);
  Entry& entry = entries_[places_.place(tile_x, tile_y)];
  const bool known = entry.tile == TilePlaces::name(tile_x, tile_y);
  if (covered && depth.lowers && !(known && entry.far <= depth.far))
    entry = {TilePlaces::name(tile_x, tile_y), depth.far};
}

WholeTiles::WholeTiles(const Config& config, const DrawState& state)
    : x0((state.scissor_x0 + config.tile() - 1) >> config.tile_log2),
      y0((state.scissor_y0 + config.tile() - 1) >> config.tile_log2),
      x1(state.scissor_x1 >> config.tile_log2),
      y1(state.scissor_y1 >> config.tile_log2) {}

}  // namespace quadrille
