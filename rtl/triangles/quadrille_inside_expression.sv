// SPDX-License-Identifier: Apache-2.0
// Triangle machine: three edge functions, 01, 12 and 20 (as 4), have one sign, for PLACES places at once.
module quadrille_inside_expression #(
    parameter int PLACES = 1
) (
    input logic [1:0] cull_i,
    input logic [3:0] visible_i,
    input logic [5*PLACES-1:0] pos_i, neg_i,
    output logic [PLACES-1:0] back_o,  // clockwise as one sees it
    output logic [PLACES-1:0] front_o
);
  logic [2*PLACES-1:0] unused_pos, unused_neg;
  logic [PLACES-1:0] pos0, pos1, pos4, neg0, neg1, neg4;
  assign {pos4, unused_pos, pos1, pos0} = pos_i;
  assign {neg4, unused_neg, neg1, neg0} = neg_i;
  assign back_o = pos4 & pos0 & pos1 & {PLACES{visible_i[0] && cull_i != 2'd2}};
  assign front_o = neg4 & neg0 & neg1 & {PLACES{visible_i[2] && cull_i != 2'd1}};

  logic unused;
  assign unused = ^{unused_pos, unused_neg, visible_i[3], visible_i[1]};
endmodule
