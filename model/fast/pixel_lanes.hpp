// The pixel pipeline on eight pixels of one tile at once, in double precision: the quick twin of pixel_pipeline.hpp,
// bit for bit.
//
// A significand number is a double whose mantissa is cut to S bits by an AND mask, so truncation toward zero costs one
// instruction; products of two S-bit significands (S <= 26) are exact in 53 bits, aligned sums are too, and all
// exponents stay far inside a double's range. Nothing here ever rounds but what the output's codes round.
// lane_stages.hpp has the same stages one by one.
#pragma once

#include "model/front/covered_pixels.hpp"
#include "model/pixel/pixel_pipeline.hpp"

#include <optional>

namespace quadrille {

inline constexpr int lane_count = 8;

/// A quad's data as doubles; see QuadData.
///
/// A constant has no differences: its sum is 0 and need not be formed. Depth between equal limits needs no sum at all.
/// W that is k times one factor ±2^n has the sum of k times it, bit for bit: alignment is relative to the largest
/// exponent and truncation toward zero, so that neither sees the factor. With skip_operands W's reciprocal is then k's.
struct QuadLanes {
  using Factor = std::optional<double>;  ///< nothing: the sum is formed

  std::array<double, 4> k{}, w{}, z{};
  std::array<std::array<double, 4>, max_attribute_slots> b{};  ///< [attribute][vertex]
  bool sum_k = true, sum_w = true, sum_z = true;               ///< wanted, and not known to be 0
  std::array<bool, max_attribute_slots> sum_b{};
  bool constant_depth = false;  ///< depth_low, whatever the sums
  Factor w_of_k;

  QuadLanes() = default;
  QuadLanes(const QuadData& quad, const PipelineContext& c);
};

/// A table as doubles, for the lanes.
struct LaneTable {
  struct Entry {
    double c0, c1, c2;
  };
  int segments_log2, rest_bits;
  std::vector<Entry> entries;

  explicit LaneTable(const Table& table);
};

struct LaneTables {
  LaneTable sqrt, recip;

  explicit LaneTables(const PipelineContext& c) : sqrt(c.sqrt_table), recip(c.recip_table) {}
};

/// Results of up to eight pixels. Bit l of a mask is lane l.
struct LaneResult {
  unsigned drawn = 0;
  unsigned singular = 0;  ///< corner or two-edge pixels: not computed here, take the plain pipeline
  unsigned on_edge = 0, notch = 0, saturated = 0;
  std::array<std::uint32_t, lane_count> depth{};
  std::array<std::array<std::int64_t, lane_count>, max_attribute_slots> attribute{};
};

/// Pixels (dx[l], row[l]) of `tile`; every lane must hold a covered pixel (repeat one to fill).
void pixel_lanes(const TileEntry& tile, const QuadConstants& constants, const QuadData& quad, const QuadLanes& values,
                 const PipelineContext& c, const LaneTables& tables, const int* dx, const int* row, LaneResult& out);

/// The fragment of lane l, which is not singular: pixel `at` of `tile`.
inline Fragment lane_fragment(const LaneResult& r, int l, const TileEntry& tile, const CoveredPixel& at,
                              const QuadData& quad, const PipelineContext& c) {
  const auto bit = [&](unsigned mask, int flag) { return (mask >> l & 1) != 0 ? flag : 0; };
  Fragment f;
  f.quad = quad.id;
  f.x = static_cast<std::uint16_t>((tile.tile_x << c.config.tile_log2) + at.dx);
  f.y = static_cast<std::uint16_t>((tile.tile_y << c.config.tile_log2) + at.row);
  f.front = at.front;
  f.flags = static_cast<std::uint8_t>(bit(r.on_edge, flag_on_edge) | bit(r.notch, flag_notch) |
                                      bit(r.saturated, flag_saturated) | (at.tie ? flag_tie : 0) |
                                      (quad.homogeneous ? flag_homogeneous : 0));
  f.depth = r.depth[static_cast<std::size_t>(l)];
  for (std::size_t j = 0; j < static_cast<std::size_t>(c.state.attributes); ++j)
    f.attribute[j] = r.attribute[j][static_cast<std::size_t>(l)];
  return f;
}

}  // namespace quadrille
