// SPDX-License-Identifier: Apache-2.0
// u = r r' + |D| and v = |A| of the six vertex pairs (edges 01 12 23 30, diagonals 20 13): the tangent of half the
// angle between the pixel's vectors to the two is v/u where D >= 0 and u/v elsewhere, without a cancellation and
// without a division.
//
// A and D enter at NORM_STAGE, r at ROOT_STAGE; u and v leave at RATIO_STAGE (quadrille_pkg). One pixel per clock.
module quadrille_mean_value_ratios #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic [6*E-1:0] a_exp_i,
    input logic [6*S-1:0] a_sig_i,
    input logic [6*E-1:0] d_exp_i,
    input logic [6*S-1:0] d_sig_i,
    input logic [4*E-1:0] root_exp_i,
    input logic [4*S-1:0] root_sig_i,
    output logic [6*E-1:0] u_exp_o,
    output logic [6*S-1:0] u_sig_o,
    output logic [6*E-1:0] v_exp_o,
    output logic [6*S-1:0] v_sig_o
);
  localparam int TERM = quadrille_pkg::TERM_BITS;
  localparam int RANK = quadrille_pkg::RANK_BITS;

  for (genvar g = 0; g < 6; g++) begin : gen_pair
    localparam int I = {30'd0, quadrille_pkg::pair_first(4'(g))}, J = {30'd0, quadrille_pkg::pair_second(4'(g))};

    logic [RANK-1:0] rr_rank, rr_rank_q;
    logic [TERM-1:0] rr_term;
    logic rr_neg;
    quadrille_fp_term u_rr (
        .clk_i, .neg_i(1'b0), .a_exp_i(root_exp_i[I*E+:E]), .a_sig_i(root_sig_i[I*S+:S]), .b_exp_i(root_exp_i[J*E+:E]),
        .b_sig_i(root_sig_i[J*S+:S]), .rank_o(rr_rank), .neg_o(rr_neg), .term_o(rr_term)
    );

    always_ff @(posedge clk_i) rr_rank_q <= rr_rank;

    // |D| waits for the root and the product.
    logic [E-1:0] d_exp;
    logic [S-1:0] d_sig;
    quadrille_delay_line #(.WIDTH(E + S), .DEPTH(quadrille_pkg::SQRT_STAGES +
        quadrille_pkg::PRODUCT_STAGES)) u_delay_d (
        .clk_i, .data_i({d_exp_i[g*E+:E], d_sig_i[g*S+:S]}), .data_o({d_exp, d_sig})
    );

    quadrille_fp_add u_u (
        .clk_i, .a_rank_i(rr_rank_q), .a_term_i(rr_term), .b_rank_i(quadrille_pkg::exponent_rank(d_exp, d_sig[S-1])),
        .b_term_i(quadrille_pkg::lone_term(d_sig)), .exp_o(u_exp_o[g*E+:E]), .sig_o(u_sig_o[g*S+:S])
    );

    quadrille_delay_line #(.WIDTH(E + S), .DEPTH(quadrille_pkg::RATIO_STAGE - quadrille_pkg::NORM_STAGE)) u_delay_v (
        .clk_i, .data_i({a_exp_i[g*E+:E], a_sig_i[g*S+:S]}), .data_o({v_exp_o[g*E+:E], v_sig_o[g*S+:S]})
    );

    logic unused;
    assign unused = rr_neg;
  end
endmodule
