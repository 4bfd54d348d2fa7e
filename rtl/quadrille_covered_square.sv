// SPDX-License-Identifier: Apache-2.0
// Whether an ordinary quad covers all of a square of pixels, from the signs that its edge functions take there (as in
// tile_walk: 01 12 23 30, and the diagonal 20 as 4). Combinational. Conservative: expression (12) with either sign
// where the diagonal has both.
module quadrille_covered_square (
    input logic [1:0] cull_i,
    input logic [4:0] some_pos_i, some_neg_i,
    output logic covered_o
);
  logic [4:0] all_pos, all_neg;
  logic diagonal;  // it has a sign
  logic back1, back2, front1, front2;  // the clauses without the diagonal
  logic back, front;
  assign all_pos = some_pos_i & ~some_neg_i;
  assign all_neg = some_neg_i & ~some_pos_i;
  assign diagonal = some_pos_i[4] || some_neg_i[4];
  assign back1 = all_pos[0] && all_pos[1] && (all_pos[2] || all_pos[3]);
  assign back2 = all_pos[2] && all_pos[3] && (all_pos[0] || all_pos[1]);
  assign front1 = all_neg[0] && all_neg[1] && (all_neg[2] || all_neg[3]);
  assign front2 = all_neg[2] && all_neg[3] && (all_neg[0] || all_neg[1]);
  assign back = (back1 || !some_pos_i[4]) && (back2 || !some_neg_i[4]);
  assign front = (front1 || !some_neg_i[4]) && (front2 || !some_pos_i[4]);
  assign covered_o = diagonal && ((back && cull_i != 2'd2) || (front && cull_i != 2'd1));

  logic unused;
  assign unused = ^{all_pos[4], all_neg[4]};
endmodule
