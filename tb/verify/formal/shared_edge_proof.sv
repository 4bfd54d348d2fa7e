// Exactly once, for all vertices of C bits around the pixel at the origin, convex, concave, crossed, without area: front less back of a quad v0 v1 v2 v3
// is that of its triangles v0 v1 v2 and v0 v2 v3 added, and that of v0 v1 v3 and v1 v2 v3 added; ties on edges, diagonals and vertices included.
// Triangles are sent as a, b, c, c. Nothing is assumed.
//
// What follows for a mesh. Let f(abc) be front less back of a triangle. By both diagonals f(abc) + f(acd) = f(abd) + f(bcd) of any four points; and the
// other way round f changes its sign, as all signs do (proof edge_both_sides). So with any fixed point o, f(abc) = f(oab) + f(obc) + f(oca): a sum over
// the edges in which one shared by two faces comes twice with opposite signs. What is left of a mesh's sum is its outline. If no face of it is drawn
// from the other side, nothing in the sum is negative, and it is how often the pixel is drawn: once where the outline goes round it once.
// An edge from its other end has all signs exchanged (edge_both_sides), so that six edges are evaluated here, not twenty-five.
module shared_edge_proof #(
    parameter int C = 3
) (
    input logic [4*C-1:0] x_i,
    input logic [4*C-1:0] y_i
);
  localparam int BITS = 2 * C + 3;
  logic [16*BITS-1:0] e;  // of the edge from i to j at 4 i + j
  logic [15:0] pos, neg;

  for (genvar i = 0; i < 4; i++) begin : gen_from
    for (genvar j = 0; j < 4; j++) begin : gen_to
      if (i < j) begin : gen_edge
        edge_signs #(.C(C)) u_edge (
            .xi_i(x_i[i*C+:C]),
            .yi_i(y_i[i*C+:C]),
            .xj_i(x_i[j*C+:C]),
            .yj_i(y_i[j*C+:C]),
            .value_o(e[(4*i+j)*BITS+:BITS]),
            .pos_o(pos[4*i+j]),
            .neg_o(neg[4*i+j])
        );
      end else if (i == j) begin : gen_none
        assign e[(4*i+j)*BITS+:BITS] = '0;
        assign {pos[4*i+j], neg[4*i+j]} = 2'b00;
      end else begin : gen_back
        assign e[(4*i+j)*BITS+:BITS] = -e[(4*j+i)*BITS+:BITS];
        assign pos[4*i+j] = neg[4*j+i];
        assign neg[4*i+j] = pos[4*j+i];
      end
    end
  end

  logic [4:0] back, front;

  for (genvar t = 0; t < 5; t++) begin : gen_quad  // the quad; 012, 023; 013, 123
    localparam int V0 = (t == 4) ? 1 : 0;
    localparam int V1 = (t == 2 || t == 4) ? 2 : 1;
    localparam int V2 = (t == 0 || t == 1) ? 2 : 3;
    localparam int V3 = (t == 1) ? 2 : 3;
    quadrille_inside_expression u_inside (
        .cull_i(2'd0),
        .visible_i(4'b1111),
        .pos_i({pos[4*V2+V0], pos[4*V3+V0], pos[4*V2+V3], pos[4*V1+V2], pos[4*V0+V1]}),
        .neg_i({neg[4*V2+V0], neg[4*V3+V0], neg[4*V2+V3], neg[4*V1+V2], neg[4*V0+V1]}),
        .back_o(back[t]),
        .front_o(front[t])
    );
  end

  // Front less back
  logic signed [2:0] turns [0:4];

  always_comb begin
    for (int t = 0; t < 5; t++) turns[t] = $signed({2'b00, front[t]}) - $signed({2'b00, back[t]});
    assert (turns[0] == turns[1] + turns[2]);
    assert (turns[0] == turns[3] + turns[4]);
    for (int t = 0; t < 5; t++) assert (!(back[t] && front[t]));
  end
endmodule
