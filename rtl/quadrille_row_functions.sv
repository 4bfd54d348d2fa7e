// SPDX-License-Identifier: Apache-2.0
// What the pixels of a clock have in common: value + r gy of all functions in their row r of their tile, exact modulo 2^bits.
// Latency FORWARD_DIFFERENCE_ROW_STAGES; gx and q wait beside it for each lane's forward_difference_column.
//
// Two's complement throughout; r comes as its radix4_digits.
module quadrille_row_functions #(
    localparam int OFFSET_DIGITS = quadrille_pkg::TILE_LOG2 / 2 + 1,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int QCURV = quadrille_pkg::QCURV_BITS
) (
    input logic clk_i,
    input logic [2*OFFSET_DIGITS-1:0] row_digits_i,
    input logic [6*VAL-1:0] lin_value_i,
    input logic [6*GRAD-1:0] lin_gx_i,
    input logic [6*GRAD-1:0] lin_gy_i,
    input logic [4*QVAL-1:0] quad_value_i,
    input logic [4*QGRAD-1:0] quad_gx_i,
    input logic [4*QGRAD-1:0] quad_gy_i,
    input logic [4*QCURV-1:0] quad_q_i,
    output logic [6*VAL-1:0] lin_row_o,
    output logic [6*GRAD-1:0] lin_gx_o,
    output logic [4*QVAL-1:0] quad_row_o,
    output logic [4*QGRAD-1:0] quad_gx_o,
    output logic [4*QCURV-1:0] quad_q_o
);
  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic unused;

    quadrille_forward_difference_row #(
        .VALUE_BITS(VAL),
        .GRAD_BITS(GRAD)
    ) u_row (
        .clk_i,
        .row_digits_i,
        .value_i(lin_value_i[g*VAL+:VAL]),
        .gx_i(lin_gx_i[g*GRAD+:GRAD]),
        .gy_i(lin_gy_i[g*GRAD+:GRAD]),
        .q_i(1'b0),
        .row_o(lin_row_o[g*VAL+:VAL]),
        .gx_o(lin_gx_o[g*GRAD+:GRAD]),
        .q_o(unused)
    );
  end

  for (genvar g = 0; g < 4; g++) begin : gen_quadratic
    quadrille_forward_difference_row #(
        .VALUE_BITS(QVAL),
        .GRAD_BITS(QGRAD),
        .CURV_BITS(QCURV)
    ) u_row (
        .clk_i,
        .row_digits_i,
        .value_i(quad_value_i[g*QVAL+:QVAL]),
        .gx_i(quad_gx_i[g*QGRAD+:QGRAD]),
        .gy_i(quad_gy_i[g*QGRAD+:QGRAD]),
        .q_i(quad_q_i[g*QCURV+:QCURV]),
        .row_o(quad_row_o[g*QVAL+:QVAL]),
        .gx_o(quad_gx_o[g*QGRAD+:QGRAD]),
        .q_o(quad_q_o[g*QCURV+:QCURV])
    );
  end
endmodule
