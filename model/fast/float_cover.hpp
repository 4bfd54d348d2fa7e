// Coverage of a quad's tiles and the list of their pixels, for float_lanes.cpp, which includes this once for each
// instruction set, behind its vectors and edge_signs.

/// Those that the quad's corners reach, in the scissor.
inline Range rows_in_tile(const PixelBounds& bounds, int y0, int tile) {
  return {std::max(bounds.top - y0, 0), std::min(bounds.bottom - y0, tile - 1) + 1};
}
inline Range columns_in_tile(const PixelBounds& bounds, int x0, int tile) {
  return {std::max(bounds.left - x0, 0), std::min(bounds.right - x0, tile - 1) + 1};
}

/// A one in the first place of every row of a word.
inline std::uint64_t every_row(int tile) {
  return tile == 4 ? 0x1111u : tile == 8 ? 0x0101010101010101u : 0x0001000100010001u;
}

/// Of a word of a tile; rows and columns are some.
inline std::uint64_t seen_pixels(Range rows, Range columns, int tile, int word) {
  const auto below_bit = [](int bit) {
    return bit >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << std::max(bit, 0)) - 1;
  };
  return (((std::uint64_t{1} << columns.to) - (std::uint64_t{1} << columns.from)) * every_row(tile)) &
         below_bit(rows.to * tile - 64 * word) & ~below_bit(rows.from * tile - 64 * word);
}

/// stamp_coverage of a tile, of the rows and columns that the quad's corners reach.
inline void tile_masks(const FloatLanes::Format& format, const TileCorner& corner, const QuadConstants& quad,
                       Range rows, Range columns, TileMasks& out) {
  const int tile = 1 << format.tile_log2, words = std::max(1, tile * tile / 64);
  const std::uint64_t whole = tile == 4 ? 0xffffu : ~std::uint64_t{0};
  std::uint64_t positive[5][most_words], negative[5][most_words], zeros[most_words] = {};
  for (std::size_t k = 0; k < 5; ++k) {
    const std::int64_t gx = quad.gx[k], gy = quad.gy[k], value = corner.linear[k];
    const std::int64_t sx = gx * (tile - 1), sy = gy * (tile - 1);
    const std::int64_t lo = wrap_add(value, std::min<std::int64_t>(sx, 0) + std::min<std::int64_t>(sy, 0));
    const std::int64_t hi = wrap_add(value, std::max<std::int64_t>(sx, 0) + std::max<std::int64_t>(sy, 0));
    if (lo > 0 || hi < 0) {  // one sign everywhere
      for (int w = 0; w < words; ++w) {
        positive[k][w] = lo > 0 ? whole : 0;
        negative[k][w] = lo > 0 ? 0 : whole;
      }
      continue;
    }
    std::uint64_t below[most_words] = {}, zero[most_words] = {};
    edge_signs(value, gx, gy, rows, columns.from & ~3, columns.to, tile, below, zero);
    const std::uint64_t tie_pos = quad.tie_pos[k] ? whole : 0, tie_neg = quad.tie_neg[k] ? whole : 0;
    for (int w = 0; w < words; ++w) {
      positive[k][w] = (whole & ~(below[w] | zero[w])) | (zero[w] & tie_pos);
      negative[k][w] = below[w] | (zero[w] & tie_neg);
      zeros[w] |= zero[w] & (tie_pos | tie_neg);  // an all-zero edge decides nothing
    }
  }

  for (int w = 0; w < words; ++w) {
    SignWords<std::uint64_t> signs[5];
    for (std::size_t k = 0; k < 5; ++k) signs[k] = {positive[k][w], negative[k][w]};
    const PlaceWords<std::uint64_t> inside = inside_expression(signs, quad.visible, format.cull);
    const std::uint64_t seen = seen_pixels(rows, columns, tile, w), mask = (inside.back | inside.front) & seen;
    out[static_cast<std::size_t>(w)] = {mask, inside.front & seen, zeros[w] & mask};
  }
}

/// Rows of a word with any bit.
inline int rows_of(std::uint64_t mask, int tile_log2) {
  // What comes from the row above never reaches a row's first place.
  for (int places = 1; places < 1 << tile_log2; places *= 2) mask |= mask >> places;
  return __builtin_popcountll(mask & every_row(1 << tile_log2));
}

/// Appends a word of a tile's pixels, bit row * TILE + dx, (x0, y0) being its first.
inline void append_word(const TileWord& word, int x0, int y0, int tile_log2, FloatLanes::TileCounts& counts,
                        PixelList& list) {
  if (word.mask == 0) return;
  append(word, x0, y0, tile_log2, list);
  counts.stamps += rows_of(word.mask, tile_log2);
  const int pixels = __builtin_popcountll(word.mask);
  counts.pixels += pixels;
  counts.ties += __builtin_popcountll(word.tie);
  list.count += pixels;
}

/// Leaves what may be seen of a tile's words.
inline void keep_seen(int tile, MaskedDepth& masked, TileWord* words) {
  const std::uint64_t row_mask = (std::uint64_t{1} << tile) - 1;
  for (int row = 0; row < tile; ++row) {
    const int at = row * tile;
    TileWord& word = words[at / 64];
    const std::uint32_t covered = static_cast<std::uint32_t>(word.mask >> at % 64 & row_mask);
    const std::uint64_t behind = std::uint64_t{covered ^ masked.row(row, covered)} << at % 64;
    word.mask &= ~behind;
    word.tie &= ~behind;
  }
}

FloatLanes::TileCounts cover(const FloatLanes::Format& format, const PixelBounds& bounds, const TileCorner& corner,
                             const QuadConstants& quad, MaskedDepth* masked, PixelList& list) {
  FloatLanes::TileCounts counts;
  const int tile = 1 << format.tile_log2;
  const int x0 = (corner.tile_x << format.tile_log2) - bounds.x0, y0 = (corner.tile_y << format.tile_log2) - bounds.y0;
  const Range rows = rows_in_tile(bounds, y0, tile), columns = columns_in_tile(bounds, x0, tile);
  if (rows.from >= rows.to || columns.from >= columns.to) return counts;
  TileMasks masks;
  tile_masks(format, corner, quad, rows, columns, masks);
  if (masked != nullptr) keep_seen(tile, *masked, masks.data());
  for (int w = 0; w < std::max(1, tile * tile / 64); ++w)
    append_word(masks[static_cast<std::size_t>(w)], x0, y0 + w * (64 / tile), format.tile_log2, counts, list);
  return counts;
}
