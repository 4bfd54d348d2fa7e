// Which vertex comes first does not matter, although the expression takes the diagonal 20: v0 v1 v2 v3 and v1 v2 v3 v0 cover the same pixels with the
// same facing, whatever the quad: convex, concave, bow-tie, degenerate. For all vertices of C bits. Nothing is assumed.
module first_vertex_proof #(
    parameter int C = 4
) (
    input logic [4*C-1:0] x_i,
    input logic [4*C-1:0] y_i
);
  logic back, front, back_shifted, front_shifted;

  quad_signs #(.C(C)) u_quad (.x_i, .y_i, .back_o(back), .front_o(front));
  quad_signs #(.C(C)) u_shifted (
      .x_i({x_i[0+:C], x_i[C+:3*C]}),
      .y_i({y_i[0+:C], y_i[C+:3*C]}),
      .back_o(back_shifted),
      .front_o(front_shifted)
  );

  always_comb assert ({back, front} == {back_shifted, front_shifted});
endmodule
