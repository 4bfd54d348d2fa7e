// SPDX-License-Identifier: Apache-2.0
// Product of two unsigned significand numbers, truncated and normalised. Latency 1, one result per clock.
//
// value = sig * 2^(exp-(S-1)), sig's top bit set or sig = exp = 0. Zero if either factor is zero. Signs are the user's
// business.
module quadrille_fp_multiply #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic [E-1:0] a_exp_i,
    input logic [S-1:0] a_sig_i,
    input logic [E-1:0] b_exp_i,
    input logic [S-1:0] b_sig_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  logic [2*S-1:0] product;
  logic nonzero;

  quadrille_significand_product u_product (.a_i(a_sig_i), .b_i(b_sig_i), .product_o(product));
  assign nonzero = a_sig_i[S-1] && b_sig_i[S-1];

  always_ff @(posedge clk_i) {exp_o, sig_o} <= quadrille_pkg::truncated_product(a_exp_i + b_exp_i, product, nonzero);
endmodule
