// Magnitude of a raw product as unsigned fixed point, truncated, saturated. Combinational.
//
// value = prod_i * 2^(exp_i-(2S-2)); fixed_o has INT_BITS integer and FRAC_BITS fraction bits. overflow_o: value >= 2^INT_BITS,
// fixed_o is all ones then. Does not know signs.
module fixed_point #(
    parameter int INT_BITS = 3,
    parameter int FRAC_BITS = 20,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int OUT = INT_BITS + FRAC_BITS
) (
    input logic [E-1:0] exp_i,
    input logic [2*S-1:0] prod_i,
    output logic overflow_o,
    output logic [OUT-1:0] fixed_o
);
  localparam int WIDE = (2 * S > OUT) ? 2 * S : OUT;

  logic carry;
  logic [2*S-1:0] normalised;  // highest one at the top
  logic [E:0] log2_value;  // floor(log2 value), one bit more: exp may be at its limit
  logic [E:0] distance;
  logic [WIDE-1:0] wide;
  logic [OUT-1:0] top;

  assign carry = prod_i[2*S-1];
  assign normalised = carry ? prod_i : prod_i << 1;
  assign log2_value = {exp_i[E-1], exp_i} + (E + 1)'(carry);
  assign overflow_o = prod_i != '0 && $signed(log2_value) >= $signed((E + 1)'(INT_BITS));
  assign distance = (E + 1)'(INT_BITS - 1) - log2_value;  // >= 0 without overflow
  assign wide = WIDE'(normalised) << (WIDE - 2 * S);
  assign top = OUT'(wide >> (WIDE - OUT));
  assign fixed_o = overflow_o ? '1 : top >> distance;
endmodule
