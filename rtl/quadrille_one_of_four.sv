// SPDX-License-Identifier: Apache-2.0
// One of four words by its index. Combinational.
//
// Not words_i[index*WIDTH +: WIDTH]: synthesis takes the product in that for a multiplier. Two LUTs of four inputs a
// bit: one gives word 0 or 1, or of the upper two which it is, the other chooses by that; from a case synthesis mostly
// makes three.
module quadrille_one_of_four #(
    parameter int WIDTH = 8
) (
    input logic [4*WIDTH-1:0] words_i,
    input logic [1:0] index_i,
    output logic [WIDTH-1:0] word_o
);
  logic [WIDTH-1:0] lower;
  assign lower = index_i[1] ? {WIDTH{index_i[0]}} : index_i[0] ? words_i[WIDTH+:WIDTH] : words_i[0+:WIDTH];
  assign word_o = !index_i[1] ? lower : (lower & words_i[3*WIDTH+:WIDTH]) | (~lower & words_i[2*WIDTH+:WIDTH]);
endmodule
