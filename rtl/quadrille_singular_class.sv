// SPDX-License-Identifier: Apache-2.0
// Class of a pixel from the exact integers, in step with normalise: which corners or edges it lies on, whether an edge
// turns backward. Latency NORMALISE_STAGES, one pixel per clock.
//
// The result's register is written in clocks with active_i, else it holds. corner_o, one clock after the integers: the
// pixel is on a corner or more.
//
// class_o: quadrille_pkg::CLASS_* names its bits. notch: two neighbouring A have strictly opposite signs, and no
// override applies; it is for the fragment's flag alone.
module quadrille_singular_class #(
    localparam int VAL = quadrille_pkg::VAL_BITS, QVAL = quadrille_pkg::QVAL_BITS, CLASS = quadrille_pkg::CLASS_BITS
) (
    input logic clk_i, active_i,
    input logic [4*VAL-1:0] a_i,
    input logic [4*QVAL-1:0] d_i, r2_i,
    output logic corner_o,
    output logic [CLASS-1:0] class_o
);
  // Stage 1: signs.
  logic [3:0] a_neg_d, a_pos_d, corner_d, edge_d, a_neg_q, a_pos_q, corner_q, edge_q;

  for (genvar g = 0; g < 4; g++) begin : gen_sign
    logic a_zero;
    assign a_zero = a_i[g*VAL+:VAL] == '0;
    assign a_neg_d[g] = a_i[g*VAL+VAL-1];
    assign a_pos_d[g] = !a_neg_d[g] && !a_zero;
    assign corner_d[g] = r2_i[g*QVAL+QVAL-1] || r2_i[g*QVAL+:QVAL] == '0;
    assign edge_d[g] = a_zero && d_i[g*QVAL+QVAL-1];
  end

  always_ff @(posedge clk_i) begin
    a_neg_q <= a_neg_d;
    a_pos_q <= a_pos_d;
    corner_q <= corner_d;
    edge_q <= edge_d;
  end

  // Stage 2: priority.
  logic any_corner, many_corners, any_edge, many_edges, two_corner, on_vertex, two_edge, on_edge, notch;
  logic [3:0] concerned;
  logic [2:1] others;  // inner ones, without the lowest
  logic [3:0] differ;
  logic [1:0] first, second;
  assign any_corner = corner_q != 4'd0;
  assign many_corners = (corner_q & (corner_q - 4'd1)) != 4'd0;
  assign any_edge = edge_q != 4'd0;
  assign many_edges = (edge_q & (edge_q - 4'd1)) != 4'd0;
  assign corner_o = two_corner || on_vertex;
  assign two_corner = many_corners;
  assign on_vertex = any_corner && !many_corners;
  assign two_edge = !any_corner && many_edges;
  assign on_edge = !any_corner && any_edge && !many_edges;
  assign differ = ({a_neg_q[2:0], a_neg_q[3]} & a_pos_q) | ({a_pos_q[2:0], a_pos_q[3]} & a_neg_q);
  assign notch = quadrille_pkg::NOTCH_EXACT != 0 && differ != 4'd0 && !two_corner && !on_vertex && !two_edge;
  assign concerned = any_corner ? corner_q : edge_q;
  assign others = 2'((concerned & (concerned - 4'd1)) >> 1);
  assign first = concerned[0] ? 2'd0 : concerned[1] ? 2'd1 : concerned[2] ? 2'd2 : 2'd3;
  assign second = others[1] ? 2'd1 : others[2] ? 2'd2 : 2'd3;

  logic [CLASS-1:0] word, late_word;
  assign word[quadrille_pkg::CLASS_TWO_CORNER] = two_corner;
  assign word[quadrille_pkg::CLASS_ON_VERTEX] = on_vertex;
  assign word[quadrille_pkg::CLASS_TWO_EDGE] = two_edge;
  assign word[quadrille_pkg::CLASS_ON_EDGE] = on_edge;
  assign word[quadrille_pkg::CLASS_NOTCH] = notch;
  assign word[quadrille_pkg::CLASS_FIRST+:2] = first;
  assign word[quadrille_pkg::CLASS_SECOND+:2] = second;

  quadrille_delay_line #(.WIDTH(CLASS), .DEPTH(quadrille_pkg::NORMALISE_STAGES - 2)) u_delay (
      .clk_i, .data_i(word), .data_o(late_word)
  );

  always_ff @(posedge clk_i) if (active_i) class_o <= late_word;
endmodule
