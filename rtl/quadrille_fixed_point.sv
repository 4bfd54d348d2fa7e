// SPDX-License-Identifier: Apache-2.0
// A raw product as signed fixed point. Latency FIXED_POINT_STAGES (2), one per clock.
//
// value = prod_i * 2^(exp_i-(2S-2)); its magnitude is truncated to INT_BITS integer and FRAC_BITS fraction bits.
// fixed_o has all bits inverted when neg_o is set, which is the sign of a number that is not 0 then: -magnitude is
// fixed_o, sign-extended, + neg_o. overflow_o: the magnitude is 2^INT_BITS or more. fixed_o and neg_o mean nothing
// then.
module quadrille_fixed_point #(
    parameter int INT_BITS = 8,
    parameter int FRAC_BITS = 25,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, OUT = INT_BITS + FRAC_BITS
) (
    input logic clk_i, neg_i,
    input logic [E-1:0] exp_i,
    input logic [2*S-1:0] prod_i,
    output logic overflow_o, neg_o,
    output logic [OUT-1:0] fixed_o
);
  localparam int NEAR = $clog2(OUT + 1);  // bits of a distance that leaves something
  localparam int WIDE = (2 * S > OUT + 1) ? 2 * S : OUT + 1;

  // Stage 1: the product to the top, whose second place has the weight 2^exp_i, and how far down it belongs: that place
  // has 2^(INT_BITS-1) in the result, which has none for the first. One bit more than exp_i has, which may be at its
  // limit.
  logic [E:0] distance_q;
  logic [OUT:0] top_q;
  logic nonzero_q, neg_q;

  always_ff @(posedge clk_i) begin
    distance_q <= (E + 1)'(INT_BITS - 1) - {exp_i[E-1], exp_i};
    top_q <= (OUT + 1)'((WIDE'(prod_i) << (WIDE - 2 * S)) >> (WIDE - OUT - 1));
    nonzero_q <= prod_i[2*S-2+:2] != 2'b00;  // a product is 0 or at least 2^(2S-2)
    neg_q <= neg_i;
  end

  // Stage 2: shift. What belongs above the top has a negative distance, or a one in the place that the result has not.
  logic far;
  assign far = distance_q[E:NEAR] != '0;

  always_ff @(posedge clk_i) begin
    overflow_o <= (distance_q[E] && nonzero_q) || (distance_q == '0 && top_q[OUT]);
    neg_o <= neg_q && !far;
    fixed_o <= OUT'(top_q >> distance_q[NEAR-1:0]) ^ {OUT{neg_q}};
    if (far) fixed_o <= '0;
  end
endmodule
