// Signed sum of TERMS (2 or 4) raw products. Latency 2: align and add, then normalise. One result per enabled clock.
//
// The terms are aligned to the largest exponent E among the non-zero ones and truncated to PREC_BITS fraction bits below it:
//
//     term k   |<- S+1+G bits of product k ->|  >> (E - e_k)
//     sum       sign + log2(TERMS) carries + S+1+G bits, unit 2^(E-(S-1+G))
//
// The result is a significand number with sign; no term, or an exact zero, gives neg = exp = sig = 0. No rounding, no sticky bit.
module fp_sum #(
    parameter int TERMS = 4,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic en_i,
    input logic [TERMS-1:0] neg_i,
    input logic [TERMS*E-1:0] exp_i,
    input logic [TERMS*2*S-1:0] prod_i,
    output logic neg_o,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int PREC = quadrille_pkg::PREC_BITS;
  localparam int DROP = S - 1 - quadrille_pkg::ALIGN_GUARD_BITS;  // product bits below the window even without alignment
  localparam int TERM = 2 * S - DROP;  // one aligned term
  localparam int MAG = TERM + $clog2(TERMS);  // magnitude of the sum
  localparam int SUM = MAG + 1;

  logic any;
  logic [E-1:0] top_exp;
  logic [E:0] distance;
  logic [TERM-1:0] term;
  logic [SUM-1:0] sum;

  always_comb begin
    any = 1'b0;
    top_exp = '0;
    for (int k = 0; k < TERMS; k++) begin
      if (prod_i[k*2*S+:2*S] != '0 && (!any || $signed(exp_i[k*E+:E]) > $signed(top_exp))) begin
        any = 1'b1;
        top_exp = exp_i[k*E+:E];
      end
    end
    sum = '0;
    distance = '0;
    term = '0;
    for (int k = 0; k < TERMS; k++) begin
      distance = {top_exp[E-1], top_exp} - {exp_i[k*E+E-1], exp_i[k*E+:E]};
      term = prod_i[k*2*S+DROP+:TERM] >> distance;
      sum = neg_i[k] ? sum - SUM'(term) : sum + SUM'(term);
    end
  end

  // Stage 1: aligned sum as sign and magnitude.
  logic neg_q;
  logic [MAG-1:0] magnitude_q;
  logic [E-1:0] exp_q;

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      neg_q <= sum[SUM-1];
      magnitude_q <= sum[SUM-1] ? MAG'(-sum) : sum[MAG-1:0];
      exp_q <= top_exp;
    end
  end

  // Stage 2: normalise.
  logic [E-1:0] exp_d;
  logic [S-1:0] sig_d;

  fp_normalise #(.WIDTH(MAG)) u_normalise (
      .magnitude_i(magnitude_q),
      .bias_i(exp_q - E'(PREC)),
      .exp_o(exp_d),
      .sig_o(sig_d)
  );

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      neg_o <= neg_q;
      exp_o <= exp_d;
      sig_o <= sig_d;
    end
  end
endmodule
