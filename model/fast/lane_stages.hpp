// The pixel pipeline's stages one at a time, each over many blocks of eight pixels in double precision, with the
// results kept between them: configurations that agree up to a stage share what comes out of it. The bits are those of
// pixel_pipeline.hpp.
//
// A significand number is a double whose mantissa is cut to S bits by an AND mask, so truncation toward zero costs one
// instruction; products of two S-bit significands (S <= 26) are exact in 53 bits, aligned sums are too, and all
// exponents stay far inside a double's range. Nothing here ever rounds but what the output's codes round.
#pragma once

#include "model/fast/lane_quad.hpp"

#include <cstddef>
#include <span>

namespace quadrille {

inline constexpr int lane_count = 8;

/// A table as doubles.
struct LaneTable {
  struct Entry {
    double c0, c1, c2;
  };
  int segments_log2, rest_bits;
  std::vector<Entry> entries;

  explicit LaneTable(const Table& table);
};

using LaneReals = double __attribute__((vector_size(8 * lane_count)));
using LaneIntegers = std::int64_t __attribute__((vector_size(8 * lane_count)));

/// What is kept in memory says its alignment: compiled for narrow registers the bare vector types ask for less than the
/// code for wide ones relies on.
inline constexpr std::size_t lane_bytes = 8 * lane_count;

/// Probe diff: exact integers.
struct alignas(lane_bytes) DifferenceLanes {
  LaneIntegers a[6], d[6], r2[4];
};
/// Probe norm, magnitudes; the signs are those of DifferenceLanes.
struct alignas(lane_bytes) NormalisedLanes {
  LaneReals a[6], d[6], r2[4];
};
struct alignas(lane_bytes) SqrtLanes {
  LaneReals root[4];
};
struct alignas(lane_bytes) RatioLanes {
  LaneReals u[6], v[6];
};
struct alignas(lane_bytes) WeightLanes {
  LaneReals m[4];
};
struct alignas(lane_bytes) ReciprocalLanes {
  LaneReals k, w;  ///< of den_k and den_w
};
/// One number of a block.
struct alignas(lane_bytes) LaneColumn {
  LaneReals v;
};

/// Columns that may be interpolated at once.
inline constexpr std::size_t max_lane_columns = 16;

/// A quad's numbers behind the port as doubles. A column is what an attribute slot carries.
struct QuadColumns {
  bool hull = false;
  QuadBase base;                                            ///< of it what belongs to depth; attributes have columns
  std::array<double, 4> k{}, w{}, z{};                      ///< k: k_eff
  std::array<std::array<double, 4>, max_lane_columns> b{};  ///< 0 of vertex 0
  std::array<std::int64_t, max_lane_columns> attribute_base{};
};

/// Sums of a block: den_k, den_w, num_z, then the columns.
inline constexpr std::size_t sums_per_block(std::size_t columns) { return 3 + columns; }

struct LaneOutputFormat {
  int attribute_int_bits, attribute_frac, depth_bits;
  bool depth;                 ///< off: no window z, no discard by it
  std::uint32_t znear, zfar;  ///< depth codes
};
/// Bit l of a mask is lane l.
struct LaneMasks {
  std::uint8_t drawn, saturated;
};

/// Lanes that the lane stages do not compute: corner and two-edge pixels.
unsigned singular_lanes(const DifferenceLanes& d);
/// The four M of one such lane by the plain pipeline, put where the lanes' weights are; what follows treats it as any
/// other. Of `c` the format and the sqrt table matter.
void singular_weights(const DifferenceLanes& d, std::size_t lane, const QuadData& quad, const PipelineContext& c,
                      WeightLanes& out);

// Each output has as many blocks as the input; s = significand_bits, g = align_guard_bits.
void normalise_blocks(std::span<const DifferenceLanes> in, int s, int quadratic_bias, NormalisedLanes* out);
void sqrt_blocks(std::span<const NormalisedLanes> in, int s, const LaneTable& table, SqrtLanes* out);
void ratio_blocks(std::span<const NormalisedLanes> in, const SqrtLanes* root, int s, int g, RatioLanes* out);
void weight_blocks(std::span<const DifferenceLanes> signs, const RatioLanes* in, int s, int g, const LaneTable& table,
                   WeightLanes* out);
/// Areas in the place of mean value weights (rtl/SPEC.md, Plane quads): of quads that take them.
void area_blocks(std::span<const DifferenceLanes> signs, const NormalisedLanes* in, WeightLanes* out);
/// quad[n]: position in `values` of block n's quad. num_z is left out (0) without `depth`.
void interpolate_blocks(std::span<const WeightLanes> in, const std::uint32_t* quad, const QuadColumns* values,
                        std::size_t columns, bool depth, int s, int g, LaneColumn* sums);
void reciprocal_blocks(std::size_t blocks, const LaneColumn* sums, std::size_t columns, int s, const LaneTable& table,
                       ReciprocalLanes* out);
/// values: per block window z (0 without depth), then the columns, as the numbers that the fragment's codes stand for.
void output_blocks(std::size_t blocks, const LaneColumn* sums, const ReciprocalLanes* reciprocals,
                   const std::uint32_t* quad, const QuadColumns* quads, std::size_t columns,
                   const LaneOutputFormat& format, LaneColumn* values, LaneMasks* masks);

}  // namespace quadrille
