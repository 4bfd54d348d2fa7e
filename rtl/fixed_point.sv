// Magnitude of a raw product as unsigned fixed point, truncated. Latency FIXED_POINT_STAGES (2), one per clock.
//
// value = prod_i * 2^(exp_i-(2S-2)); fixed_o has INT_BITS integer and FRAC_BITS fraction bits. overflow_o: value >= 2^INT_BITS,
// fixed_o is 0 then. Does not know signs.
module fixed_point #(
    parameter int INT_BITS = 3,
    parameter int FRAC_BITS = 20,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int OUT = INT_BITS + FRAC_BITS
) (
    input logic clk_i,
    input logic [E-1:0] exp_i,
    input logic [2*S-1:0] prod_i,
    output logic overflow_o,
    output logic [OUT-1:0] fixed_o
);
  localparam int NEAR = $clog2(OUT);  // bits of a distance that leaves something
  localparam int WIDE = (2 * S > OUT) ? 2 * S : OUT;

  // Stage 1: the highest one to the top, and how far down it belongs: INT_BITS - 1 - floor(log2 value) places. log2 is
  // exp_i + carry, so its negative is ~exp_i + !carry; one bit more than exp_i has, which may be at its limit.
  logic carry, nonzero;
  logic [2*S-1:0] normalised;
  logic [E:0] distance_d, distance_q;
  logic [OUT-1:0] top_q;
  logic overflow_q;

  assign carry = prod_i[2*S-1];
  assign nonzero = prod_i[2*S-2+:2] != 2'b00;  // a product is 0 or at least 2^(2S-2)
  assign normalised = carry ? prod_i : prod_i << 1;
  assign distance_d = (E + 1)'(({(E + 1)'(INT_BITS - 1), 1'b1} + {~{exp_i[E-1], exp_i}, !carry}) >> 1);

  always_ff @(posedge clk_i) begin
    distance_q <= distance_d;
    top_q <= OUT'((WIDE'(normalised) << (WIDE - 2 * S)) >> (WIDE - OUT));
    overflow_q <= nonzero && distance_d[E];  // it belongs above the top
  end

  // Stage 2: shift.
  always_ff @(posedge clk_i) begin
    overflow_o <= overflow_q;
    fixed_o <= top_q >> distance_q[NEAR-1:0];
    if (distance_q[E:NEAR] != '0) fixed_o <= '0;  // far below, or above
  end
endmodule
