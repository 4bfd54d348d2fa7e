#include "model/front/tile_walk.hpp"

#include "model/front/tile_context.hpp"

namespace quadrille {

std::uint64_t plain_place_signs(std::int64_t value, std::int64_t right, std::int64_t down, int rows) {
  std::uint64_t word = 0;
  for (int row = 0; row < rows; ++row) {
    const std::int64_t at = wrap_add(value, down * row);
#pragma GCC unroll 8
    for (int column = 0; column < 8; ++column)
      word |= (static_cast<std::uint64_t>(wrap_add(at, right * column)) >> 63) << (8 * row + column);
  }
  return word;
}

Squares::Squares(const QuadConstants& quad, int extent, Cull cull) : visible_(quad.visible), cull_(cull) {
  for (std::size_t k = 0; k < 5; ++k) {
    const std::int64_t sx = quad.gx[k] * (extent - 1), sy = quad.gy[k] * (extent - 1);
    to_least_[k] = std::min<std::int64_t>(sx, 0) + std::min<std::int64_t>(sy, 0) - (quad.tie_neg[k] ? 1 : 0);
    to_greatest_[k] = -(std::max<std::int64_t>(sx, 0) + std::max<std::int64_t>(sy, 0)) - (quad.tie_pos[k] ? 1 : 0);
    right_[k] = quad.gx[k] * extent;
    down_[k] = quad.gy[k] * extent;
  }
}

/// The signs that each edge function takes somewhere in each square.
template <class PlaceSigns>
void Squares::signs(const WalkState& at, Signs& e, PlaceSigns&& place_signs) const {
  for (std::size_t k = 0; k < 5; ++k) {
    const std::int64_t value = at.linear[k];
    e[k] = {place_signs(wrap_add(to_greatest_[k], -value), -right_[k], -down_[k]),
            place_signs(wrap_add(to_least_[k], value), right_[k], down_[k])};
  }
}

namespace {

std::uint64_t sign_of_one(std::int64_t value, std::int64_t, std::int64_t) { return value < 0 ? ~std::uint64_t{0} : 0; }

}  // namespace

bool Squares::may_cover(const WalkState& at) const {
  Signs e;
  signs(at, e, sign_of_one);
  const PlaceWords<std::uint64_t> inside = inside_expression(e, visible_, cull_);
  return (inside.back | inside.front) != 0;
}

std::uint64_t Squares::may_cover(const WalkState& at, int rows, PlaceSigns place_signs) const {
  Signs e;
  signs(at, e, [&](std::int64_t value, std::int64_t right, std::int64_t down) {
    const std::int64_t across = 7 * right, along = down * (rows - 1);
    if (wrap_add(value, std::max<std::int64_t>(across, 0) + std::max<std::int64_t>(along, 0)) < 0)
      return ~std::uint64_t{0};
    if (wrap_add(value, std::min<std::int64_t>(across, 0) + std::min<std::int64_t>(along, 0)) >= 0)
      return std::uint64_t{0};
    return place_signs(value, right, down, rows);
  });
  const PlaceWords<std::uint64_t> inside = inside_expression(e, visible_, cull_);
  return inside.back | inside.front;
}

bool Squares::covers(const WalkState& at) const {
  Signs e;
  signs(at, e, sign_of_one);
  // An edge has one sign everywhere, or the diagonal both, and then both clauses must hold.
  const auto everywhere = [&](std::size_t k, bool positive) {
    return positive ? e[k].positive != 0 && e[k].negative == 0 : e[k].negative != 0 && e[k].positive == 0;
  };
  const auto face = [&](bool positive) {
    const bool e01 = everywhere(0, positive), e12 = everywhere(1, positive), e23 = everywhere(2, positive),
               e30 = everywhere(3, positive);
    const bool first = e01 && e12 && (e23 || e30), second = e23 && e30 && (e01 || e12);
    const bool on_first = positive ? e[4].positive != 0 : e[4].negative != 0;
    const bool on_second = positive ? e[4].negative != 0 : e[4].positive != 0;
    return (on_first || on_second) && (first || !on_first) && (second || !on_second);
  };
  return (cull_ != Cull::back && face(true)) || (cull_ != Cull::front && face(false));
}

void walk_step(WalkState& at, const QuadConstants& quad, int dx, int dy) {
  for (std::size_t k = 0; k < linear_count; ++k)
    at.linear[k] = wrap_add(at.linear[k], wrap_add(quad.gx[k] * dx, quad.gy[k] * dy));
}

void TileWalk::take(const SetupResult& setup, HierarchicalZ* memory, const DepthInterval& depth) {
  memory_ = memory;
  depth_ = depth;
  slot_ = setup.slot;
  quad_ = QuadConstants(setup);
  for (std::size_t k = 0; k < linear_count; ++k) block_.linear[k] = setup.linear[k].value;
  blocks_ = Squares(quad_, tile_ * Config::block_tiles, cull_);
  tiles_ = Squares(quad_, tile_, cull_);
  first_x_ = quad_.homogeneous ? scissor_x_ : 0;
  first_y_ = quad_.homogeneous ? scissor_y_ : 0;
  bx_ = by_ = 0;
  block_right_ = true;
  const bool apart = first_x_ >= Config::block_tiles || first_y_ >= Config::block_tiles;
  state_ = quad_.tiles_x == 0 || quad_.tiles_y == 0 ? State::end : apart ? State::approach : State::block;
}

bool TileWalk::tested() const {
  if (state_ == State::block) return !reject_ || blocks_.may_cover(block_);
  if (state_ == State::tile) return (may_cover_ >> (8 * ty_ + tx_) & 1) != 0;
  return false;
}

/// Of the block's tiles, bit 8 row + column.
std::uint64_t TileWalk::tiles_in_scissor() const {
  const auto from = [](int first, int block) { return std::max(first - block * Config::block_tiles, 0); };
  const std::uint64_t row = 0xffu >> (8 - tiles_in_block(quad_.tiles_x, bx_)) & (0xffu << from(first_x_, bx_));
  std::uint64_t word = 0;
  for (int y = from(first_y_, by_); y < tiles_in_block(quad_.tiles_y, by_); ++y) word |= row << 8 * y;
  return word;
}

bool TileWalk::hidden() const {
  if (memory_ == nullptr) return false;
  if (state_ == State::tile) return memory_->hidden(tile_x(), tile_y(), depth_) && tested();
  if (state_ != State::block) return false;
  const TileBlock tiles = block();
  return memory_->block_hidden(tiles.tile_x, tiles.tile_y, tiles.columns, tiles.rows, depth_) && tested();
}

bool TileWalk::hit() const { return tested() && !hidden(); }

TileEntry TileWalk::entry() const {
  TileEntry e;
  e.slot = slot_;
  if (state_ == State::end) {
    e.end = true;
    return e;
  }
  const int column = bx_ * Config::block_tiles + tx_, row = by_ * Config::block_tiles + ty_;
  e.tile_x = tile_x();
  e.tile_y = tile_y();
  e.last_row = row == quad_.tiles_y - 1 ? quad_.last_row : tile_ - 1;
  e.linear = at_tile().linear;
  e.quadratic = tile_context(quad_, column * tile_, row * tile_, drop_);
  return e;
}

void TileWalk::advance() {
  switch (state_) {
    case State::idle:
      break;
    case State::end:
      state_ = State::idle;
      break;
    case State::approach:
      approach();
      break;
    case State::block:
      if (hit()) {
        may_cover_ = tiles_in_scissor();
        if (reject_) may_cover_ &= tiles_.may_cover(block_, tiles_in_block(quad_.tiles_y, by_), place_signs_);
        tx_ = ty_ = 0;
        tile_right_ = true;
        state_ = State::tile;
      } else {
        step_block();
      }
      break;
    case State::tile: {
      if (memory_ != nullptr)
        memory_->tested(tile_x(), tile_y(), whole_.hold(tile_x(), tile_y()) && tiles_.covers(at_tile()), depth_);
      const int nx = tiles_in_block(quad_.tiles_x, bx_);
      const int ny = tiles_in_block(quad_.tiles_y, by_);
      if (tile_right_ ? tx_ + 1 < nx : tx_ > 0) {
        tx_ += tile_right_ ? 1 : -1;
      } else if (ty_ + 1 < ny) {
        ++ty_;
        tile_right_ = !tile_right_;
      } else {
        step_block();
      }
      break;
    }
  }
}

/// A block towards the scissor's first row of blocks, then towards the end of it at which the whole walk comes there.
void TileWalk::approach() {
  const int last = (quad_.tiles_x - 1) / Config::block_tiles;
  if (by_ < first_y_ / Config::block_tiles) {
    move_block(0, 1);
  } else if (bx_ != (block_right_ ? first_x_ / Config::block_tiles : last)) {
    move_block(1, 0);
  } else {
    state_ = State::block;
  }
}

void TileWalk::step_block() {
  const int first = first_x_ / Config::block_tiles, last = (quad_.tiles_x - 1) / Config::block_tiles;
  state_ = State::block;
  if (block_right_ ? bx_ < last : bx_ > first) {
    move_block(block_right_ ? 1 : -1, 0);
  } else if (by_ < (quad_.tiles_y - 1) / Config::block_tiles) {
    move_block(0, 1);
  } else {
    state_ = State::end;
  }
}

/// To the block beside this one, or to that below, in whose row the walk goes the other way.
void TileWalk::move_block(int columns, int rows) {
  const int size = tile_ * Config::block_tiles;
  bx_ += columns;
  by_ += rows;
  if (rows != 0) block_right_ = !block_right_;
  walk_step(block_, quad_, columns * size, rows * size);
}

}  // namespace quadrille
