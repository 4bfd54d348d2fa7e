// What crosses each stage boundary of the machine, as plain records. Their fields and bits are in boundaries.hpp.
#pragma once

#include "model/port/config.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/records.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille {

inline constexpr int linear_count = 6;      ///< E01 E12 E23 E30 E20 E13
inline constexpr int quadratic_count = 10;  ///< D01 D12 D23 D30 D20 D13 R²0 R²1 R²2 R²3

/// The vertices (i, j) of linear function k, E_ij = S_i × S_j, and of quadratic function k < 6, S_i · S_j.
inline constexpr std::array<std::array<std::size_t, 2>, linear_count> vertex_pair{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}, {1, 3}}};

/// Significand number inside the pipeline: value = (-1)^neg sig 2^(exp - (S-1)); zero has all fields 0.
struct PipelineFloat {
  bool neg = false;
  std::int32_t exp = 0;
  std::uint32_t sig = 0;

  friend bool operator==(const PipelineFloat&, const PipelineFloat&) = default;
};

/// value + dx·gx + dy·gy; units 2^-2FRAC.
struct LinearForm {
  std::int64_t value = 0, gx = 0, gy = 0;
};

/// value + dx·gx + dy·gy + q·(dx² + dy²); units 2^-quadratic_frac.
struct QuadraticForm {
  std::int64_t value = 0, gx = 0, gy = 0, q = 0;
};

/// A vertex relative to a pixel: (X − W x, Y − W y, W), units 2^-FRAC.
struct RelativeVertex {
  std::int64_t x = 0, y = 0, w = 0;
};

/// What quad_setup hands to tile_walk.
struct SetupResult {
  std::uint32_t slot = 0;
  int tile_x0 = 0, tile_y0 = 0, tiles_x = 0, tiles_y = 0;
  int last_row = 0;  ///< last pixel row that may be covered, in its tile
  bool homogeneous = false;
  bool hull = false;         ///< the eye is inside the hull: visibility per pixel
  std::uint8_t visible = 0;  ///< bit 0: clause 1 +, 1: clause 2 +, 2: clause 1 −, 3: clause 2 −
  std::uint8_t clauses = 0;  ///< those that some pixel can meet: the triangle 012 or 023 turns that way; all with hull
  std::uint8_t separated = 0;  ///< triangles that miss the scissor (scissor_separation), with skip_walk
  std::array<LinearForm, linear_count> linear{};
  std::array<std::uint64_t, linear_count> length2{};  ///< |V_i − V_j|² of the pairs, units 2^-quadratic_frac
  std::array<RelativeVertex, 4> vertex{};             ///< relative to the first tile's origin pixel
};

/// One entry of the tile ring.
struct TileEntry {
  bool end = false;
  std::uint32_t slot = 0;
  int tile_x = 0, tile_y = 0;
  int last_row = 0;                                 ///< the rows below have no covered pixel
  std::array<std::int64_t, linear_count> linear{};  ///< values at the tile's origin pixel
  /// From the tile's origin pixel. An ordinary quad has the squared distances alone (6 to 9): its dot products follow
  /// from them.
  std::array<QuadraticForm, quadratic_count> quadratic{};
};

/// One entry of the stamp FIFO.
struct StampEntry {
  bool end = false;
  std::uint32_t tile_ptr = 0;
  int row = 0;
  std::uint32_t mask = 0, front = 0, tie = 0;
};

/// Everything one pixel is on its way through the pipeline.
struct PixelTrace {
  bool valid = false, end = false;
  std::uint32_t slot = 0, quad = 0;
  int x = 0, y = 0;
  bool front = false, tie = false, homogeneous = false, hull = false;
  bool plane = false;  ///< of a plane_quad
  // diff
  std::array<std::int64_t, 6> a{}, d{};
  std::array<std::int64_t, 4> r2{};
  // norm
  bool two_corner = false, on_vertex = false, two_edge = false, on_edge = false;
  bool notch = false;  ///< an edge turns backward as seen from the pixel, and none of the first three; flag 6
  std::array<PipelineFloat, 6> a_fp{}, d_fp{};
  std::array<PipelineFloat, 4> r2_fp{};
  // sqrt
  std::array<PipelineFloat, 4> root{};
  // ratio
  std::array<PipelineFloat, 6> u{}, v{};  ///< r r' + |D| and |A|: tan of half the angle is v/u where D >= 0, else u/v
  // weight
  std::array<PipelineFloat, 4> m{};
  // sum
  std::array<PipelineFloat, max_attribute_slots> num_a{};
  PipelineFloat num_z, den_k, den_w;
  // fragment
  bool drawn = false;  ///< not discarded
  Fragment fragment;
};

/// The boundaries that have probes, in the order of the data's way, and the fragment port.
enum class Boundary { setup, tile, stamp, diff, norm, sqrt, ratio, weight, sum, fragment };

}  // namespace quadrille
