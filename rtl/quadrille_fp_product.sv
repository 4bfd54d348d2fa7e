// SPDX-License-Identifier: Apache-2.0
// Product of two unsigned significand numbers in both forms: truncated and normalised (fp_multiply), and as a term of
// fp_sum (fp_term). Latency 1, one result per clock; rank_o is there at once.
module quadrille_fp_product #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic [E-1:0] a_exp_i,
    input logic [S-1:0] a_sig_i,
    input logic [E-1:0] b_exp_i,
    input logic [S-1:0] b_sig_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o,
    output logic [RANK-1:0] rank_o,
    output logic [TERM-1:0] term_o
);
  logic [E-1:0] exp_sum;
  logic [2*S-1:0] product;
  logic nonzero;

  quadrille_significand_product u_product (.a_i(a_sig_i), .b_i(b_sig_i), .product_o(product));
  assign exp_sum = a_exp_i + b_exp_i;
  assign nonzero = a_sig_i[S-1] && b_sig_i[S-1];
  assign rank_o = quadrille_pkg::exponent_rank(exp_sum, nonzero);

  always_ff @(posedge clk_i) begin
    {exp_o, sig_o} <= quadrille_pkg::truncated_product(exp_sum, product, nonzero);
    term_o <= quadrille_pkg::product_term(product);
  end
endmodule
