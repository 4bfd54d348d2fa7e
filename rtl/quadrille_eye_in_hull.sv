// SPDX-License-Identifier: Apache-2.0
// Is the eye, the origin of R^3, in the hull of a quad's four vertices V_i = (X, Y, W)? And if not, which clauses of
// expression (12) are in front of it? Combinational, from the signs of the determinants d_012, d_023, d_123, d_013, in
// this order (bits 0 to 3).
//
// Always d_123 V0 - d_023 V1 + d_013 V2 - d_012 V3 = 0, and of vertices that span R^3 no other sum is 0: the eye is in
// the hull (or on its surface) unless two of these factors have different signs. If all four are 0 the eye counts as in
// it. An ordinary quad's vertices are all in front of the eye. tb/verify/formal proves that hull_o and visible_o are
// right at every pixel. Twin: model/front/quad_setup.cpp, eye_in_hull.
module quadrille_eye_in_hull (
    input logic ordinary_i,  // all W are ONE
    input logic [3:0] negative_i, zero_i,
    output logic hull_o,  // decided at each pixel, at the end: all clauses are visible
    output logic [3:0] visible_o  // clauses 1 and 2 of (12), clauses 1 and 2 of its negation
);
  logic [3:0] positive;
  logic some_pos, some_neg;  // among d_123, -d_023, d_013, -d_012
  assign positive = ~negative_i & ~zero_i;
  assign some_pos = positive[2] || negative_i[1] || positive[3] || negative_i[0];
  assign some_neg = negative_i[2] || positive[1] || negative_i[3] || positive[0];
  assign hull_o = !ordinary_i && !(some_pos && some_neg);
  assign visible_o = (ordinary_i || hull_o) ? 4'b1111 : {negative_i[1:0], positive[1:0]};
endmodule
