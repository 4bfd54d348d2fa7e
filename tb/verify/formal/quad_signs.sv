// Coverage of the pixel at the origin by quad v0..v3, vertices relative to it: edge_signs, then inside_expression. For the proofs of coverage.
module quad_signs #(
    parameter int C = 4
) (
    input logic [4*C-1:0] x_i,
    input logic [4*C-1:0] y_i,
    output logic back_o,
    output logic front_o
);
  logic [4:0] pos, neg;

  for (genvar k = 0; k < 5; k++) begin : gen_edge
    localparam int I = (k == 4) ? 2 : k;
    localparam int J = (k == 4) ? 0 : (k + 1) % 4;
    logic [2*C+2:0] unused;
    edge_signs #(.C(C)) u_edge (
        .xi_i(x_i[I*C+:C]),
        .yi_i(y_i[I*C+:C]),
        .xj_i(x_i[J*C+:C]),
        .yj_i(y_i[J*C+:C]),
        .value_o(unused),
        .pos_o(pos[k]),
        .neg_o(neg[k])
    );
  end

  quadrille_inside_expression u_inside (
      .cull_i(2'd0),
      .visible_i(4'b1111),
      .pos_i(pos),
      .neg_i(neg),
      .back_o,
      .front_o
  );
endmodule
