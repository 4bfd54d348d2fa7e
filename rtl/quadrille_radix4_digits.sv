// SPDX-License-Identifier: Apache-2.0
// A small unsigned number in radix 4 with the digits -1, 0, 1, 2 (code 3 is -1; the highest digit is never -1).
// Combinational.
//
// The digits that small_multiply takes. A carry runs from digit to digit: 3 is 4 - 1, and 3 + 1 is 4.
module quadrille_radix4_digits #(
    parameter int NUMBER_BITS = 3,
    localparam int DIGITS = NUMBER_BITS / 2 + 1
) (
    input logic [NUMBER_BITS-1:0] number_i,
    output logic [2*DIGITS-1:0] digits_o
);
  logic [2*DIGITS-1:0] number;
  logic [2:0] digit;
  logic carry;

  always_comb begin
    number = (2 * DIGITS)'(number_i);
    carry = 1'b0;
    for (int d = 0; d < DIGITS; d++) begin
      digit = {1'b0, number[2*d+:2]} + 3'(carry);
      digits_o[2*d+:2] = digit[1:0];
      carry = digit >= 3'd3;
    end
  end
endmodule
