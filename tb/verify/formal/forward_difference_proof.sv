// forward_difference_row and _column give value + r gy + dx gx + q (r^2 + dx^2) modulo 2^VALUE_BITS, for all operands, where the products are
// what small_multiply makes of the digits of r, dx and r^2 + dx^2: with the proofs small_multiply_*, direct evaluation.
module forward_difference_proof #(
    parameter int VALUE_BITS = 63,
    parameter int GRAD_BITS = 48,
    parameter int CURV_BITS = 32,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int NORM_BITS = 2 * TILE_LOG2 + 1,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1,
    localparam int NORM_DIGITS = NORM_BITS / 2 + 1
) (
    input logic clk_i,
    input logic [TILE_LOG2-1:0] row_i,
    input logic [TILE_LOG2-1:0] dx_i,
    input logic [VALUE_BITS-1:0] value_i,
    input logic [GRAD_BITS-1:0] gx_i,
    input logic [GRAD_BITS-1:0] gy_i,
    input logic [CURV_BITS-1:0] q_i
);
  logic [2*OFFSET_DIGITS-1:0] row_digits, dx_digits;
  logic [2*NORM_DIGITS-1:0] norm_digits;
  logic [VALUE_BITS-1:0] row, value;
  logic [GRAD_BITS-1:0] gx;
  logic [CURV_BITS-1:0] q;

  quadrille_radix4_digits #(.NUMBER_BITS(TILE_LOG2)) u_row_digits (
      .number_i(row_i),
      .digits_o(row_digits)
  );

  quadrille_offset_digits u_offset (
      .clk_i,
      .row_i,
      .dx_i,
      .dx_digits_o(dx_digits),
      .norm_digits_o(norm_digits)
  );

  quadrille_forward_difference_row #(
      .VALUE_BITS(VALUE_BITS),
      .GRAD_BITS(GRAD_BITS),
      .CURV_BITS(CURV_BITS)
  ) u_row (
      .clk_i,
      .row_digits_i(row_digits),
      .value_i,
      .gx_i,
      .gy_i,
      .q_i,
      .row_o(row),
      .gx_o(gx),
      .q_o(q)
  );

  quadrille_forward_difference_column #(
      .VALUE_BITS(VALUE_BITS),
      .GRAD_BITS(GRAD_BITS),
      .CURV_BITS(CURV_BITS)
  ) u_column (
      .clk_i,
      .dx_digits_i(dx_digits),
      .norm_digits_i(norm_digits),
      .row_i(row),
      .gx_i(gx),
      .q_i(q),
      .value_o(value)
  );

  // The three products, from numbers of this file's own.
  logic [NORM_BITS-1:0] norm;
  logic signed [GRAD_BITS+TILE_LOG2-1:0] row_product, column_product;
  logic signed [CURV_BITS+NORM_BITS-1:0] bend_product;
  logic row_carry, column_carry, bend_carry;
  logic [2*OFFSET_DIGITS-1:0] column_digits;
  logic [2*NORM_DIGITS-1:0] bend_digits;

  assign norm = NORM_BITS'(row_i) * NORM_BITS'(row_i) + NORM_BITS'(dx_i) * NORM_BITS'(dx_i);

  quadrille_radix4_digits #(.NUMBER_BITS(TILE_LOG2)) u_column_digits (
      .number_i(dx_i),
      .digits_o(column_digits)
  );
  quadrille_radix4_digits #(.NUMBER_BITS(NORM_BITS)) u_bend_digits (
      .number_i(norm),
      .digits_o(bend_digits)
  );
  quadrille_small_multiply #(.FACTOR_BITS(GRAD_BITS), .NUMBER_BITS(TILE_LOG2)) u_row_product (
      .factor_i(gy_i),
      .digits_i(row_digits),
      .product_o(row_product),
      .carry_o(row_carry)
  );
  quadrille_small_multiply #(.FACTOR_BITS(GRAD_BITS), .NUMBER_BITS(TILE_LOG2)) u_column_product (
      .factor_i(gx_i),
      .digits_i(column_digits),
      .product_o(column_product),
      .carry_o(column_carry)
  );
  quadrille_small_multiply #(.FACTOR_BITS(CURV_BITS), .NUMBER_BITS(NORM_BITS)) u_bend_product (
      .factor_i(q_i),
      .digits_i(bend_digits),
      .product_o(bend_product),
      .carry_o(bend_carry)
  );

  logic [VALUE_BITS-1:0] spec_row, spec_column, spec, expected;

  assign spec_row = value_i + VALUE_BITS'(row_product) + VALUE_BITS'(row_carry);
  assign spec_column = spec_row + VALUE_BITS'(column_product) + VALUE_BITS'(column_carry);
  assign spec = spec_column + VALUE_BITS'(bend_product) + VALUE_BITS'(bend_carry);

  quadrille_delay_line #(.WIDTH(VALUE_BITS), .DEPTH(quadrille_pkg::FORWARD_DIFFERENCE_STAGES)) u_spec (
      .clk_i,
      .data_i(spec),
      .data_o(expected)
  );

  always_comb assert (value == expected);
endmodule
