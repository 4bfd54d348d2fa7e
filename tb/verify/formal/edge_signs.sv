// Edge function of the edge from i to j at the pixel at the origin, and its sign with ties, from the vertices as rtl/SPEC.md, quad_setup, has them.
module edge_signs #(
    parameter int C = 4,  // bits of a coordinate, signed
    localparam int BITS = 2 * C + 3
) (
    input logic [C-1:0] xi_i,
    input logic [C-1:0] yi_i,
    input logic [C-1:0] xj_i,
    input logic [C-1:0] yj_i,
    output logic signed [BITS-1:0] value_o,
    output logic pos_o,
    output logic neg_o
);
  logic signed [BITS-1:0] xi, yi, xj, yj, gx, gy;
  logic tie_pos, tie_neg;

  assign xi = $signed(xi_i);
  assign yi = $signed(yi_i);
  assign xj = $signed(xj_i);
  assign yj = $signed(yj_i);
  assign value_o = xi * yj - yi * xj;
  assign gx = yi - yj;
  assign gy = xj - xi;
  assign tie_pos = gx > 0 || (gx == 0 && gy > 0);
  assign tie_neg = gx < 0 || (gx == 0 && gy < 0);
  assign pos_o = value_o > 0 || (value_o == 0 && tie_pos);
  assign neg_o = value_o < 0 || (value_o == 0 && tie_neg);
endmodule
