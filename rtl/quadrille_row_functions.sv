// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// What the pixels of a clock have in common: value + r gy of all functions in their row r of their tile, exact modulo
// 2^bits. Latency FORWARD_DIFFERENCE_ROW_STAGES; gx and q wait beside it for each lane's forward_difference_column.
//
// Two's complement throughout; r comes as its radix4_digits.
module quadrille_row_functions #(
    localparam int VAL = quadrille_pkg::VAL_BITS, GRAD = quadrille_pkg::GRAD_BITS, QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS, QCURV = quadrille_pkg::QCURV_BITS
) (
    input logic clk_i,
    input logic [quadrille_pkg::ROW_DIGIT_BITS-1:0] row_digits_i,
    input logic [quadrille_pkg::CONTEXT_BITS-1:0] tile_i,
    input logic [6*GRAD-1:0] gx_i,  // of the linear functions
    input logic [6*GRAD-1:0] gy_i,
    output logic [quadrille_pkg::ROW_BITS-1:0] row_o
);
  `QUADRILLE_IN(`QUADRILLE_CONTEXT_T, tile)
  logic [6*VAL-1:0] lin_row;
  logic [6*GRAD-1:0] lin_gx;
  logic [4*QVAL-1:0] quad_row;
  logic [4*QGRAD-1:0] quad_gx;
  logic [4*QCURV-1:0] quad_q;
  assign row_o = {lin_row, lin_gx, quad_row, quad_gx, quad_q};

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic unused;
    quadrille_forward_difference_row #(.VALUE_BITS(VAL), .GRAD_BITS(GRAD)) u_row (
        .clk_i, .row_digits_i, .value_i(tile.lin_value[g*VAL+:VAL]), .gx_i(gx_i[g*GRAD+:GRAD]),
        .gy_i(gy_i[g*GRAD+:GRAD]), .q_i(1'b0), .row_o(lin_row[g*VAL+:VAL]), .gx_o(lin_gx[g*GRAD+:GRAD]), .q_o(unused)
    );
  end

  for (genvar g = 0; g < 4; g++) begin : gen_quadratic
    quadrille_forward_difference_row #(.VALUE_BITS(QVAL), .GRAD_BITS(QGRAD), .CURV_BITS(QCURV)) u_row (
        .clk_i, .row_digits_i, .value_i(tile.quad_value[g*QVAL+:QVAL]), .gx_i(tile.quad_gx[g*QGRAD+:QGRAD]),
        .gy_i(tile.quad_gy[g*QGRAD+:QGRAD]), .q_i(tile.quad_q[g*QCURV+:QCURV]), .row_o(quad_row[g*QVAL+:QVAL]),
        .gx_o(quad_gx[g*QGRAD+:QGRAD]), .q_o(quad_q[g*QCURV+:QCURV])
    );
  end
endmodule
