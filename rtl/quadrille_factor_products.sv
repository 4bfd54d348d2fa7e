// SPDX-License-Identifier: Apache-2.0
// M_i = x y z of the four corners; of the corner on both of two neighbouring edges the sum of two products x y instead,
// its own and that in the place of the corner opposite, which becomes 0 (weight_factors). Of a plane_quad's pixel z is
// M: it goes around the multipliers, whose operands are held. Latency PRODUCT_STAGES + FP_ADD_STAGES + 1, one pixel per
// clock. Numbers are {exp, sig}.
module quadrille_factor_products #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, CLASS = quadrille_pkg::CLASS_BITS,
    localparam int F = E + S
) (
    input logic clk_i,
    input logic [CLASS-1:0] class_i,  // PRODUCT_STAGES after the factors
    input logic area_i,  // z is M; x and y are those of the clock before
    input logic [4*F-1:0] x_i, y_i, z_i,
    output logic [4*E-1:0] m_exp_o,
    output logic [4*S-1:0] m_sig_o
);
  // ---- Products -----------------------------------------------------------------------------------------------------
  logic [4*F-1:0] xy, late_z, xyz, weight, late_weight;

  for (genvar g = 0; g < 4; g++) begin : gen_product
    quadrille_fp_multiply u_xy (
        .clk_i, .a_exp_i(x_i[g*F+S+:E]), .a_sig_i(x_i[g*F+:S]), .b_exp_i(y_i[g*F+S+:E]), .b_sig_i(y_i[g*F+:S]),
        .exp_o(xy[g*F+S+:E]), .sig_o(xy[g*F+:S])
    );
    quadrille_fp_multiply u_xyz (
        .clk_i, .a_exp_i(xy[g*F+S+:E]), .a_sig_i(xy[g*F+:S]), .b_exp_i(late_z[g*F+S+:E]), .b_sig_i(late_z[g*F+:S]),
        .exp_o(xyz[g*F+S+:E]), .sig_o(xyz[g*F+:S])
    );
  end

  if (quadrille_pkg::PLANE_QUADS != 0) begin : gen_area
    // A product takes a clock: z waits for xy, or beside both products.
    logic [1:0] area_q;
    logic [4*F-1:0] weight_q1, weight_q2;

    always_ff @(posedge clk_i) begin
      if (area_i) weight_q1 <= z_i;
      else late_z <= z_i;
      weight_q2 <= weight_q1;
      area_q <= {area_q[0], area_i};
    end

    assign weight = area_q[1] ? weight_q2 : xyz;
  end else begin : gen_no_area
    logic unused_area;
    assign unused_area = area_i;
    assign weight = xyz;

    quadrille_delay_line #(.WIDTH(4 * F), .DEPTH(quadrille_pkg::PRODUCT_STAGES)) u_delay_z (
        .clk_i, .data_i(z_i), .data_o(late_z)
    );
  end

  quadrille_delay_line #(.WIDTH(4 * F), .DEPTH(quadrille_pkg::FP_ADD_STAGES -
      quadrille_pkg::PRODUCT_STAGES)) u_delay_weight (
      .clk_i, .data_i(weight), .data_o(late_weight)
  );

  // ---- The corner on both of two neighbouring edges ----------------------------------------------------------------
  logic [1:0] first, second;
  logic neighbours, late_neighbours;  // two edges with a corner in common
  logic [1:0] corner, late_corner;  // which
  logic [F-1:0] own, opposite, both;
  assign first = class_i[quadrille_pkg::CLASS_FIRST+:2];
  assign second = class_i[quadrille_pkg::CLASS_SECOND+:2];
  assign neighbours = class_i[quadrille_pkg::CLASS_TWO_EDGE] && first[0] != second[0];
  assign corner = (first == 2'd0 && second == 2'd3) ? 2'd0 : second;

  quadrille_one_of_four #(.WIDTH(F)) u_own (.words_i(xy), .index_i(corner), .word_o(own));
  quadrille_one_of_four #(.WIDTH(F)) u_opposite (.words_i(xy), .index_i(corner + 2'd2), .word_o(opposite));

  quadrille_fp_add u_both (
      .clk_i, .a_rank_i(quadrille_pkg::exponent_rank(own[S+:E], own[S-1])),
      .a_term_i(quadrille_pkg::lone_term(own[0+:S])),
      .b_rank_i(quadrille_pkg::exponent_rank(opposite[S+:E], opposite[S-1])),
      .b_term_i(quadrille_pkg::lone_term(opposite[0+:S])), .exp_o(both[S+:E]), .sig_o(both[0+:S])
  );

  quadrille_delay_line #(.WIDTH(3), .DEPTH(quadrille_pkg::FP_ADD_STAGES)) u_delay_corner (
      .clk_i, .data_i({neighbours, corner}), .data_o({late_neighbours, late_corner})
  );

  // ---- Which of both is M ------------------------------------------------------------------------------------------
  for (genvar g = 0; g < 4; g++) begin : gen_weight
    logic [F-1:0] m_q;

    always_ff @(posedge clk_i) begin
      m_q <= late_weight[g*F+:F];
      if (late_neighbours && late_corner == 2'(g)) m_q <= both;
      if (late_neighbours && late_corner == 2'((g + 2) % 4)) m_q <= '0;
    end

    assign {m_exp_o[g*E+:E], m_sig_o[g*S+:S]} = m_q;
  end

  logic unused;
  assign unused = ^{class_i[quadrille_pkg::CLASS_BITS-1:quadrille_pkg::CLASS_TWO_EDGE+1],
      class_i[quadrille_pkg::CLASS_TWO_EDGE-1:quadrille_pkg::CLASS_FIRST+2]};
endmodule
