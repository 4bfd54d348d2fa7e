// SPDX-License-Identifier: Apache-2.0
// The first half of a forward difference, which all pixels of a row of a tile have in common: value + r gy, exact
// modulo 2^VALUE_BITS. Latency FORWARD_DIFFERENCE_ROW_STAGES; gx and q wait beside it for forward_difference_column.
//
// Two's complement throughout; r comes as its radix4_digits.
module quadrille_forward_difference_row #(
    parameter int VALUE_BITS = 64,
    parameter int GRAD_BITS = 48,
    parameter int CURV_BITS = 1,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1
) (
    input logic clk_i,
    input logic [2*OFFSET_DIGITS-1:0] row_digits_i,
    input logic [VALUE_BITS-1:0] value_i,
    input logic [GRAD_BITS-1:0] gx_i, gy_i,
    input logic [CURV_BITS-1:0] q_i,
    output logic [VALUE_BITS-1:0] row_o,
    output logic [GRAD_BITS-1:0] gx_o,
    output logic [CURV_BITS-1:0] q_o
);
  logic [GRAD_BITS+TILE_LOG2-1:0] rise;
  logic carry;
  logic [VALUE_BITS-1:0] row;
  quadrille_small_multiply #(.FACTOR_BITS(GRAD_BITS), .NUMBER_BITS(TILE_LOG2)) u_rise (
      .factor_i(gy_i), .digits_i(row_digits_i), .product_o(rise), .carry_o(carry)
  );

  // {a, 1} + {b, carry} is an adder whose carry-in is used.
  assign row = VALUE_BITS'(({value_i, 1'b1} + {VALUE_BITS'($signed(rise)), carry}) >> 1);

  always_ff @(posedge clk_i) begin
    row_o <= row;
    gx_o <= gx_i;
    q_o <= q_i;
  end
endmodule
