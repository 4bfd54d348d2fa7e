// SPDX-License-Identifier: Apache-2.0
// Expression (12) of Hormann & Tarini 2004 and its negation, for PLACES places at once: pixels, or squares of them.
// Combinational.
//
// Edge k (01 12 23 30, and the diagonal 20 as 4) of place p is at bit k*PLACES+p: pos_i, it can be positive there,
// neg_i, negative; in a square both may be, at a pixel at most one is. visible_i masks the two clauses of either sign
// (quad_setup). cull_i: 1 front, 2 back.
module quadrille_inside_expression #(
    parameter int PLACES = 1
) (
    input logic [1:0] cull_i,
    input logic [3:0] visible_i,
    input logic [5*PLACES-1:0] pos_i, neg_i,
    output logic [PLACES-1:0] back_o,  // clockwise as one sees it
    output logic [PLACES-1:0] front_o
);
  logic [PLACES-1:0] pos0, pos1, pos2, pos3, pos4;
  logic [PLACES-1:0] neg0, neg1, neg2, neg3, neg4;
  logic [PLACES-1:0] back1, back2, front1, front2;  // the clauses
  assign {pos4, pos3, pos2, pos1, pos0} = pos_i;
  assign {neg4, neg3, neg2, neg1, neg0} = neg_i;
  assign back1 = pos4 & pos0 & pos1 & (pos2 | pos3) & {PLACES{visible_i[0]}};
  assign back2 = neg4 & pos2 & pos3 & (pos0 | pos1) & {PLACES{visible_i[1]}};
  assign front1 = neg4 & neg0 & neg1 & (neg2 | neg3) & {PLACES{visible_i[2]}};
  assign front2 = pos4 & neg2 & neg3 & (neg0 | neg1) & {PLACES{visible_i[3]}};
  assign back_o = (back1 | back2) & {PLACES{cull_i != 2'd2}};
  assign front_o = (front1 | front2) & {PLACES{cull_i != 2'd1}};
endmodule
