#include "model/skips/masked_depth.hpp"

#include <algorithm>

namespace quadrille {

MaskedDepth::MaskedDepth(const Config& config)
    : places_(config),
      unknown_((1u << config.hierarchical_z_bits) - 1),
      whole_row_((1u << config.tile()) - 1),
      rows_(static_cast<std::size_t>(config.tile())) {
  if (config.hierarchical_z_bits != 0) entries_.resize(places_.count());
}

void MaskedDepth::clear() { std::ranges::fill(entries_, Entry{}); }

void MaskedDepth::begin(int tile_x, int tile_y, const DepthInterval& depth) {
  const std::uint32_t tile = TilePlaces::name(tile_x, tile_y);
  place_ = places_.place(tile_x, tile_y);
  old_ = entries_[place_];
  if (old_.tile != tile) old_ = {tile, unknown_, unknown_, {}};

  hidden_ = depth.near >= old_.far;
  masked_hidden_ = depth.near >= old_.masked_far;
  changed_ = false;

  // What is not before all of the tile's bound has nothing to add. What is nearer than the mask by more than a quarter
  // of what the mask is before the rest begins a new one. Measured: layers_small_random takes 677,112 clocks; 680,476
  // with a half, 692,862 with all of it, as Andersson et al. have it, 681,387 where whatever is nearer begins one,
  // 696,537 where only the first quad does; of the other loads none tells these apart by more than a hundredth.
  const bool useful = depth.lowers && depth.far < old_.far;
  const bool nearer = depth.far < old_.masked_far && 4 * (old_.masked_far - depth.far) > old_.far - old_.masked_far;
  begins_ = useful && (old_.masked_far == unknown_ || nearer);
  joins_ = useful && !begins_;
  next_ = old_;
  if (begins_) next_.masked_far = depth.far;
  if (joins_) next_.masked_far = std::max(old_.masked_far, depth.far);
}

std::uint32_t MaskedDepth::row(int row, std::uint32_t mask) {
  const std::uint32_t old = old_.mask[static_cast<std::size_t>(row)];
  if (begins_ && !changed_ && mask != 0) {
    next_.mask = {};
    changed_ = true;
  }
  if (joins_ && (mask & ~old) != 0) changed_ = true;
  if (begins_ || joins_) {
    std::uint16_t& bits = next_.mask[static_cast<std::size_t>(row)];
    bits = static_cast<std::uint16_t>(joins_ ? bits | mask : mask);
  }
  return hidden_ ? 0 : masked_hidden_ ? mask & ~old : mask;
}

void MaskedDepth::end() {
  if (!changed_) return;
  if (std::all_of(next_.mask.begin(), next_.mask.begin() + static_cast<std::ptrdiff_t>(rows_),
                  [this](std::uint16_t bits) { return bits == whole_row_; })) {
    next_.far = next_.masked_far;
    next_.masked_far = unknown_;
  }
  entries_[place_] = next_;
}

}  // namespace quadrille
