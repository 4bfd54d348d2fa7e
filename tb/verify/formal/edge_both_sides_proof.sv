// An edge from its other end: the edge function is negated, and so is its sign with ties, so that two quads that share an edge see opposite signs of
// it everywhere. Signs and ties are those of edge_reach and of stamp_coverage (proof stamp_signs). For all vertices of C bits. Nothing is assumed.
module edge_both_sides_proof #(
    parameter int C = 4
) (
    input logic [C-1:0] xi_i,
    input logic [C-1:0] yi_i,
    input logic [C-1:0] xj_i,
    input logic [C-1:0] yj_i
);
  logic signed [2*C+2:0] there, back;
  logic there_pos, there_neg, back_pos, back_neg;

  edge_signs #(.C(C)) u_there (.xi_i(xi_i), .yi_i(yi_i), .xj_i(xj_i), .yj_i(yj_i), .value_o(there), .pos_o(there_pos), .neg_o(there_neg));
  edge_signs #(.C(C)) u_back (.xi_i(xj_i), .yi_i(yj_i), .xj_i(xi_i), .yj_i(yi_i), .value_o(back), .pos_o(back_pos), .neg_o(back_neg));

  // The ties of the machine, from the same gradients sign-extended.
  localparam int GRAD = quadrille_pkg::GRAD_BITS;
  localparam int REACH = quadrille_pkg::REACH_BITS;
  logic [GRAD-1:0] gx, gy;
  logic tie_pos, tie_neg;
  logic [4*REACH-1:0] unused;

  assign gx = GRAD'($signed(yi_i)) - GRAD'($signed(yj_i));
  assign gy = GRAD'($signed(xj_i)) - GRAD'($signed(xi_i));

  quadrille_edge_reach u_reach (
      .gx_i(gx),
      .gy_i(gy),
      .gx_zero_i(gx == '0),
      .gy_zero_i(gy == '0),
      .tie_pos_o(tie_pos),
      .tie_neg_o(tie_neg),
      .fall_tile_o(unused[0+:REACH]),
      .rise_tile_o(unused[REACH+:REACH]),
      .fall_block_o(unused[2*REACH+:REACH]),
      .rise_block_o(unused[3*REACH+:REACH])
  );

  always_comb begin
    assert (there == -back);
    assert (there_pos == back_neg && there_neg == back_pos);
    assert (!(there_pos && there_neg));
    assert (there_pos == (there > 0 || (there == 0 && tie_pos)));
    assert (there_neg == (there < 0 || (there == 0 && tie_neg)));
    // Neither sign: the ends are one point.
    assert (there_pos || there_neg || (xi_i == xj_i && yi_i == yj_i));
  end
endmodule
