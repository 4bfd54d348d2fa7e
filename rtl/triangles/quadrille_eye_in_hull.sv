// SPDX-License-Identifier: Apache-2.0
// Triangle machine: the sign of the one determinant says which orientation is in front of the eye. No hull.
module quadrille_eye_in_hull (
    input logic ordinary_i,
    input logic [3:0] negative_i, zero_i,
    output logic hull_o,
    output logic [3:0] visible_o
);
  assign hull_o = 1'b0;
  assign visible_o = ordinary_i ? 4'b0101 : {1'b0, negative_i[3], 1'b0, !negative_i[3] && !zero_i[3]};

  logic unused;
  assign unused = ^{negative_i[2:0], zero_i[2:0]};
endmodule
