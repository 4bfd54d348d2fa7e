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
  logic [TERMS*RANK-1:0] rank_q;
  logic [PAIRS*RANK-1:0] higher_q;

  always_ff @(posedge clk_i) rank_q <= rank_i;

  for (genvar p = 0; p < PAIRS; p++) begin : gen_higher
    localparam int FIRST = 2 * p, SECOND = (FIRST + 1 < TERMS) ? FIRST + 1 : FIRST;

    always_ff @(posedge clk_i) begin
      higher_q[p*RANK+:RANK] <= (rank_i[SECOND*RANK+:RANK] > rank_i[FIRST*RANK+:RANK]) ? rank_i[SECOND*RANK+:RANK] :
          rank_i[FIRST*RANK+:RANK];
    end
  end

  // ---- Stage 1: the highest rank, and how far each term is below it ------------------------------------------------
  localparam int NEAR = $clog2(TERM);  // bits of a distance that leaves something of a term
  logic [RANK-1:0] top;
  logic [TERMS*E-1:0] distance_q;
  logic [TERMS*TERM-1:0] term_q;
  logic [TERMS-1:0] neg_q;
  logic [E-1:0] top_exp_q;
  assign top = (PAIRS == 2 && higher_q[(PAIRS-1)*RANK+:RANK] > higher_q[0+:RANK]) ? higher_q[(PAIRS-1)*RANK+:RANK] :
      higher_q[0+:RANK];

  always_ff @(posedge clk_i) begin
    for (int k = 0; k < TERMS; k++) distance_q[k*E+:E] <= top[E-1:0] - rank_q[k*RANK+:E];  // of a zero: any
    term_q <= term_i;
    neg_q <= neg_i;
    top_exp_q <= quadrille_pkg::rank_exponent(top);
  end

  // ---- Stage 2: align ----------------------------------------------------------------------------------------------
  logic [TERMS*TERM-1:0] aligned_q;
  logic across_q;  // signs of the pairs
  logic aligned_neg_q;
  logic [E-1:0] aligned_exp_q;

  always_ff @(posedge clk_i) begin
    for (int k = 0; k < TERMS; k++) begin  // the far ones by the registers' synchronous reset
      aligned_q[k*TERM+:TERM] <= term_q[k*TERM+:TERM] >> distance_q[k*E+:NEAR];
      if (distance_q[k*E+NEAR+:E-NEAR] != '0) aligned_q[k*TERM+:TERM] <= '0;
    end
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

      assign pair[p*PAIR+:PAIR] = PAIR'(({PAIR'(aligned_q[2*p*TERM+:TERM]), 1'b1}
          + {PAIR'(aligned_q[(2*p+1)*TERM+:TERM]) ^ {PAIR{differ_q}}, differ_q}) >> 1);
    end else begin : gen_one
      assign pair[p*PAIR+:PAIR] = PAIR'(aligned_q[2*p*TERM+:TERM]);
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
