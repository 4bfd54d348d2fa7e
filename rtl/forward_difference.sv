// One function of the pixel position from the context of its tile: value + r gy + dx gx + q (r^2 + dx^2). Exact modulo 2^VALUE_BITS.
// Latency FORWARD_DIFFERENCE_STAGES, one pixel a clock: the row; the column, and beside it the bend q (r^2 + dx^2); their sum.
//
// Two's complement throughout; r, dx and r^2 + dx^2 come as offset_digits, the last one clock after all the rest. A linear function
// (QUADRATIC = 0) has no bend: it reads neither q_i nor norm_digits_i.
module forward_difference #(
    parameter int VALUE_BITS = 64,
    parameter int GRAD_BITS = 48,
    parameter int CURV_BITS = 1,
    parameter bit QUADRATIC = 1'b1,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int NORM_BITS = 2 * TILE_LOG2 + 1,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1,
    localparam int NORM_DIGITS = NORM_BITS / 2 + 1
) (
    input logic clk_i,
    input logic [2*OFFSET_DIGITS-1:0] row_digits_i,
    input logic [2*OFFSET_DIGITS-1:0] dx_digits_i,
    input logic [2*NORM_DIGITS-1:0] norm_digits_i,
    input logic [VALUE_BITS-1:0] value_i,
    input logic [GRAD_BITS-1:0] gx_i,
    input logic [GRAD_BITS-1:0] gy_i,
    input logic [CURV_BITS-1:0] q_i,
    output logic [VALUE_BITS-1:0] value_o
);
  localparam int RISE_BITS = GRAD_BITS + TILE_LOG2;
  localparam int BEND_BITS = CURV_BITS + NORM_BITS;

  // ---- Stage 1: row. {a, 1} + {b, carry} is an adder whose carry-in is used -------------------------------------------------
  logic [2*OFFSET_DIGITS-1:0] dx_digits_q;
  logic [RISE_BITS-1:0] rise_y, rise_x;
  logic carry_y, carry_x;
  logic [VALUE_BITS-1:0] row_d, row_q;
  logic [GRAD_BITS-1:0] gx_q;

  small_multiply #(
      .FACTOR_BITS(GRAD_BITS),
      .NUMBER_BITS(TILE_LOG2)
  ) u_rise_y (
      .factor_i(gy_i),
      .digits_i(row_digits_i),
      .product_o(rise_y),
      .carry_o(carry_y)
  );

  assign row_d = VALUE_BITS'(({value_i, 1'b1} + {VALUE_BITS'($signed(rise_y)), carry_y}) >> 1);

  always_ff @(posedge clk_i) begin
    row_q <= row_d;
    gx_q <= gx_i;
    dx_digits_q <= dx_digits_i;
  end

  // ---- Stage 2: column ------------------------------------------------------------------------------------------------------
  logic [VALUE_BITS-1:0] column_d, column_q;

  small_multiply #(
      .FACTOR_BITS(GRAD_BITS),
      .NUMBER_BITS(TILE_LOG2)
  ) u_rise_x (
      .factor_i(gx_q),
      .digits_i(dx_digits_q),
      .product_o(rise_x),
      .carry_o(carry_x)
  );

  assign column_d = VALUE_BITS'(({row_q, 1'b1} + {VALUE_BITS'($signed(rise_x)), carry_x}) >> 1);

  always_ff @(posedge clk_i) column_q <= column_d;

  // ---- Stage 2, bend; stage 3, sum --------------------------------------------------------------------------------------------
  logic [VALUE_BITS-1:0] bent;

  if (QUADRATIC) begin : gen_bend
    logic [CURV_BITS-1:0] q_q;
    logic [BEND_BITS-1:0] bend_d, bend_q;
    logic carry_d, carry_q;

    small_multiply #(
        .FACTOR_BITS(CURV_BITS),
        .NUMBER_BITS(NORM_BITS)
    ) u_bend (
        .factor_i(q_q),
        .digits_i(norm_digits_i),
        .product_o(bend_d),
        .carry_o(carry_d)
    );

    always_ff @(posedge clk_i) begin
      q_q <= q_i;
      bend_q <= bend_d;
      carry_q <= carry_d;
    end

    assign bent = VALUE_BITS'(({column_q, 1'b1} + {VALUE_BITS'($signed(bend_q)), carry_q}) >> 1);
  end else begin : gen_no_bend
    logic unused;
    assign unused = ^{q_i, norm_digits_i};
    assign bent = column_q;
  end

  always_ff @(posedge clk_i) value_o <= bent;
endmodule
