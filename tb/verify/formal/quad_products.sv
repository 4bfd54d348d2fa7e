// Edge functions and determinants of a quad with vertices (X, Y, W), as rtl/SPEC.md, quad_setup, has them. For the proofs of visibility.
// All numbers have BITS bits, vertices too: of narrower ones the solver would not know two sides of an identity for one polynomial.
module quad_products #(
    parameter int BITS = quadrille_pkg::DET_BITS
) (
    input logic [4*BITS-1:0] x_i,
    input logic [4*BITS-1:0] y_i,
    input logic [4*BITS-1:0] w_i,
    output logic [15*BITS-1:0] edge_o,  // V_i x V_j of E01 E12 E23 E30 E20: their gx, their gy, their values at the origin
    output logic [4*BITS-1:0] det_o  // d_012, d_023, d_123, d_013
);
  for (genvar k = 0; k < 5; k++) begin : gen_edge
    localparam int I = (k == 4) ? 2 : k;
    localparam int J = (k == 4) ? 0 : (k + 1) % 4;
    logic [BITS-1:0] xi, yi, wi, xj, yj, wj;

    assign xi = x_i[I*BITS+:BITS];
    assign yi = y_i[I*BITS+:BITS];
    assign wi = w_i[I*BITS+:BITS];
    assign xj = x_i[J*BITS+:BITS];
    assign yj = y_i[J*BITS+:BITS];
    assign wj = w_i[J*BITS+:BITS];
    assign edge_o[k*BITS+:BITS] = yi * wj - wi * yj;
    assign edge_o[(5+k)*BITS+:BITS] = wi * xj - xi * wj;
    assign edge_o[(10+k)*BITS+:BITS] = xi * yj - yi * xj;
  end

  for (genvar d = 0; d < 4; d++) begin : gen_determinant  // E01 V2, E23 V0, E12 V3, E01 V3
    localparam int K = (d == 1) ? 2 : (d == 2) ? 1 : 0;
    localparam int M = (d == 0) ? 2 : (d == 1) ? 0 : 3;

    assign det_o[d*BITS+:BITS] = x_i[M*BITS+:BITS] * edge_o[K*BITS+:BITS] + y_i[M*BITS+:BITS] * edge_o[(5+K)*BITS+:BITS] +
        w_i[M*BITS+:BITS] * edge_o[(10+K)*BITS+:BITS];
  end
endmodule
