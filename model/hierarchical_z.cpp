#include "model/hierarchical_z.hpp"

#include "model/depth_rank.hpp"
#include "model/snap.hpp"
#include "model/stages.hpp"

#include <algorithm>
#include <limits>

namespace quadrille {
namespace {

/// floor(v 2^H) of the number with this rank, v < 1.
std::uint32_t floor_code(std::int64_t rank, const Config& config) {
  const std::int64_t binade = std::int64_t{1} << (config.significand_bits - 1);
  const auto sig = static_cast<std::uint64_t>(binade + (rank & (binade - 1)));
  const std::int64_t exp = rank >> (config.significand_bits - 1);  // below 0
  // sig 2^(exp - (S-1) + H)
  const std::int64_t right = config.significand_bits - 1 - config.hierarchical_z_bits - exp;
  if (right >= 64) return 0;
  return static_cast<std::uint32_t>(right >= 0 ? sig >> right : sig << -right);
}

}  // namespace

bool skips_hidden(const Config& config, const DrawState& state) {
  return config.hierarchical_z_bits != 0 && state.depth && (state.skip & skip_hidden) != 0;
}

DepthInterval depth_interval(const SnappedQuad& quad, const Config& config, const DrawState& state) {
  const std::uint32_t unknown = (1u << config.hierarchical_z_bits) - 1;
  DepthInterval depth;
  depth.far = unknown;
  if (!depth_margin_holds(config) || !is_ordinary(quad, config)) return depth;

  // W is 1: Z is the depth itself, but for the margin.
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), greatest = std::numeric_limits<std::int64_t>::min();
  bool some_negative = false, some_zero = false, all_zero = true;
  for (const SnappedVertex& v : quad.vertex) {
    some_negative |= v.z.neg;
    if (v.z.sig == 0) {
      some_zero = true;
      continue;
    }
    all_zero = false;
    const std::int64_t rank = depth_rank(v.z.exp, v.z.sig, config);
    least = std::min(least, rank);
    greatest = std::max(greatest, rank);
  }
  const int steps = depth_margin_steps(config);
  if (!some_zero && !some_negative) {
    // 1 and beyond count as the code before all ones, which hides whatever an entry says.
    depth.near = least - steps >= 0 ? unknown - 1 : std::min(floor_code(least - steps, config), unknown - 1);
  }
  if (some_negative) return depth;
  if (all_zero)
    depth.far = 1;
  else if (greatest + steps < 0)
    depth.far = std::min(floor_code(greatest + steps, config) + 1, unknown);

  const int drop = config.depth_bits - config.hierarchical_z_bits;
  const std::uint32_t znear = depth_code(state.znear, config), zfar = depth_code(state.zfar, config);
  depth.lowers = config.quadratic_frac() >= 2 * config.subpixel_bits && depth.far != unknown &&
                 (znear == 0 || depth.near > znear >> drop) && depth.far <= zfar >> drop;
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
