// SPDX-License-Identifier: Apache-2.0
// sqrt(q_far / q_near) of two vertex pairs without a corner in common, as num / den. One pixel per clock.
//
// q = r r' + D of an edge, r r' - D of a diagonal. Where the terms add it is u = r r' + |D|; where they cancel it is
// v^2 / u with v = |A|, since (r r')^2 - D^2 = A^2. With z = u_near u_far, w = v_far u_near and s = sqrt(z):
//
//     near adds                  m / s, m = u_far, or v_far where far cancels
//     near cancels, far adds     s / v_near
//     both cancel                w / v_near s
//
// own_i is the one of m, v_near that the case needs. Latency SQRT_STAGES + PRODUCT_STAGES + 1.
//
// Both then move by one power of two, to exponents that are opposite but for one: a ratio of 2^e has num near 2^(e/2)
// and den near 2^(-e/2), and beside a zero the other is in [1, 2). So no product of three of them leaves 2^+-120
// (SPEC.md), and the move is common to all weights.
module quadrille_root_ratio #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i, near_cancels_i, far_cancels_i,
    input logic [E-1:0] z_exp_i,
    input logic [S-1:0] z_sig_i,
    input logic [E-1:0] w_exp_i,
    input logic [S-1:0] w_sig_i,
    input logic [E-1:0] own_exp_i,
    input logic [S-1:0] own_sig_i,
    output logic [E-1:0] num_exp_o,
    output logic [S-1:0] num_sig_o,
    output logic [E-1:0] den_exp_o,
    output logic [S-1:0] den_sig_o
);
  // ---- The root, and what waits for it ------------------------------------------------------------------------------
  logic [E-1:0] root_exp, own_exp;
  logic [S-1:0] root_sig, own_sig;
  logic [E+S-1:0] own;
  quadrille_sqrt u_sqrt (.clk_i, .exp_i(z_exp_i), .sig_i(z_sig_i), .exp_o(root_exp), .sig_o(root_sig));

  quadrille_delay_line #(.WIDTH(E + S), .DEPTH(quadrille_pkg::SQRT_STAGES)) u_delay_own (
      .clk_i, .data_i({own_exp_i, own_sig_i}), .data_o(own)
  );

  assign {own_exp, own_sig} = own;

  // ---- v_near s, and what waits for it -----------------------------------------------------------------------------
  logic [E+S-1:0] late_root, late_own, late_w, scaled;
  logic near_cancels, far_cancels;
  quadrille_fp_multiply u_scaled (
      .clk_i, .a_exp_i(own_exp), .a_sig_i(own_sig), .b_exp_i(root_exp), .b_sig_i(root_sig), .exp_o(scaled[S+:E]),
      .sig_o(scaled[0+:S])
  );

  quadrille_delay_line #(.WIDTH(2 * (E + S)), .DEPTH(quadrille_pkg::PRODUCT_STAGES)) u_delay_factors (
      .clk_i, .data_i({root_exp, root_sig, own}), .data_o({late_root, late_own})
  );

  quadrille_delay_line #(.WIDTH(E + S + 2), .DEPTH(quadrille_pkg::SQRT_STAGES +
      quadrille_pkg::PRODUCT_STAGES)) u_delay_w (
      .clk_i, .data_i({w_exp_i, w_sig_i, near_cancels_i, far_cancels_i}), .data_o({late_w, near_cancels, far_cancels})
  );

  // ---- Which is which, and the exponents in balance ----------------------------------------------------------------
  logic [E+S-1:0] num, den;
  logic [E-1:0] distance, half;
  logic neither_zero;
  assign num = !near_cancels ? late_own : far_cancels ? late_w : late_root;
  assign den = !near_cancels ? late_root : far_cancels ? scaled : late_own;
  assign distance = num[S+:E] - den[S+:E];
  assign half = {distance[E-1], distance[E-1:1]};
  assign neither_zero = num[S-1] && den[S-1];

  always_ff @(posedge clk_i) begin
    num_exp_o <= neither_zero ? half : '0;
    den_exp_o <= neither_zero ? ~half + E'(!distance[0]) : '0;  // half - distance
    num_sig_o <= num[0+:S];
    den_sig_o <= den[0+:S];
  end
endmodule
