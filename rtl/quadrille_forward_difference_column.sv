// SPDX-License-Identifier: Apache-2.0
// The second half of a forward difference, a pixel's own: row + dx gx + q (r^2 + dx^2), exact modulo 2^VALUE_BITS, with
// what forward_difference_row gives. Latency FORWARD_DIFFERENCE_COLUMN_STAGES, one pixel a clock: the column, and
// beside it the bend q (r^2 + dx^2); their sum.
//
// The digits of dx come a clock before the row; their register is here, since one that ten functions shared would cost
// the time to drive them. Two's complement throughout; dx and r^2 + dx^2 come as offset_digits. A linear function
// (QUADRATIC = 0) has no bend: it reads neither q_i nor norm_digits_i.
module quadrille_forward_difference_column #(
    parameter int VALUE_BITS = 64,
    parameter int GRAD_BITS = 48,
    parameter int CURV_BITS = 1,
    parameter bit QUADRATIC = 1'b1,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2, NORM_BITS = 2 * TILE_LOG2 + 1,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1,
    localparam int NORM_DIGITS = NORM_BITS / 2 + 1
) (
    input logic clk_i,
    input logic [2*OFFSET_DIGITS-1:0] dx_digits_i,
    input logic [2*NORM_DIGITS-1:0] norm_digits_i,
    input logic [VALUE_BITS-1:0] row_i,
    input logic [GRAD_BITS-1:0] gx_i,
    input logic [CURV_BITS-1:0] q_i,
    output logic [VALUE_BITS-1:0] value_o
);
  localparam int BEND_BITS = CURV_BITS + NORM_BITS;

  // ---- Column. {a, 1} + {b, carry} is an adder whose carry-in is used ----------------------------------------------
  logic [GRAD_BITS+TILE_LOG2-1:0] rise;
  logic carry;
  logic [VALUE_BITS-1:0] column_d, column_q;
  logic [2*OFFSET_DIGITS-1:0] dx_digits_q;

  always_ff @(posedge clk_i) dx_digits_q <= dx_digits_i;

  quadrille_small_multiply #(.FACTOR_BITS(GRAD_BITS), .NUMBER_BITS(TILE_LOG2)) u_rise (
      .factor_i(gx_i), .digits_i(dx_digits_q), .product_o(rise), .carry_o(carry)
  );

  assign column_d = VALUE_BITS'(({row_i, 1'b1} + {VALUE_BITS'($signed(rise)), carry}) >> 1);

  always_ff @(posedge clk_i) column_q <= column_d;

  // ---- Beside it the bend; then their sum --------------------------------------------------------------------------
  logic [VALUE_BITS-1:0] bent;

  if (QUADRATIC) begin : gen_bend
    logic [BEND_BITS-1:0] bend_d, bend_q;
    logic bend_carry_d, bend_carry_q;
    quadrille_small_multiply #(.FACTOR_BITS(CURV_BITS), .NUMBER_BITS(NORM_BITS)) u_bend (
        .factor_i(q_i), .digits_i(norm_digits_i), .product_o(bend_d), .carry_o(bend_carry_d)
    );

    always_ff @(posedge clk_i) begin
      bend_q <= bend_d;
      bend_carry_q <= bend_carry_d;
    end

    assign bent = VALUE_BITS'(({column_q, 1'b1} + {VALUE_BITS'($signed(bend_q)), bend_carry_q}) >> 1);
  end else begin : gen_no_bend
    logic unused;
    assign unused = ^{q_i, norm_digits_i};
    assign bent = column_q;
  end

  always_ff @(posedge clk_i) value_o <= bent;
endmodule
