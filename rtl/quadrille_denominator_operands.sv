// SPDX-License-Identifier: Apache-2.0
// What the denominators N = |r_j k_i + r_i k_j| of a pixel on two edges (i, j) are made of: two products each.
// Combinational.
//
// Of edge CLASS_FIRST the products 0 (r_j k_i) and 1 (r_i k_j), of edge CLASS_SECOND the products 2 and 3; neg_o has
// the sign of k. Numbers are {exp, sig}.
module quadrille_denominator_operands #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int CLASS = quadrille_pkg::CLASS_BITS, F = E + S
) (
    input logic [CLASS-1:0] class_i,
    input logic [4*F-1:0] root_i,
    input logic [3:0] k_neg_i,
    input logic [4*PE-1:0] k_exp_i,
    input logic [4*S-1:0] k_sig_i,
    output logic [4*F-1:0] root_o, k_o,
    output logic [3:0] neg_o
);
  logic [1:0] first, second, after_first, after_second;
  logic [4*2-1:0] root_index, k_index;
  logic [4*F-1:0] k;
  assign first = class_i[quadrille_pkg::CLASS_FIRST+:2];
  assign second = class_i[quadrille_pkg::CLASS_SECOND+:2];
  assign after_first = first + 2'd1;
  assign after_second = second + 2'd1;
  assign root_index = {second, after_second, first, after_first};
  assign k_index = {after_second, second, after_first, first};

  for (genvar g = 0; g < 4; g++) begin : gen_product
    assign k[g*F+:F] = {E'($signed(k_exp_i[g*PE+:PE])), k_sig_i[g*S+:S]};

    quadrille_one_of_four #(.WIDTH(F)) u_root (.words_i(root_i), .index_i(root_index[2*g+:2]), .word_o(root_o[g*F+:F]));
    quadrille_one_of_four #(.WIDTH(F)) u_k (.words_i(k), .index_i(k_index[2*g+:2]), .word_o(k_o[g*F+:F]));
    quadrille_one_of_four #(.WIDTH(1)) u_neg (.words_i(k_neg_i), .index_i(k_index[2*g+:2]), .word_o(neg_o[g]));
  end

  logic unused;
  assign unused = ^class_i[quadrille_pkg::CLASS_BITS-1:quadrille_pkg::CLASS_FIRST+2];
endmodule
