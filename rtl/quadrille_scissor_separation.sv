// SPDX-License-Identifier: Apache-2.0
// Which of the two triangles of expression (12) cannot meet the scissor rectangle: separated_o, bit 0: 012, bit 1: 023.
// For a homogeneous quad, which has no bounding box. model/skips/scissor_separation.hpp says why this is nearly all
// that misses.
//
// Two kinds of evidence, as the results of vertex_products come. side_i: of a vertex (pair p of the units: of vertex
// vertex_i + p) the signs of X - W x, Y - W y at the scissor's near corner (x0, y0), or its far one (x1, y1): a side
// separates when all vertices of the triangle are outside or behind the eye, and so are the points at infinity of its
// edges that cross w = 0, by the edge functions' gradients. edge_i: the sign of one of a triangle's edge functions at
// the rectangle's corner where it is greatest, or with negated_i least: that edge separates. clear_i: a quad begins.
// The gradients and W are looked at in every clock.
module quadrille_scissor_separation #(
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS
) (
    input logic clk_i, clear_i, side_i, far_i,
    input logic [1:0] vertex_i,
    input logic [PAIRS-1:0] x_neg_i, y_neg_i,
    input logic [3:0] w_neg_i,
    input logic [4:0] gx_neg_i,  // of E01 E12 E23 E30 E20
    input logic [4:0] gy_neg_i,
    input logic [PAIRS-1:0] edge_i, triangle_i, negated_i, value_neg_i, value_zero_i,
    output logic [1:0] separated_o  // with what comes in this clock
);
  localparam logic [4*2-1:0] CORNERS = {4'b1101, 4'b0111};  // vertices of 023, of 012
  localparam logic [5*2-1:0] EDGES = {5'b11100, 5'b10011};

  // ---- Points at infinity: the direction is (gy, -gx) from a vertex in front of the eye ----------------------------
  logic [4:0] first_behind, crosses, left, up;
  assign first_behind = {w_neg_i[2], w_neg_i[3:0]};
  assign crosses = first_behind ^ {w_neg_i[0], w_neg_i[0], w_neg_i[3:1]};
  assign left = gy_neg_i ^ first_behind;
  assign up = ~gx_neg_i ^ first_behind;

  // ---- Vertices ----------------------------------------------------------------------------------------------------
  // all_q: every vertex so far is left of x0 (bit 0), above y0 (1), right of x1 (2), below y1 (3), or behind the eye.
  logic [1:0] by_side;
  logic [3:0] may, left_of, above;  // of vertices that come: behind the eye or on the near side

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    assign may[g] = side_i && vertex_i == 2'(g / PAIRS * PAIRS);
    assign left_of[g] = x_neg_i[g%PAIRS];
    assign above[g] = y_neg_i[g%PAIRS];
  end

  for (genvar t = 0; t < 2; t++) begin : gen_triangle
    logic [3:0] mine, refute_x, refute_y;  // vertices in front of the eye that are not outside
    logic [4:0] mine_crosses;
    logic [3:0] all_q;  // left of x0, above y0, right of x1, below y1: all vertices so far
    logic [3:0] infinity_q;
    assign mine = may & CORNERS[t*4+:4] & ~w_neg_i;
    assign refute_x = mine & (far_i ? left_of : ~left_of);
    assign refute_y = mine & (far_i ? above : ~above);
    assign mine_crosses = crosses & EDGES[t*5+:5];

    always_ff @(posedge clk_i) begin
      if (clear_i) begin
        all_q <= '1;
      end else begin
        all_q <= all_q & ~({{2{far_i}}, {2{!far_i}}} & {|refute_y, |refute_x, |refute_y, |refute_x});
      end
      infinity_q <= {
        (mine_crosses & up) == '0, (mine_crosses & left) == '0, (mine_crosses & ~up) == '0, (mine_crosses & ~left) == '0
      };
    end

    assign by_side[t] = (all_q & infinity_q) != '0;
  end

  // ---- Edges -------------------------------------------------------------------------------------------------------
  logic [PAIRS-1:0] outside;
  logic [1:0] by_edge_q, by_edge;
  assign outside = edge_i & ((negated_i & ~value_neg_i & ~value_zero_i) | (~negated_i & value_neg_i));
  assign by_edge = by_edge_q | {|(outside & triangle_i), |(outside & ~triangle_i)};

  always_ff @(posedge clk_i) by_edge_q <= clear_i ? '0 : by_edge;

  assign separated_o = by_side | by_edge;
endmodule
