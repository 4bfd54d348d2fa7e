// SPDX-License-Identifier: Apache-2.0
// Quotients to fixed point, their sums with the bases, clamps, discard, output register. Latency FRAGMENT_OUTPUT_STAGES
// from numerators and reciprocals to the port: products, fixed_point, sums, clamps, output.
//
// A quotient is rounded to a code, halves away from zero: fixed_point gives a bit more, which is the carry of the sum
// with the base. Attribute: two's complement, ATTRIBUTE_INT_BITS and ATTRIBUTE_FRAC_BITS, saturated to
// +-(2^(INT+FRAC)-1). Depth: unsigned, 1 integer bit, DEPTH_BITS fraction bits, clamped to the corners' (quad_reject).
// A pixel is discarded outside [znear, zfar] and, in a quad whose hull holds the eye, behind the eye. The register
// holds zeros whenever it is not valid. valid_i and the rest of a pixel's identity come one clock before the port,
// limits and draw state two, bases three.
module quadrille_fragment_output #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS, DB = quadrille_pkg::DEPTH_BITS, AO = quadrille_pkg::ATTR_OUT_BITS,
    localparam int ID = quadrille_pkg::QUAD_ID_BITS, FB = quadrille_pkg::FRAGMENT_BITS,
    localparam int FLAGS = quadrille_pkg::CLASS_FLAGS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // Draw state
    input logic depth_on_i,
    input logic [3:0] attributes_i,
    // Numerators and reciprocals
    input logic [N-1:0] attr_neg_i,
    input logic [N*E-1:0] attr_exp_i,
    input logic [N*S-1:0] attr_sig_i,
    input logic z_neg_i,
    input logic [E-1:0] z_exp_i,
    input logic [S-1:0] z_sig_i,
    input logic rk_neg_i,
    input logic [E-1:0] rk_exp_i,
    input logic [S-1:0] rk_sig_i,
    input logic rw_neg_i,
    input logic [E-1:0] rw_exp_i,
    input logic [S-1:0] rw_sig_i,
    // Three clocks before the port
    input logic [N*AO-1:0] base_attr_i,
    input logic [DB:0] base_depth_i,
    // Two: {outside, near_cuts, far_cuts, least, greatest}
    input logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] depth_limits_i,
    // One clock before the port
    input logic valid_i,
    input logic [ID-1:0] id_i,
    input logic hull_i, homogeneous_i,
    input logic [V-1:0] x_i, y_i,
    input logic front_i, tie_i,
    input logic [FLAGS-1:0] flags_i,  // of the class, CLASS_NOTCH lowest
    // Port
    output logic valid_o,
    output logic [FB-1:0] fragment_o
);
  // ---- Attributes ---------------------------------------------------------------------------------------------------
  localparam int TO_FIXED = quadrille_pkg::FIXED_POINT_STAGES;
  logic [N-1:0] overflow;
  logic [N*AO-1:0] attr;

  for (genvar g = 0; g < N; g++) begin : gen_attribute
    localparam int SUM = AO + 2;  // a quotient is below 2 2^INT, a base below 2^INT
    logic prod_neg, neg, late_neg, used, too_large, least, above;
    logic [E-1:0] exp;
    logic [2*S-1:0] prod;
    logic overflow_d, overflow_q;
    logic [AO:0] fixed;  // with the bit that rounds
    logic [SUM-1:0] sum_q;
    quadrille_fp_raw_product u_product (
        .clk_i, .neg_i(attr_neg_i[g] ^ rk_neg_i), .a_exp_i(attr_exp_i[g*E+:E]), .a_sig_i(attr_sig_i[g*S+:S]),
        .b_exp_i(rk_exp_i), .b_sig_i(rk_sig_i), .neg_o(prod_neg), .exp_o(exp), .prod_o(prod)
    );

    // A difference of two values has one integer bit more than a value.
    quadrille_fixed_point #(
        .INT_BITS(quadrille_pkg::ATTRIBUTE_INT_BITS + 1), .FRAC_BITS(quadrille_pkg::ATTRIBUTE_FRAC_BITS + 1)
    ) u_fixed (
        .clk_i, .neg_i(prod_neg), .exp_i(exp), .prod_i(prod), .overflow_o(overflow_d), .neg_o(neg), .fixed_o(fixed)
    );

    quadrille_delay_line #(.WIDTH(1), .DEPTH(TO_FIXED + 1)) u_delay_neg (.clk_i, .data_i(prod_neg), .data_o(late_neg));

    // base + q or base + ~q + 1. Rounded q is one more where its last bit is set: then a carry the more, or the one
    // not, which of both fixed's last bit says as it is. {a, 1} + {b, carry} is an adder whose carry-in is used.
    always_ff @(posedge clk_i) begin
      sum_q <= SUM'(({SUM'($signed(base_attr_i[g*AO+:AO])), 1'b1} + {{2{neg}}, fixed}) >> 1);
      overflow_q <= overflow_d;
    end

    assign used = attributes_i > 4'(g);
    assign above = overflow_q ? !late_neg : !sum_q[SUM-1];  // when too large
    assign too_large = overflow_q || (sum_q[SUM-1-:3] != 3'b000 && sum_q[SUM-1-:3] != 3'b111);
    assign least = sum_q[AO-2:0] == '0 && sum_q[AO-1];  // -2^(INT+FRAC), when not too large

    always_ff @(posedge clk_i) begin
      overflow[g] <= used && (too_large || least);
      attr[g*AO+:AO] <= too_large ? {!above, {(AO - 2) {above}}, 1'b1} : {sum_q[AO-1:1], sum_q[0] || least};
      if (!used) attr[g*AO+:AO] <= '0;
    end
  end

  // ---- Depth -------------------------------------------------------------------------------------------------------
  localparam int Z_SUM = DB + 3;  // signed: a quotient is below 2, a base at most 1
  logic z_prod_neg, z_neg, late_z_neg, w_zero, w_neg;
  logic [E-1:0] z_exp;
  logic [2*S-1:0] z_prod;
  logic z_overflow, z_overflow_q, z_neg_q;
  logic [DB+1:0] z_fixed;  // with the bit that rounds
  logic [Z_SUM-1:0] z_q;
  logic outside, near_cuts, far_cuts, below, beyond;
  logic [DB:0] least_z, greatest_z, depth_q;
  logic depth_discard_q, behind_q, behind_early_q;
  quadrille_fp_raw_product u_product_z (
      .clk_i, .neg_i(z_neg_i ^ rw_neg_i), .a_exp_i(z_exp_i), .a_sig_i(z_sig_i), .b_exp_i(rw_exp_i), .b_sig_i(rw_sig_i),
      .neg_o(z_prod_neg), .exp_o(z_exp), .prod_o(z_prod)
  );

  quadrille_delay_line #(.WIDTH(1), .DEPTH(TO_FIXED)) u_delay_z_neg (.clk_i, .data_i(z_prod_neg), .data_o(late_z_neg));
  quadrille_delay_line #(.WIDTH(2), .DEPTH(quadrille_pkg::PRODUCT_STAGES + TO_FIXED)) u_delay_w (
      .clk_i, .data_i({rw_sig_i == '0, rw_neg_i}), .data_o({w_zero, w_neg})
  );

  quadrille_fixed_point #(.INT_BITS(1), .FRAC_BITS(DB + 1)) u_fixed_z (
      .clk_i, .neg_i(z_prod_neg), .exp_i(z_exp), .prod_i(z_prod), .overflow_o(z_overflow), .neg_o(z_neg),
      .fixed_o(z_fixed)
  );

  always_ff @(posedge clk_i) begin
    z_q <= Z_SUM'(({Z_SUM'(base_depth_i), 1'b1} + {{2{z_neg}}, z_fixed}) >> 1);
    z_neg_q <= late_z_neg && !w_zero;
    z_overflow_q <= z_overflow || w_zero;
    behind_early_q <= w_zero || w_neg;
  end

  assign {outside, near_cuts, far_cuts, least_z, greatest_z} = depth_limits_i;
  assign below = z_overflow_q ? z_neg_q : $signed(z_q) < $signed(Z_SUM'(least_z));
  assign beyond = z_overflow_q ? !z_neg_q : $signed(z_q) > $signed(Z_SUM'(greatest_z));

  always_ff @(posedge clk_i) begin
    depth_q <= beyond ? greatest_z : below ? least_z : z_q[DB:0];
    if (!depth_on_i) depth_q <= '0;
    depth_discard_q <= depth_on_i && (outside || (below && near_cuts) || (beyond && far_cuts));
    behind_q <= behind_early_q;
  end

  // ---- Output register ---------------------------------------------------------------------------------------------
  logic two_corner, on_vertex, two_edge, on_edge, notch;
  logic [7:0] flags;
  logic valid_d;
  logic [FB-1:0] fragment_d;
  assign {two_corner, on_vertex, two_edge, on_edge, notch} = flags_i;
  assign flags = {overflow != '0, notch, homogeneous_i, tie_i, two_edge, two_corner, on_vertex, on_edge};
  assign valid_d = valid_i && !(hull_i && behind_q) && !depth_discard_q;
  assign fragment_d = {id_i, x_i, y_i, front_i, flags, depth_q, attr};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      valid_o <= 1'b0;
      fragment_o <= '0;
    end else begin
      valid_o <= valid_d;
      fragment_o <= valid_d ? fragment_d : '0;
    end
  end
endmodule
