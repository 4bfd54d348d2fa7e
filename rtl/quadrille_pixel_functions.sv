// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// The exact functions of a pixel: A of six pairs of corners, D of the same, r2 of four corners. Latency from the pixel
// DIFF_STAGE + 1, from its row a clock less.
module quadrille_pixel_functions #(
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1,
    localparam int NORM_DIGITS = (2 * TILE_LOG2 + 1) / 2 + 1,
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS, QCURV = quadrille_pkg::QCURV_BITS,
    localparam int LENGTH2 = quadrille_pkg::LENGTH2_BITS
) (
    input logic clk_i,
    input logic [TILE_LOG2-1:0] row_i, dx_i,
    input logic [quadrille_pkg::ROW_BITS-1:0] line_i,  // a clock later
    // In step with the functions' values; a clock later squares_i, the last part of a homogeneous pixel, and length2_i
    input logic [1:0] part_i,
    input logic squares_i,
    input logic [6*LENGTH2-1:0] length2_i,
    output logic [6*VAL-1:0] a_o,
    output logic [6*QVAL-1:0] d_o,
    output logic [4*QVAL-1:0] r2_o
);
  `QUADRILLE_IN(`QUADRILLE_ROW_T, line)

  logic [6*VAL-1:0] a;
  logic [4*QVAL-1:0] quad;  // four quadratic functions of one part
  logic [2*OFFSET_DIGITS-1:0] dx_digits;
  logic [2*NORM_DIGITS-1:0] norm_digits;
  quadrille_offset_digits u_offset (.clk_i, .row_i, .dx_i, .dx_digits_o(dx_digits), .norm_digits_o(norm_digits));

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    quadrille_forward_difference_column #(.VALUE_BITS(VAL), .GRAD_BITS(GRAD), .QUADRATIC(1'b0)) u_column (
        .clk_i, .dx_digits_i(dx_digits), .norm_digits_i(norm_digits), .row_i(line.lin_value[g*VAL+:VAL]),
        .gx_i(line.lin_gx[g*GRAD+:GRAD]), .q_i(1'b0), .value_o(a[g*VAL+:VAL])
    );
  end

  for (genvar g = 0; g < 4; g++) begin : gen_quadratic
    quadrille_forward_difference_column #(.VALUE_BITS(QVAL), .GRAD_BITS(QGRAD), .CURV_BITS(QCURV)) u_column (
        .clk_i, .dx_digits_i(dx_digits), .norm_digits_i(norm_digits), .row_i(line.quad_value[g*QVAL+:QVAL]),
        .gx_i(line.quad_gx[g*QGRAD+:QGRAD]), .q_i(line.quad_q[g*QCURV+:QCURV]), .value_o(quad[g*QVAL+:QVAL])
    );
  end

  // The dot products: of an ordinary quad from the squared distances, of a homogeneous one those of the parts before.
  // Both come to law_of_cosines a clock after the squared distances.
  logic [6*QVAL-1:0] dot_q;

  always_ff @(posedge clk_i) begin
    if (part_i == quadrille_pkg::PART_EDGES) dot_q[0+:4*QVAL] <= quad;
    if (part_i == quadrille_pkg::PART_DIAGONALS) dot_q[4*QVAL+:2*QVAL] <= quad[0+:2*QVAL];
  end

  for (genvar g = 0; g < 6; g++) begin : gen_dot
    localparam int I = {30'd0, quadrille_pkg::pair_first(4'(g))}, J = {30'd0, quadrille_pkg::pair_second(4'(g))};
    quadrille_law_of_cosines u_dot (
        .clk_i, .r2_first_i(quad[I*QVAL+:QVAL]), .r2_second_i(quad[J*QVAL+:QVAL]), .homogeneous_i(squares_i),
        .exact_i(dot_q[g*QVAL+:QVAL]), .length2_i(length2_i[g*LENGTH2+:LENGTH2]), .d_o(d_o[g*QVAL+:QVAL])
    );
  end

  quadrille_delay_line #(.WIDTH(6 * VAL + 4 * QVAL), .DEPTH(quadrille_pkg::LAW_OF_COSINES_STAGES)) u_diff (
      .clk_i, .data_i({a, quad}), .data_o({a_o, r2_o})
  );

endmodule
