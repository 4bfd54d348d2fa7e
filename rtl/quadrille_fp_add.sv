// SPDX-License-Identifier: Apache-2.0
// Sum of two unsigned products, in fewer clocks than fp_sum and with its bits: without a difference the highest one can
// be in three places only. Latency FP_ADD_STAGES (order, align, add), one per clock.
//
// Rank and term as fp_term gives them, in the same clock here. Both zero: exp = sig = 0.
module quadrille_fp_add #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic [RANK-1:0] a_rank_i,
    input logic [TERM-1:0] a_term_i,
    input logic [RANK-1:0] b_rank_i,
    input logic [TERM-1:0] b_term_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  // ---- Stage 1: the larger exponent first ---------------------------------------------------------------------------
  logic [RANK:0] a_above, b_above;  // with the borrow
  logic swap;
  logic [TERM-1:0] first_q, second_q;
  logic [E-1:0] first_exp_q, distance_q;
  assign a_above = {1'b0, a_rank_i} - {1'b0, b_rank_i};
  assign b_above = {1'b0, b_rank_i} - {1'b0, a_rank_i};
  assign swap = a_above[RANK];

  always_ff @(posedge clk_i) begin
    first_q <= swap ? b_term_i : a_term_i;
    second_q <= swap ? a_term_i : b_term_i;
    first_exp_q <= quadrille_pkg::rank_exponent(swap ? b_rank_i : a_rank_i);
    distance_q <= swap ? b_above[E-1:0] : a_above[E-1:0];  // of a zero: any
  end

  // ---- Stage 2: align ----------------------------------------------------------------------------------------------
  localparam int NEAR = $clog2(TERM);  // bits of a distance that leaves something of a term
  logic [TERM-1:0] augend_q, addend_q;
  logic [E-1:0] exp_q;

  always_ff @(posedge clk_i) begin
    augend_q <= first_q;
    addend_q <= second_q >> distance_q[NEAR-1:0];
    if (distance_q[E-1:NEAR] != '0) addend_q <= '0;  // by the registers' synchronous reset
    exp_q <= first_exp_q;
  end

  // ---- Stage 3: add. A product in [1, 4) and less than another such one: the highest one is in the upper three -----
  logic [TERM:0] sum;
  assign sum = (TERM + 1)'(augend_q) + (TERM + 1)'(addend_q);

  always_ff @(posedge clk_i) begin
    sig_o <= sum[TERM] ? sum[TERM-:S] : sum[TERM-1] ? sum[TERM-1-:S] : sum[TERM-2-:S];
    exp_o <= exp_q + (sum[TERM] ? E'(2) : E'(sum[TERM-1]));
  end

  logic unused;
  assign unused = ^{b_above[RANK:E], a_above[RANK-1:E]};
endmodule
