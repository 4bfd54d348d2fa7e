// SPDX-License-Identifier: Apache-2.0
// The two vertices of a function, of quad_setup or tile_context (quadrille_pkg: pair_first, pair_second).
// Combinational.
module quadrille_setup_pair #(
    localparam int T = quadrille_pkg::T_BITS, W = quadrille_pkg::W_BITS
) (
    input logic [3:0] function_i,
    input logic [4*T-1:0] x_i, y_i,
    input logic [4*W-1:0] w_i,
    output logic [T-1:0] xi_o, yi_o,
    output logic [W-1:0] wi_o,
    output logic [T-1:0] xj_o, yj_o,
    output logic [W-1:0] wj_o
);
  localparam int VERTEX = 2 * T + W;
  logic [4*VERTEX-1:0] vertices;

  for (genvar g = 0; g < 4; g++) begin : gen_vertex
    assign vertices[g*VERTEX+:VERTEX] = {x_i[g*T+:T], y_i[g*T+:T], w_i[g*W+:W]};
  end

  quadrille_one_of_four #(.WIDTH(VERTEX)) u_first (
      .words_i(vertices), .index_i(quadrille_pkg::pair_first(function_i)), .word_o({xi_o, yi_o, wi_o})
  );

  quadrille_one_of_four #(.WIDTH(VERTEX)) u_second (
      .words_i(vertices), .index_i(quadrille_pkg::pair_second(function_i)), .word_o({xj_o, yj_o, wj_o})
  );
endmodule
