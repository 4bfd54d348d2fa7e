// SPDX-License-Identifier: Apache-2.0
// Signed sum of TERMS (2, 3 or 4) products. Latency FP_SUM_STAGES from neg_i and term_i; the ranks come one clock
// before those, while the multipliers run (fp_term). One result per clock.
//
// The terms are aligned to the largest exponent E among the non-zero ones and truncated to PREC_BITS fraction bits
// below it:
//
//     term k   |<- S+1+G bits of product k ->|  >> (E - e_k)
//     sum       sign + log2(TERMS) carries + S+1+G bits, unit 2^(E-(S-1+G))
//
// The result is a significand number with sign; no term, or an exact zero, gives neg = exp = sig = 0. No rounding, no
// sticky bit.
module quadrille_fp_sum #(
    parameter int TERMS = 4,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic [TERMS*RANK-1:0] rank_i,
    input logic [TERMS-1:0] neg_i,
    input logic [TERMS*TERM-1:0] term_i,
    output logic neg_o,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int PREC = quadrille_pkg::PREC_BITS;
  localparam int PAIRS = (TERMS + 1) / 2;  // the second of three terms is one term alone
  localparam int PAIR = TERM + 2;  // signed sum of two terms
  localparam int MAG = TERM + $clog2(TERMS);  // magnitude of the sum
  localparam int SUM = MAG + 1;

  // ---- Beside the multipliers: the higher rank of each pair --------------------------------------------------------
  logic [PAIRS*RANK-1:0] higher_q;

  for (genvar p = 0; p < PAIRS; p++) begin : gen_higher
    localparam int FIRST = 2 * p, SECOND = (FIRST + 1 < TERMS) ? FIRST + 1 : FIRST;

    always_ff @(posedge clk_i) begin
      higher_q[p*RANK+:RANK] <= (rank_i[SECOND*RANK+:RANK] > rank_i[FIRST*RANK+:RANK]) ? rank_i[SECOND*RANK+:RANK] :
          rank_i[FIRST*RANK+:RANK];
    end
  end

  // ---- Stage 1: the highest rank, and how far each term is below it. Stage 2: align --------------------------------
  localparam int NEAR = $clog2(TERM);  // bits of a distance that leaves something of a term
  logic [RANK-1:0] top;
  logic [TERMS-1:0] neg_q;
  logic [E-1:0] top_exp_q, aligned_exp_q;
  logic across_q;  // signs of the pairs
  logic aligned_neg_q;
  assign top = (PAIRS == 2 && higher_q[(PAIRS-1)*RANK+:RANK] > higher_q[0+:RANK]) ? higher_q[(PAIRS-1)*RANK+:RANK] :
      higher_q[0+:RANK];

  for (genvar k = 0; k < TERMS; k++) begin : gen_term
    logic [E-1:0] rank_q, distance_q;
    logic [TERM-1:0] term_q, aligned_q;

    always_ff @(posedge clk_i) begin
      rank_q <= rank_i[k*RANK+:E];
      distance_q <= top[E-1:0] - rank_q;  // of a zero: any
      term_q <= term_i[k*TERM+:TERM];
      aligned_q <= term_q >> distance_q[NEAR-1:0];
      if (distance_q[E-1:NEAR] != '0) aligned_q <= '0;  // by the registers' synchronous reset
    end
  end

  always_ff @(posedge clk_i) begin
    neg_q <= neg_i;
    top_exp_q <= quadrille_pkg::rank_exponent(top);
    across_q <= neg_q[0] != neg_q[2*(PAIRS-1)];
    aligned_neg_q <= neg_q[0];
    aligned_exp_q <= top_exp_q;
  end

  // ---- Stage 3: add by pairs, each in the sign of its first term; {a, 1} + {b, carry} is an adder with carry-in -----
  logic [PAIRS*PAIR-1:0] pair;
  logic [SUM-1:0] sum_d, sum_q;
  logic sum_neg_q;
  logic [E-1:0] sum_exp_q;

  for (genvar p = 0; p < PAIRS; p++) begin : gen_pair
    if (2 * p + 1 < TERMS) begin : gen_two
      logic differ_q;  // signs within the pair

      always_ff @(posedge clk_i) differ_q <= neg_q[2*p] != neg_q[2*p+1];

      assign pair[p*PAIR+:PAIR] = PAIR'(({PAIR'(gen_term[2*p].aligned_q), 1'b1}
          + {PAIR'(gen_term[2*p+1].aligned_q) ^ {PAIR{differ_q}}, differ_q}) >> 1);
    end else begin : gen_one
      assign pair[p*PAIR+:PAIR] = PAIR'(gen_term[2*p].aligned_q);
    end
  end

  if (TERMS == 2) begin : gen_one_pair
    logic unused;
    assign unused = across_q;
    assign sum_d = pair;
  end else begin : gen_two_pairs
    assign sum_d = SUM'(({SUM'($signed(pair[0+:PAIR])), 1'b1} +
        {SUM'($signed(pair[PAIR+:PAIR])) ^ {SUM{across_q}}, across_q}) >> 1);
  end

  always_ff @(posedge clk_i) begin
    sum_q <= sum_d;
    sum_neg_q <= aligned_neg_q;
    sum_exp_q <= aligned_exp_q;
  end

  // ---- Stage 4: magnitude ------------------------------------------------------------------------------------------
  logic magnitude_neg_q;
  logic [MAG-1:0] magnitude_q;
  logic [E-1:0] magnitude_exp_q;

  always_ff @(posedge clk_i) begin
    magnitude_neg_q <= sum_q[SUM-1] != sum_neg_q;
    magnitude_q <= sum_q[SUM-1] ? MAG'(-sum_q) : sum_q[MAG-1:0];
    magnitude_exp_q <= sum_exp_q;
  end

  // ---- Stages 5, 6: normalise --------------------------------------------------------------------------------------
  logic nonzero_neg;
  assign nonzero_neg = magnitude_neg_q && magnitude_q != '0;

  quadrille_delay_line #(.WIDTH(1), .DEPTH(quadrille_pkg::FP_NORMALISE_STAGES)) u_neg (.clk_i, .data_i(nonzero_neg),
      .data_o(neg_o));

  quadrille_fp_normalise #(.WIDTH(MAG)) u_normalise (
      .clk_i, .active_i(1'b1), .magnitude_i(magnitude_q), .bias_i(magnitude_exp_q - E'(PREC)), .exp_o, .sig_o
  );
endmodule
