// SPDX-License-Identifier: Apache-2.0
// Raw product of two significand numbers: {neg, exp, 2S bits}, not normalised. Latency 1, one result per clock.
//
// value = product * 2^(exp-(2S-2)). product = 0 if either factor is zero; neg and exp mean nothing then.
module quadrille_fp_raw_product #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i, neg_i,
    input logic [E-1:0] a_exp_i,
    input logic [S-1:0] a_sig_i,
    input logic [E-1:0] b_exp_i,
    input logic [S-1:0] b_sig_i,
    output logic neg_o,
    output logic [E-1:0] exp_o,
    output logic [2*S-1:0] prod_o
);
  logic [2*S-1:0] product;

  quadrille_significand_product u_product (.a_i(a_sig_i), .b_i(b_sig_i), .product_o(product));

  always_ff @(posedge clk_i) begin
    neg_o <= neg_i;
    exp_o <= a_exp_i + b_exp_i;
    prod_o <= product;
  end
endmodule
