// SPDX-License-Identifier: Apache-2.0
// Piecewise quadratic C0 - (C1 - C2 dx) dx of a falling convex function, C0 + (C1 - C2 dx) dx of a rising concave one.
// Latency 3, one result per clock: the table's word, inner and outer product; the result is clamped behind the last
// register, for its user's.
//
// word_i = {C0[S+4], C1[S], C2[S]} unsigned, dx_i = the low R bits of the argument below the segment's index, read as a
// fraction of the segment. Two multipliers of S x R bits, truncated; the accumulator has TABLE_GUARD bits below the
// result, which is clamped to [2^(S-1), 2^S - 1]. A degree 1 table has C2 = 0 in every word.
module quadrille_table_polynomial #(
    parameter int SEGMENTS_LOG2 = 5,
    parameter bit RISING = 1'b0,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, R = S - 1 - SEGMENTS_LOG2, DX_BITS = (R < 1) ? 1 : R
) (
    input logic clk_i,
    input logic [3*S+3:0] word_i,
    input logic [DX_BITS-1:0] dx_i,
    output logic [S-1:0] sig_o
);
  localparam int C0_BITS = S + 4;

  // Stage 1: what the table gives.
  logic [3*S+3:0] word_q;
  logic [DX_BITS-1:0] dx_q1;

  always_ff @(posedge clk_i) begin
    word_q <= word_i;
    dx_q1 <= dx_i;
  end

  // Stage 2: inner factor.
  logic [S-1:0] inner_d, inner_q;
  logic [C0_BITS-1:0] c0_q;
  logic [DX_BITS-1:0] dx_q2;
  assign inner_d = word_q[S+:S] - S'(((S + DX_BITS)'(word_q[0+:S]) * (S + DX_BITS)'(dx_q1)) >> R);

  always_ff @(posedge clk_i) begin
    inner_q <= inner_d;
    c0_q <= word_q[2*S+:C0_BITS];
    dx_q2 <= dx_q1;
  end

  // Stage 3: outer product.
  logic [C0_BITS-1:0] slope, outer_d, outer_q;
  assign slope = C0_BITS'(((S + DX_BITS)'(inner_q) * (S + DX_BITS)'(dx_q2)) >> R);
  assign outer_d = RISING ? c0_q + slope : c0_q - slope;

  always_ff @(posedge clk_i) outer_q <= outer_d;

  // Drop the guard bits, clamp.
  logic [S:0] value;
  assign value = (S + 1)'(outer_q >> quadrille_pkg::TABLE_GUARD);
  assign sig_o = value[S] ? '1 : !value[S-1] ? {1'b1, (S - 1)'(0)} : value[S-1:0];
endmodule
