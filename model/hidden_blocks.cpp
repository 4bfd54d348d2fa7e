#include "model/hidden_blocks.hpp"

#include <algorithm>

namespace quadrille {
namespace {

constexpr int edge_log2 = 3;
constexpr int edge_tiles = Config::block_tiles;
static_assert(edge_tiles == 1 << edge_log2);

std::uint32_t name(int block_x, int block_y) {
  return static_cast<std::uint32_t>(block_y) << 16 | static_cast<std::uint32_t>(block_x);
}

}  // namespace

// Four columns and four rows of blocks at least: what the walk has in hand at once lies no farther apart.
HiddenBlocks::HiddenBlocks(const Config& config)
    : column_bits_(std::max((config.hierarchical_z_tiles_log2 + 1) / 2 - edge_log2, 2)),
      row_bits_(std::max(config.hierarchical_z_tiles_log2 / 2 - edge_log2, 2)),
      unknown_((1u << config.hierarchical_z_bits) - 1) {
  if (config.hierarchical_z_bits != 0) entries_.resize(std::size_t{1} << (column_bits_ + row_bits_));
}

void HiddenBlocks::clear() { std::ranges::fill(entries_, Entry{}); }

std::size_t HiddenBlocks::place(int block_x, int block_y) const {
  const int column = block_x & ((1 << column_bits_) - 1), row = block_y & ((1 << row_bits_) - 1);
  return static_cast<std::size_t>(row << column_bits_ | column);
}

bool HiddenBlocks::hidden(int tile_x, int tile_y, int columns, int rows, std::uint32_t near) const {
  for (int y = tile_y >> edge_log2; y <= (tile_y + rows - 1) >> edge_log2; ++y)
    for (int x = tile_x >> edge_log2; x <= (tile_x + columns - 1) >> edge_log2; ++x) {
      const Entry& entry = entries_[place(x, y)];
      if (entry.block != name(x, y) || near < entry.far) return false;
    }
  return true;
}

void HiddenBlocks::learn(int tile_x, int tile_y, std::uint32_t far) {
  const int x = tile_x >> edge_log2, y = tile_y >> edge_log2;
  Entry& entry = entries_[place(x, y)];
  const bool known = entry.block == name(x, y);
  if (far >= (known ? entry.far : unknown_)) return;
  if (!known) entry = {name(x, y), unknown_, 0, 0};
  if (entry.mask == 0) entry.masked_far = 0;
  entry.masked_far = std::max(entry.masked_far, far);
  entry.mask |= std::uint64_t{1} << ((tile_y & (edge_tiles - 1)) * edge_tiles + (tile_x & (edge_tiles - 1)));
  if (entry.mask == ~std::uint64_t{0}) {
    entry.far = entry.masked_far;
    entry.mask = 0;
  }
}

}  // namespace quadrille
