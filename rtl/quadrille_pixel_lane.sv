// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// One pixel a clock, from the row of its tile to its fragment: what a pixel has of its own. pixel_pipeline has
// PIXELS_PER_CLOCK of these, and what the pixels of a clock have in common: their row, their quad and its data. Never
// waits.
//
// Register n is written n clocks after the pixel enters the pipeline. The boundaries between units have the registers
// quadrille_pkg::DIFF_STAGE to FRAGMENT_STAGE, and signals are named after the boundary that they cross (SPEC.md, Pixel
// pipeline).
module quadrille_pixel_lane #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS, FB = quadrille_pkg::FRAGMENT_BITS,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2, VAL = quadrille_pkg::VAL_BITS, QVAL = quadrille_pkg::QVAL_BITS,
    localparam int SETS = 3 + N
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // The pixel, at the pipeline's input. One of a homogeneous quad is valid with its last part
    input logic valid_i,
    input logic [TILE_LOG2-1:0] row_i, dx_i,
    input logic front_i, tie_i,
    // Its row of the tile, a clock later
    input logic [quadrille_pkg::ROW_BITS-1:0] line_i,
    // Its part, in step with the values of the functions; a clock later squares_i, the last part of a homogeneous pixel
    input logic [1:0] part_i,
    input logic squares_i,
    // Of its quad, each where it is used; of its tile and row, where the output is
    input logic [quadrille_pkg::TERMS_BITS-1:0] terms_i,
    input logic [V-TILE_LOG2-1:0] output_tile_x_i,
    input logic [V-1:0] output_y_i,
    // Fragment
    output logic [quadrille_pkg::LATENCY-1:0] valid_o,  // a pixel is in register n, drawn or discarded
    // for performance_counters, else 0: numbers are taken on; at RATIO_STAGE: the weights are areas
    output logic [1:0] events_o,
    output logic fragment_valid_o,
    output logic [FB-1:0] fragment_o  // zero when there is none
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_TERMS_T, terms)

  // Registers at the boundaries
  localparam int DIFF = quadrille_pkg::DIFF_STAGE, NORM = quadrille_pkg::NORM_STAGE, RATIO = quadrille_pkg::RATIO_STAGE;
  localparam int LAST = quadrille_pkg::LATENCY - 1;  // the output register

  logic [LAST:0] valid_q;
  assign valid_o = valid_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[LAST-1:0], valid_i};
  end

  // ---- Side band: column, facing, tie; from the norm boundary on the class with them -------------------------------
  localparam int CLASS = quadrille_pkg::CLASS_BITS, FLAGS = quadrille_pkg::CLASS_FLAGS, TAG = TILE_LOG2 + 2;
  typedef struct packed {
    logic [TILE_LOG2-1:0] dx;
    logic front, tie;
    logic [FLAGS-1:0] flags;  // of the class
  } meta_t;
  logic [TAG-1:0] diff_tag, norm_tag;
  logic [CLASS-1:0] norm_class, ratio_class;
  logic ratio_plane;  // of a plane_quad
  logic norm_behind_diagonal, ratio_behind_diagonal;  // in its triangle 023
  logic [5:0] norm_d_neg, ratio_d_neg;  // signs of D
  meta_t output_meta;

  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(DIFF + 1)) u_diff_tag (
      .clk_i, .data_i({dx_i, front_i, tie_i}), .data_o(diff_tag)
  );
  quadrille_delay_line #(.WIDTH(TAG), .DEPTH(NORM - DIFF)) u_norm_tag (.clk_i, .data_i(diff_tag), .data_o(norm_tag));
  quadrille_delay_line #(.WIDTH(TAG + FLAGS), .DEPTH(LAST - 1 - NORM)) u_output_meta (
      .clk_i, .data_i({norm_tag, norm_class[CLASS-1-:FLAGS]}), .data_o(output_meta)
  );
  quadrille_delay_line #(.WIDTH(CLASS + 6), .DEPTH(RATIO - NORM)) u_ratio_class (
      .clk_i, .data_i({norm_class, norm_d_neg}), .data_o({ratio_class, ratio_d_neg})
  );

  if (quadrille_pkg::PLANE_QUADS != 0) begin : gen_plane
    quadrille_delay_line #(.WIDTH(1), .DEPTH(RATIO - NORM)) u_behind_diagonal (
        .clk_i, .data_i(norm_behind_diagonal), .data_o(ratio_behind_diagonal)
    );
    quadrille_delay_line #(.WIDTH(1), .DEPTH(RATIO - NORM + 2)) u_plane (
        .clk_i, .data_i(terms.norm_plane), .data_o(ratio_plane)
    );
  end else begin : gen_no_plane
    assign ratio_plane = 1'b0;
    assign ratio_behind_diagonal = 1'b0;
  end

  // ---- Exact functions at the pixel --------------------------------------------------------------------------------
  logic [6*VAL-1:0] diff_a;
  logic [4*QVAL-1:0] diff_r2;
  logic [6*QVAL-1:0] diff_d;
  quadrille_pixel_functions u_functions (
      .clk_i, .row_i, .dx_i, .line_i, .part_i, .squares_i, .length2_i(terms.length2), .a_o(diff_a), .d_o(diff_d),
      .r2_o(diff_r2)
  );

  // ---- Significand numbers and class -------------------------------------------------------------------------------
  // Of a pixel on a corner the weights are the corner's: nothing between here and weight_factors is looked at. Its
  // numbers, and all of what is no pixel, as the first parts of a homogeneous one, are not taken on, so that the
  // operands of everything up to the weights stay as they are. Of a plane_quad the weights are areas: A alone is taken
  // on.
  logic corner, taken_on, distance_taken_on, norm_active_q, distance_active_q, class_active_q;
  assign taken_on = !state.skip[4] || (valid_q[NORM-2] && !corner);
  assign distance_taken_on = taken_on && !terms.norm_plane;

  always_ff @(posedge clk_i) begin
    norm_active_q <= taken_on;
    distance_active_q <= distance_taken_on;
    class_active_q <= !state.skip[4] || valid_q[NORM-2];
  end

  assign events_o[1] = quadrille_pkg::PERFORMANCE_COUNTERS != 0 && distance_active_q;

  logic [5:0] norm_a_neg;
  logic [6*E-1:0] norm_a_exp, norm_d_exp;
  logic [6*S-1:0] norm_a_sig, norm_d_sig;
  logic [3:0] norm_r2_neg;
  logic [4*E-1:0] norm_r2_exp;
  logic [4*S-1:0] norm_r2_sig;

  for (genvar g = 0; g < 6; g++) begin : gen_norm
    quadrille_normalise #(.WIDTH(VAL), .BIAS(-quadrille_pkg::QDROP)) u_a (
        .clk_i, .active_i(norm_active_q), .value_i(diff_a[g*VAL+:VAL]), .neg_o(norm_a_neg[g]),
        .exp_o(norm_a_exp[g*E+:E]), .sig_o(norm_a_sig[g*S+:S])
    );

    quadrille_normalise #(.WIDTH(QVAL)) u_d (
        .clk_i, .active_i(distance_active_q), .value_i(diff_d[g*QVAL+:QVAL]), .neg_o(norm_d_neg[g]),
        .exp_o(norm_d_exp[g*E+:E]), .sig_o(norm_d_sig[g*S+:S])
    );
  end

  for (genvar g = 0; g < 4; g++) begin : gen_norm_r2
    quadrille_normalise #(.WIDTH(QVAL), .CLAMP(1'b1)) u_r2 (
        .clk_i, .active_i(distance_active_q), .value_i(diff_r2[g*QVAL+:QVAL]), .neg_o(norm_r2_neg[g]),
        .exp_o(norm_r2_exp[g*E+:E]), .sig_o(norm_r2_sig[g*S+:S])
    );
  end

  quadrille_singular_class u_class (
      .clk_i, .active_i(class_active_q), .a_i(diff_a[0+:4*VAL]), .d_i(diff_d[0+:4*QVAL]), .r2_i(diff_r2),
      .corner_o(corner), .class_o(norm_class)
  );

  // Inside a convex quad the edge functions have one sign, and E20 has it too on the side of corner 1.
  assign norm_behind_diagonal = norm_a_neg[4] != (norm_a_neg[3:0] != '0);

  // ---- r_i, the corners' distances ---------------------------------------------------------------------------------
  logic [4*E-1:0] root_exp;
  logic [4*S-1:0] root_sig;

  for (genvar g = 0; g < 4; g++) begin : gen_sqrt
    quadrille_sqrt u_sqrt (
        .clk_i, .exp_i(norm_r2_exp[g*E+:E]), .sig_i(norm_r2_sig[g*S+:S]), .exp_o(root_exp[g*E+:E]),
        .sig_o(root_sig[g*S+:S])
    );
  end

  // ---- Ratios and weights ------------------------------------------------------------------------------------------
  logic [6*E-1:0] ratio_u_exp, ratio_v_exp;
  logic [6*S-1:0] ratio_u_sig, ratio_v_sig;
  logic [4*E-1:0] m_exp;
  logic [4*S-1:0] m_sig;
  quadrille_mean_value_ratios u_ratios (
      .clk_i, .a_exp_i(norm_a_exp), .a_sig_i(norm_a_sig), .d_exp_i(norm_d_exp), .d_sig_i(norm_d_sig),
      .root_exp_i(root_exp), .root_sig_i(root_sig), .u_exp_o(ratio_u_exp), .u_sig_o(ratio_u_sig), .v_exp_o(ratio_v_exp),
      .v_sig_o(ratio_v_sig)
  );

  quadrille_mean_value_weights u_weights (
      .clk_i, .root_exp_i(root_exp), .root_sig_i(root_sig), .u_exp_i(ratio_u_exp), .u_sig_i(ratio_u_sig),
      .v_exp_i(ratio_v_exp), .v_sig_i(ratio_v_sig), .d_neg_i(ratio_d_neg), .class_i(ratio_class), .plane_i(ratio_plane),
      .behind_diagonal_i(ratio_behind_diagonal), .k_neg_i(terms.product_k_neg), .k_exp_i(terms.product_k_exp),
      .k_sig_i(terms.product_k_sig), .override_k_exp_i(terms.override_k_exp), .override_k_sig_i(terms.override_k_sig),
      .count_area_o(events_o[0]), .m_exp_o(m_exp), .m_sig_o(m_sig)
  );

  // ---- Sums. Sets: 0 k_eff, 1 W, 2 Z, 3.. attributes ---------------------------------------------------------------
  logic [SETS-1:0] sum_neg;
  logic [SETS*E-1:0] sum_exp;
  logic [SETS*S-1:0] sum_sig;
  quadrille_interpolate u_interpolate (
      .clk_i, .m_exp_i(m_exp), .m_sig_i(m_sig), .term_neg_i(terms.blend_neg), .term_exp_i(terms.blend_exp),
      .term_sig_i(terms.blend_sig), .sum_neg_o(sum_neg), .sum_exp_o(sum_exp), .sum_sig_o(sum_sig)
  );

  // ---- Reciprocals, the numerators wait ----------------------------------------------------------------------------
  localparam int NUMS = 1 + N;  // Z and the attributes
  logic rk_neg, rw_neg;
  logic [E-1:0] rk_exp, rw_exp;
  logic [S-1:0] rk_sig, rw_sig;
  logic [NUMS-1:0] num_neg;
  logic [NUMS*E-1:0] num_exp;
  logic [NUMS*S-1:0] num_sig;
  quadrille_reciprocal u_reciprocal_k (
      .clk_i, .neg_i(sum_neg[0]), .exp_i(sum_exp[0+:E]), .sig_i(sum_sig[0+:S]), .neg_o(rk_neg), .exp_o(rk_exp),
      .sig_o(rk_sig)
  );

  quadrille_reciprocal u_reciprocal_w (
      .clk_i, .neg_i(sum_neg[1]), .exp_i(sum_exp[E+:E]), .sig_i(sum_sig[S+:S]), .neg_o(rw_neg), .exp_o(rw_exp),
      .sig_o(rw_sig)
  );

  for (genvar g = 0; g < NUMS; g++) begin : gen_numerator
    quadrille_delay_line #(.WIDTH(1 + E + S), .DEPTH(quadrille_pkg::RECIPROCAL_STAGES)) u_delay (
        .clk_i, .data_i({sum_neg[2+g], sum_exp[(2+g)*E+:E], sum_sig[(2+g)*S+:S]}),
        .data_o({num_neg[g], num_exp[g*E+:E], num_sig[g*S+:S]})
    );
  end

  // ---- Quotients, output -------------------------------------------------------------------------------------------
  quadrille_fragment_output u_output (
      .clk_i, .rst_ni, .depth_on_i(state.depth), .attributes_i(state.attributes), .attr_neg_i(num_neg[NUMS-1:1]),
      .attr_exp_i(num_exp[NUMS*E-1:E]), .attr_sig_i(num_sig[NUMS*S-1:S]), .z_neg_i(num_neg[0]),
      .z_exp_i(num_exp[E-1:0]), .z_sig_i(num_sig[S-1:0]), .rk_neg_i(rk_neg), .rk_exp_i(rk_exp), .rk_sig_i(rk_sig),
      .rw_neg_i(rw_neg), .rw_exp_i(rw_exp), .rw_sig_i(rw_sig), .base_attr_i(terms.base_attr),
      .base_depth_i(terms.base_depth), .depth_limits_i(terms.base_limits), .valid_i(valid_q[LAST-1]),
      .id_i(terms.output_id), .hull_i(terms.output_hull), .homogeneous_i(terms.output_homogeneous),
      .x_i({output_tile_x_i, output_meta.dx}), .y_i(output_y_i), .front_i(output_meta.front), .tie_i(output_meta.tie),
      .flags_i(output_meta.flags), .valid_o(fragment_valid_o), .fragment_o
  );

  logic unused;
  assign unused = ^{norm_r2_neg, norm_a_neg[5], norm_behind_diagonal};

`ifndef SYNTHESIS
  // A regular pixel's weights are near 1.
  localparam int WEIGHT = quadrille_pkg::WEIGHT_STAGE, OVERRIDES = quadrille_pkg::CLASS_OVERRIDES;
  logic [OVERRIDES-1:0] weight_overrides;
  quadrille_delay_line #(.WIDTH(OVERRIDES), .DEPTH(WEIGHT - NORM)) u_weight_overrides (
      .clk_i, .data_i(norm_class[CLASS-1-:OVERRIDES]), .data_o(weight_overrides)
  );

  for (genvar g = 0; g < 4; g++) begin : gen_range
    int exp;

    assign exp = 32'($signed(m_exp[g*E+:E]));
    always_ff @(posedge clk_i) begin
      if (rst_ni && valid_q[WEIGHT] && weight_overrides == '0) begin
        `QUADRILLE_ASSERT(assert_weight_exponent,
            exp <= quadrille_pkg::WEIGHT_EXP_LIMIT && exp >= -quadrille_pkg::WEIGHT_EXP_LIMIT,
            "a regular weight is near 1")
      end
    end
  end

  logic [quadrille_pkg::CLASS_KINDS-1:0] kinds;
  assign kinds = norm_class[CLASS-1-:quadrille_pkg::CLASS_KINDS];

  // Zero when not valid.
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_zero_when_idle,
          fragment_valid_o || fragment_o == '0,
          "the fragment is zero without valid")
      `QUADRILLE_ASSERT(assert_fragment_has_pixel, !fragment_valid_o || valid_q[LAST], "a fragment comes of a pixel")
      `QUADRILLE_ASSERT(assert_one_class,
          !valid_q[NORM] || (kinds & (kinds - quadrille_pkg::CLASS_KINDS'(1))) == '0,
          "a pixel is of one singular kind at most")
    end
  end
`endif
endmodule
