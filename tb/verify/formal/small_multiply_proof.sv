// small_multiply behind radix4_digits: factor * number = product + carry, as signed numbers without overflow, for all factors and numbers.
module small_multiply_proof #(
    parameter int FACTOR_BITS = 48,
    parameter int NUMBER_BITS = 3,
    localparam int PRODUCT_BITS = FACTOR_BITS + NUMBER_BITS
) (
    input logic signed [FACTOR_BITS-1:0] factor_i,
    input logic [NUMBER_BITS-1:0] number_i
);
  logic [2*(NUMBER_BITS/2+1)-1:0] digits;
  logic signed [PRODUCT_BITS-1:0] product;
  logic carry;

  quadrille_radix4_digits #(.NUMBER_BITS(NUMBER_BITS)) u_digits (
      .number_i,
      .digits_o(digits)
  );

  quadrille_small_multiply #(
      .FACTOR_BITS(FACTOR_BITS),
      .NUMBER_BITS(NUMBER_BITS)
  ) u_dut (
      .factor_i,
      .digits_i(digits),
      .product_o(product),
      .carry_o(carry)
  );

  logic signed [PRODUCT_BITS:0] factor, sum;

  assign factor = factor_i;
  assign sum = product + $signed({1'b0, carry});

  always_comb begin
    for (int n = 0; n < (1 << NUMBER_BITS); n++) begin
      if (number_i == NUMBER_BITS'(n)) assert (sum == factor * (PRODUCT_BITS + 1)'(n));
    end
  end
endmodule
