#include "model/skips/hidden_blocks.hpp"

#include <algorithm>

namespace quadrille {
namespace {

constexpr int edge_log2 = 3;
constexpr int edge_tiles = Config::block_tiles;
static_assert(edge_tiles == 1 << edge_log2);

}  // namespace

// Four columns and four rows of blocks at least: what the walk has in hand at once lies no farther apart.
HiddenBlocks::HiddenBlocks(const Config& config)
    : places_(std::max((config.hierarchical_z_tiles_log2 + 1) / 2 - edge_log2, 2),
              std::max(config.hierarchical_z_tiles_log2 / 2 - edge_log2, 2)),
      unknown_((1u << config.hierarchical_z_bits) - 1) {
  if (config.hierarchical_z_bits != 0) entries_.resize(places_.count());
}

void HiddenBlocks::clear() { std::ranges::fill(entries_, Entry{}); }

bool HiddenBlocks::hidden(int tile_x, int tile_y, int columns, int rows, std::uint32_t near) const {
  for (int y = tile_y >> edge_log2; y <= (tile_y + rows - 1) >> edge_log2; ++y)
    for (int x = tile_x >> edge_log2; x <= (tile_x + columns - 1) >> edge_log2; ++x) {
      const Entry& entry = entries_[places_.place(x, y)];
      if (entry.block != TilePlaces::name(x, y) || near < entry.far) return false;
    }
  return true;
}

void HiddenBlocks::learn(int tile_x, int tile_y, std::uint32_t far) {
  const int x = tile_x >> edge_log2, y = tile_y >> edge_log2;
  Entry& entry = entries_[places_.place(x, y)];
  const bool known = entry.block == TilePlaces::name(x, y);
  if (far >= (known ? entry.far : unknown_)) return;
  if (!known) entry = {TilePlaces::name(x, y), unknown_, 0, 0};
  if (entry.mask == 0) entry.masked_far = 0;
  entry.masked_far = std::max(entry.masked_far, far);
  entry.mask |= std::uint64_t{1} << ((tile_y & (edge_tiles - 1)) * edge_tiles + (tile_x & (edge_tiles - 1)));
  if (entry.mask == ~std::uint64_t{0}) {
    entry.far = entry.masked_far;
    entry.mask = 0;
  }
}

}  // namespace quadrille
