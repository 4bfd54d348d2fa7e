// Clocks that the units of the pixel pipeline take, and the registers at the boundaries between them: the
// figures of rtl/quadrille_pkg.sv under the same names, from the specification (rtl/SPEC.md, Pixel pipeline).
//
// The model computes a pixel whole at its emission; these say when each boundary shows it.
#pragma once

namespace quadrille::latency {

// From a unit's inputs to its outputs.
inline constexpr int forward_difference_row_stages = 1;
inline constexpr int forward_difference_column_stages = 2;
inline constexpr int forward_difference_stages = forward_difference_row_stages + forward_difference_column_stages;
inline constexpr int law_of_cosines_stages = 2;
inline constexpr int fp_normalise_stages = 2;
inline constexpr int normalise_stages = 1 + fp_normalise_stages;
inline constexpr int sqrt_stages = 4;
inline constexpr int reciprocal_stages = sqrt_stages;
inline constexpr int product_stages = 1;
inline constexpr int fp_sum_stages = 4 + fp_normalise_stages;  ///< from the product
inline constexpr int fp_add_stages = 3;
inline constexpr int fixed_point_stages = 2;
inline constexpr int fragment_output_stages = product_stages + fixed_point_stages + 3;  ///< sum, clamp, output

// The registers at the boundaries. A pixel is in register n during the clocks after n + 1 edges.
inline constexpr int diff_stage = forward_difference_stages + law_of_cosines_stages - 1;
inline constexpr int norm_stage = diff_stage + normalise_stages;
inline constexpr int root_stage = norm_stage + sqrt_stages;
inline constexpr int ratio_stage = root_stage + product_stages + fp_add_stages;
inline constexpr int n_stage = ratio_stage + 1 + product_stages + fp_sum_stages;
inline constexpr int override_stage = n_stage + 1;
inline constexpr int weight_stage = override_stage + product_stages + fp_add_stages + 1;
inline constexpr int sum_stage = weight_stage + product_stages + fp_sum_stages;
inline constexpr int fragment_stage = sum_stage + reciprocal_stages + fragment_output_stages;

/// Clocks from a pixel at the pipeline's input to its last register.
inline constexpr int pipeline = fragment_stage + 1;
/// Clocks from pixel_emit's decision to the pipeline's input: its own register, the tile's tag, tile and quad.
inline constexpr int emission = 3;
/// Clocks from the last register to the port: the fragment FIFO's memory and its output register.
inline constexpr int fragment_fifo = 2;
/// Clocks from a fragment's hand-over to the decision that knows of its place: a register, and the count of places.
inline constexpr int place_back = 2;
/// Clocks in which pixel_emit sends one pixel of a homogeneous quad, whose ten quadratic functions come in three parts.
inline constexpr int homogeneous_parts = 3;

}  // namespace quadrille::latency
