// The pixel pipeline as pure functions, one per RTL module, in the order in which a pixel meets them. Formats and
// truncations: rtl/SPEC.md. Each function fills its part of PixelTrace from the parts before.
//
// This is the plain integer form, the oracle of the quick one (untimed model).
#pragma once

#include "model/front/tile_walk.hpp"
#include "model/pixel/reciprocal.hpp"
#include "model/pixel/significand.hpp"
#include "model/pixel/sqrt.hpp"

namespace quadrille {

/// What the back half needs of a quad: the slot bank's contents.
struct QuadData {
  std::uint32_t id = 0;
  bool homogeneous = false, hull = false;
  bool sum_k = true;                 ///< the sum of M k is formed, not left 0
  bool plane = false;                ///< plane_quad: areas in the place of mean value weights
  std::array<PipelineFloat, 4> k{};  ///< k_eff: k, or W when perspective is off
  std::array<PipelineFloat, 4> w{};  ///< W truncated to S bits
  std::array<PipelineFloat, 4> z{};  ///< of depth, less its base
  std::array<std::array<PipelineFloat, max_attribute_slots>, 4> b{};  ///< of attributes, less theirs; 0 of vertex 0
  QuadBase base;
};

/// With skip_operands what no sum needs is zero: W without depth and hull, Z without depth, attributes not in use; of
/// k, which the weights need too, sum_k says so.
QuadData quad_data(const SnappedQuad& quad, const SetupResult& setup, const Config& config, const DrawState& state);

/// Everything constant over a draw that the stages look up.
struct PipelineContext {
  PipelineContext(const Config& c, const DrawState& s);

  Config config;
  DrawState state;
  SignificandFormat format;
  Table sqrt_table, recip_table;
  std::uint32_t znear, zfar;
  int quadratic_bias;  ///< exponent of A's bit 0 relative to D's and r²'s: −QDROP
  int attribute_frac;
};

/// What the pixels of a row of a tile have in common: value + row·gy of its functions. `tile` must outlive it.
struct TileRow {
  const TileEntry& tile;
  int row = 0;
  std::array<std::int64_t, linear_count> linear{};
  std::array<std::int64_t, quadratic_count> quadratic{};  ///< 0 to 5 of a homogeneous quad alone
};

TileRow forward_difference_row(const TileEntry& tile, const QuadConstants& quad, int row);
/// A, D, r² at pixel dx of the row: + dx·gx + q(dx² + row²); D of an ordinary quad by the law of cosines. Exact.
void forward_difference_column(PixelTrace& p, const TileRow& row, const QuadConstants& quad, int dx);
/// The two together, for whoever wants one pixel.
inline void forward_difference(PixelTrace& p, const TileEntry& tile, const QuadConstants& quad, int dx, int row) {
  forward_difference_column(p, forward_difference_row(tile, quad, row), quad, dx);
}
/// S-bit significands of A, D, r² and the singular class (rtl/SPEC.md, singular_class, in its priority).
void normalise(PixelTrace& p, const PipelineContext& c);
/// r_i = sqrt(r_i²), faithful.
void sqrt_stage(PixelTrace& p, const PipelineContext& c);
/// u = r r' + |D| and v = |A| of the four edges and both diagonals: no term cancels, nothing is divided.
void mean_value_ratios(PixelTrace& p, const PipelineContext& c);
/// M_i, up to a common factor: products of three roots of ratios q/q', q = r r' ± D; Hormann & Tarini eq. (8) with the
/// tangents of half the angles left out.
void mean_value_weights(PixelTrace& p, const QuadData& quad, const PipelineContext& c);
/// The sums of eqs. (4), (10), (11).
void interpolate(PixelTrace& p, const QuadData& quad, const PipelineContext& c);
/// Two reciprocals, quotients rounded to codes and added to the bases, clamps, flags, discard.
void fragment_output(PixelTrace& p, const QuadData& quad, const PipelineContext& c);

/// All that a pixel has of its own, from its row on. With skip_operands a pixel on a corner has no significand numbers,
/// roots and ratios: its weights are the corner's. One of a plane_quad has of these what comes of A.
void pixel_lane(PixelTrace& p, const TileRow& row, const QuadConstants& constants, const QuadData& quad, int dx,
                const PipelineContext& c);

/// All of them, for one pixel.
inline void pixel_pipeline(PixelTrace& p, const TileEntry& tile, const QuadConstants& constants, const QuadData& quad,
                           int dx, int row, const PipelineContext& c) {
  pixel_lane(p, forward_difference_row(tile, constants, row), constants, quad, dx, c);
}

}  // namespace quadrille
