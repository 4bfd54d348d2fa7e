// SPDX-License-Identifier: Apache-2.0
// What the forward differences need of a pixel's place in its tile, row r and column dx: the digits of dx and r^2 +
// dx^2 in radix 4, shared by all of them. Those of dx at once, for a register in each forward_difference_column; of r^2
// + dx^2 in a register, a clock later.
module quadrille_offset_digits #(
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2, NORM_BITS = 2 * TILE_LOG2 + 1,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1,
    localparam int NORM_DIGITS = NORM_BITS / 2 + 1
) (
    input logic clk_i,
    input logic [TILE_LOG2-1:0] row_i, dx_i,
    output logic [2*OFFSET_DIGITS-1:0] dx_digits_o,
    output logic [2*NORM_DIGITS-1:0] norm_digits_o
);
  logic [NORM_BITS-1:0] row_square, dx_square;
  logic [2*NORM_DIGITS-1:0] norm_digits;

  always_comb begin  // a table: `*` would ask for a multiplier
    row_square = '0;
    dx_square = '0;
    for (int i = 0; i < quadrille_pkg::TILE; i++) begin
      if (row_i == TILE_LOG2'(i)) row_square = NORM_BITS'(i * i);
      if (dx_i == TILE_LOG2'(i)) dx_square = NORM_BITS'(i * i);
    end
  end

  quadrille_radix4_digits #(.NUMBER_BITS(TILE_LOG2)) u_dx (.number_i(dx_i), .digits_o(dx_digits_o));

  quadrille_radix4_digits #(.NUMBER_BITS(NORM_BITS)) u_norm (.number_i(row_square + dx_square), .digits_o(norm_digits));

  always_ff @(posedge clk_i) norm_digits_o <= norm_digits;
endmodule
