// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// Triangle machine: one pixel a clock, from the row of its tile to its fragment. The weight of a corner is the
// magnitude of the edge function opposite to it, an area: M_0 = |E12|, M_1 = |E20|, M_2 = |E01|.
module quadrille_pixel_lane #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS, FB = quadrille_pkg::FRAGMENT_BITS,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2, VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS, SETS = 3 + N
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic valid_i,
    input logic [TILE_LOG2-1:0] row_i, dx_i,
    input logic front_i, tie_i,
    input logic [quadrille_pkg::ROW_BITS-1:0] line_i,  // a clock later
    input logic [1:0] part_i,
    input logic squares_i,
    input logic [quadrille_pkg::TERMS_BITS-1:0] terms_i,
    input logic [V-TILE_LOG2-1:0] output_tile_x_i,
    input logic [V-1:0] output_y_i,
    output logic [quadrille_pkg::LATENCY-1:0] valid_o,
    output logic [1:0] events_o,
    output logic fragment_valid_o,
    output logic [FB-1:0] fragment_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_TERMS_T, terms)
  `QUADRILLE_IN(`QUADRILLE_ROW_T, line)
  localparam int NORM = quadrille_pkg::NORM_STAGE, LAST = quadrille_pkg::LATENCY - 1;

  logic [LAST:0] valid_q;
  assign valid_o = valid_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[LAST-1:0], valid_i};
  end

  // ---- Side band ---------------------------------------------------------------------------------------------------
  logic [TILE_LOG2+1:0] norm_tag, output_tag;
  logic norm_on_edge, output_on_edge;
  quadrille_delay_line #(.WIDTH(TILE_LOG2 + 2), .DEPTH(NORM + 1)) u_norm_tag (
      .clk_i, .data_i({dx_i, front_i, tie_i}), .data_o(norm_tag)
  );
  quadrille_delay_line #(.WIDTH(TILE_LOG2 + 3), .DEPTH(LAST - 1 - NORM)) u_output_tag (
      .clk_i, .data_i({norm_tag, norm_on_edge}), .data_o({output_tag, output_on_edge})
  );

  // ---- Edge functions at the pixel, as significand numbers ---------------------------------------------------------
  localparam int DX_DIGITS = 2 * (TILE_LOG2 / 2 + 1), NORM_DIGITS = 2 * ((2 * TILE_LOG2 + 1) / 2 + 1);
  logic [DX_DIGITS-1:0] dx_digits;
  logic active_q;
  logic [2:0] norm_neg;
  logic [3*E-1:0] m_exp;
  logic [3*S-1:0] m_sig;
  quadrille_radix4_digits #(.NUMBER_BITS(TILE_LOG2)) u_dx (.number_i(dx_i), .digits_o(dx_digits));

  always_ff @(posedge clk_i) active_q <= !state.skip[4] || valid_q[NORM-2];

  for (genvar g = 0; g < 3; g++) begin : gen_corner
    localparam int F = (g == 0) ? 1 : (g == 1) ? 4 : 0;  // the edge opposite to it
    logic [VAL-1:0] value;
    quadrille_forward_difference_column #(.VALUE_BITS(VAL), .GRAD_BITS(GRAD), .QUADRATIC(1'b0)) u_column (
        .clk_i, .dx_digits_i(dx_digits), .norm_digits_i(NORM_DIGITS'(0)), .row_i(line.lin_value[F*VAL+:VAL]),
        .gx_i(line.lin_gx[F*GRAD+:GRAD]), .q_i(1'b0), .value_o(value)
    );
    quadrille_normalise #(.WIDTH(VAL)) u_area (
        .clk_i, .active_i(active_q), .value_i(value), .neg_o(norm_neg[g]), .exp_o(m_exp[g*E+:E]), .sig_o(m_sig[g*S+:S])
    );
  end

  assign norm_on_edge = m_sig[0+:S] == '0 || m_sig[S+:S] == '0 || m_sig[2*S+:S] == '0;
  assign events_o = {quadrille_pkg::PERFORMANCE_COUNTERS != 0 && active_q, 1'b0};

  // ---- Sums. Sets: 0 k_eff, 1 W, 2 Z, 3.. attributes ---------------------------------------------------------------
  logic [SETS-1:0] sum_neg;
  logic [SETS*E-1:0] sum_exp;
  logic [SETS*S-1:0] sum_sig;
  quadrille_interpolate u_interpolate (
      .clk_i, .m_exp_i(m_exp), .m_sig_i(m_sig), .term_neg_i(terms.blend_neg), .term_exp_i(terms.blend_exp),
      .term_sig_i(terms.blend_sig), .sum_neg_o(sum_neg), .sum_exp_o(sum_exp), .sum_sig_o(sum_sig)
  );

  // ---- Reciprocals, the numerators wait; quotients, output ---------------------------------------------------------
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
  quadrille_delay_line #(.WIDTH(NUMS * (1 + E + S)), .DEPTH(quadrille_pkg::RECIPROCAL_STAGES)) u_numerators (
      .clk_i, .data_i({sum_neg[SETS-1:2], sum_exp[SETS*E-1:2*E], sum_sig[SETS*S-1:2*S]}),
      .data_o({num_neg, num_exp, num_sig})
  );

  quadrille_fragment_output u_output (
      .clk_i, .rst_ni, .depth_on_i(state.depth), .attributes_i(state.attributes), .attr_neg_i(num_neg[NUMS-1:1]),
      .attr_exp_i(num_exp[NUMS*E-1:E]), .attr_sig_i(num_sig[NUMS*S-1:S]), .z_neg_i(num_neg[0]),
      .z_exp_i(num_exp[E-1:0]), .z_sig_i(num_sig[S-1:0]), .rk_neg_i(rk_neg), .rk_exp_i(rk_exp), .rk_sig_i(rk_sig),
      .rw_neg_i(rw_neg), .rw_exp_i(rw_exp), .rw_sig_i(rw_sig), .base_attr_i(terms.base_attr),
      .base_depth_i(terms.base_depth), .depth_limits_i(terms.base_limits), .valid_i(valid_q[LAST-1]),
      .id_i(terms.output_id), .hull_i(1'b0), .homogeneous_i(terms.output_homogeneous),
      .x_i({output_tile_x_i, output_tag[TILE_LOG2+1:2]}), .y_i(output_y_i), .front_i(output_tag[1]),
      .tie_i(output_tag[0]), .flags_i({3'b000, output_on_edge, 1'b0}), .valid_o(fragment_valid_o), .fragment_o
  );

  logic unused;
  assign unused = ^{row_i, part_i, squares_i, norm_neg};
endmodule
