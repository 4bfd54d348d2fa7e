// SPDX-License-Identifier: Apache-2.0
// The factors x, y, z of the weights M_i = x y z: of a regular pixel from the three ratios a, b, c = num / den, of a
// singular one what stands for them. Latency 1, one pixel per clock.
//
// regular      M_0 : M_1 : M_2 : M_3 = abc : a : c : b, each times the three denominators two corners  |k| of the other
// one, the rest 0 on a vertex  1, the rest 0 plane_quad   z is the weight, the area opposite the corner, which comes in
// the place of r (area_i); x and y are held two edges    r of an edge's other end, and the other edge's denominator N;
// see gen_corner for the corner that is on both
//
// Numbers are {exp, sig}, magnitudes all.
module quadrille_weight_factors #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int CLASS = quadrille_pkg::CLASS_BITS, F = E + S
) (
    input logic clk_i,
    input logic [CLASS-1:0] class_i,
    input logic area_i,
    input logic [3*F-1:0] num_i, den_i,
    input logic [4*F-1:0] root_i,
    input logic [2*F-1:0] edge_n_i,  // of the first edge, of the second
    input logic [4*PE-1:0] k_exp_i,
    input logic [4*S-1:0] k_sig_i,
    output logic [4*F-1:0] x_o, y_o, z_o
);
  localparam logic [F-1:0] ONE = {E'(0), 1'b1, (S - 1)'(0)};

  logic two_corner, on_vertex, two_edge;
  logic [1:0] first, second;
  logic [4*F-1:0] k;
  logic [F-1:0] first_k, second_k;  // of the two corners
  assign two_corner = class_i[quadrille_pkg::CLASS_TWO_CORNER];
  assign on_vertex = class_i[quadrille_pkg::CLASS_ON_VERTEX];
  assign two_edge = class_i[quadrille_pkg::CLASS_TWO_EDGE];
  assign first = class_i[quadrille_pkg::CLASS_FIRST+:2];
  assign second = class_i[quadrille_pkg::CLASS_SECOND+:2];

  for (genvar g = 0; g < 4; g++) begin : gen_k
    assign k[g*F+:F] = {E'($signed(k_exp_i[g*PE+:PE])), k_sig_i[g*S+:S]};
  end

  quadrille_one_of_four #(.WIDTH(F)) u_first_k (.words_i(k), .index_i(first), .word_o(first_k));
  quadrille_one_of_four #(.WIDTH(F)) u_second_k (.words_i(k), .index_i(second), .word_o(second_k));

  for (genvar g = 0; g < 4; g++) begin : gen_corner
    localparam int P = (g + 3) % 4, Q = (g + 1) % 4;

    logic is_first, is_second;  // corner g is the first, second singular corner
    logic own_edge, edge_before;  // edge g, edge g-1 is one of the two
    logic n_of_first;  // the denominator for corner g is the first edge's
    logic [F-1:0] x_d, y_d, z_d;
    assign is_first = first == 2'(g);
    assign is_second = second == 2'(g);
    assign own_edge = is_first || is_second;
    assign edge_before = first == 2'(P) || second == 2'(P);
    // On one of the edges: the other's. On both: that of edge g, with r of corner g-1; the other term is formed in the
    // place of corner g+2, which is on neither and takes the denominator of edge g+1, with r of its corner before.
    assign n_of_first = (own_edge == edge_before) ? first == (own_edge ? 2'(g) : 2'(Q)) : second == 2'(g) ||
        second == 2'(P);

    always_comb begin
      x_d = (g < 2) ? num_i[0+:F] : den_i[0+:F];
      y_d = (g == 0 || g == 3) ? num_i[F+:F] : den_i[F+:F];
      z_d = (g % 2 == 0) ? num_i[2*F+:F] : den_i[2*F+:F];
      if (two_corner) x_d = is_first ? second_k : is_second ? first_k : '0;
      if (on_vertex) x_d = is_first ? ONE : '0;
      if (two_edge) x_d = (own_edge && !edge_before) ? root_i[Q*F+:F] : root_i[P*F+:F];
      if (two_edge) y_d = n_of_first ? edge_n_i[0+:F] : edge_n_i[F+:F];
      if (two_corner || on_vertex) y_d = ONE;
      if (two_corner || on_vertex || two_edge) z_d = ONE;
      if (area_i) z_d = root_i[g*F+:F];
    end

    always_ff @(posedge clk_i) begin
      if (!area_i) begin
        x_o[g*F+:F] <= x_d;
        y_o[g*F+:F] <= y_d;
      end
      z_o[g*F+:F] <= z_d;
    end
  end

  logic unused;
  assign unused = ^class_i[quadrille_pkg::CLASS_ON_EDGE:quadrille_pkg::CLASS_NOTCH];
endmodule
