// SPDX-License-Identifier: Apache-2.0
// A term of fp_sum: the product of two significand numbers as its window, latency 1, and its rank, which is there at
// once.
//
// term_o = the product's bits that an alignment by 0 keeps (quadrille_pkg::TERM_BITS, two of them integer bits); 0 if
// either factor is zero. rank_o is combinational, so that fp_sum compares exponents while the multiplier runs.
module quadrille_fp_term #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i, neg_i,
    input logic [E-1:0] a_exp_i,
    input logic [S-1:0] a_sig_i,
    input logic [E-1:0] b_exp_i,
    input logic [S-1:0] b_sig_i,
    output logic [RANK-1:0] rank_o,
    output logic neg_o,
    output logic [TERM-1:0] term_o
);
  logic [2*S-1:0] product;

  quadrille_significand_product u_product (.a_i(a_sig_i), .b_i(b_sig_i), .product_o(product));

  assign rank_o = quadrille_pkg::exponent_rank(a_exp_i + b_exp_i, a_sig_i[S-1] && b_sig_i[S-1]);

  always_ff @(posedge clk_i) begin
    neg_o <= neg_i;
    term_o <= quadrille_pkg::product_term(product);
  end
endmodule
