// Where what is known of a tile, or of a block of tiles, is held: by the low bits of its column and row.
#pragma once

#include "model/port/config.hpp"

#include <cstddef>
#include <cstdint>

namespace quadrille {

/// Places of squares of a grid in a memory of 2^(column_bits + row_bits).
class TilePlaces {
 public:
  TilePlaces() = default;
  TilePlaces(int column_bits, int row_bits) : column_bits_(column_bits), row_bits_(row_bits) {}
  /// A place a tile, as many as the machine has.
  explicit TilePlaces(const Config& config)
      : TilePlaces((config.hierarchical_z_tiles_log2 + 1) / 2, config.hierarchical_z_tiles_log2 / 2) {}

  std::size_t count() const { return std::size_t{1} << (column_bits_ + row_bits_); }
  std::size_t place(int x, int y) const {
    const int column = x & ((1 << column_bits_) - 1), row = y & ((1 << row_bits_) - 1);
    return static_cast<std::size_t>(row << column_bits_ | column);
  }
  /// The square itself, which the place does not tell.
  static std::uint32_t name(int x, int y) {
    return static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
  }

 private:
  int column_bits_ = 0, row_bits_ = 0;
};

}  // namespace quadrille
