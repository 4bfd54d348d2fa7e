// SPDX-License-Identifier: Apache-2.0
// Signed factor times a small unsigned number, exact, by adders. Combinational.
//
// The number comes as radix4_digits, so that each two bits of it cost one selection (0, x, 2x, ~x) and one adder of the
// factor's width. -x is ~x + 1, and the one waits for an adder whose carry-in is free: the last one leaves as carry_o,
// for the adder that takes the product.
//
//     factor * number = product_o + carry_o
module quadrille_small_multiply #(
    parameter int FACTOR_BITS = 48,
    parameter int NUMBER_BITS = 3,
    localparam int DIGITS = NUMBER_BITS / 2 + 1,
    localparam int PRODUCT_BITS = FACTOR_BITS + NUMBER_BITS
) (
    input logic [FACTOR_BITS-1:0] factor_i,
    input logic [2*DIGITS-1:0] digits_i,
    output logic [PRODUCT_BITS-1:0] product_o,
    output logic carry_o
);
  logic [DIGITS-1:0] negative;  // this digit is -1
  logic [PRODUCT_BITS-1:0] factor, multiple, sum;

  always_comb begin
    factor = PRODUCT_BITS'($signed(factor_i));
    negative = '0;
    sum = '0;
    for (int d = 0; d < DIGITS; d++) begin
      negative[d] = d < DIGITS - 1 && digits_i[2*d+:2] == 2'd3;
      case (digits_i[2*d+:2])
        2'd0: multiple = '0;
        2'd1: multiple = factor << (2 * d);
        2'd2: multiple = factor << (2 * d + 1);
        default: multiple = (d < DIGITS - 1) ? ~(factor << (2 * d)) : '0;
      endcase
      if (d == 0) sum = multiple;
      else if (d == 1) sum = sum + multiple;
      else sum = PRODUCT_BITS'(({sum, 1'b1} + {multiple, negative[d-2]}) >> 1);  // with carry-in
    end
  end

  assign product_o = sum;
  assign carry_o = negative[DIGITS-2];
endmodule
