// Signed sum of TERMS (2 or 4) raw products. Latency 2: align and add, then normalise. One result per enabled clock.
//
// The terms are aligned to the largest exponent E among the non-zero ones and truncated to PREC_BITS fraction bits below it:
//
//     term k   |<- S+1+G bits of product k ->|  >> (E - e_k)
//     sum       sign + log2(TERMS) carries + S+1+G bits, unit 2^(E-(S-1+G))
//
// The result is a significand number with sign; no term, or an exact zero, gives neg = exp = sig = 0. No rounding, no sticky bit.
// A product is 0 or at least 2^(2S-2), so its two top bits say which.
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
  localparam int KEY = E + 1;  // order of exponents as unsigned numbers: 0 for a zero, else {1, exponent + 2^(E-1)}

  // ---- Stage 1: largest exponent, by pairs ---------------------------------------------------------------------------------
  logic [TERMS*KEY-1:0] key;
  logic [E-1:0] top_exp;

  always_comb begin
    for (int k = 0; k < TERMS; k++) begin
      key[k*KEY+:KEY] = {1'b1, ~exp_i[k*E+E-1], exp_i[k*E+:E-1]} & {KEY{prod_i[k*2*S+2*S-2+:2] != 2'b00}};
    end
    for (int step = 1; step < TERMS; step = step * 2) begin
      for (int k = 0; k < TERMS; k += 2 * step) begin
        if (key[(k+step)*KEY+:KEY] > key[k*KEY+:KEY]) key[k*KEY+:KEY] = key[(k+step)*KEY+:KEY];
      end
    end
    top_exp = {~key[E-1], key[E-2:0]};
  end

  // ---- Aligned sum, in the sign of term 0 -----------------------------------------------------------------------------------
  logic [E-1:0] distance;
  logic [TERM-1:0] term;
  logic subtract;
  logic [SUM-1:0] sum;

  always_comb begin
    sum = '0;
    for (int k = 0; k < TERMS; k++) begin
      distance = top_exp - exp_i[k*E+:E];
      term = prod_i[k*2*S+DROP+:TERM] >> distance;
      subtract = neg_i[k] != neg_i[0];
      if (k == 0) sum = SUM'(term);
      else sum = SUM'(({sum, 1'b1} + {SUM'(term) ^ {SUM{subtract}}, subtract}) >> 1);  // {a, 1} + {b, carry}
    end
  end

  logic neg_q;
  logic [MAG-1:0] magnitude_q;
  logic [E-1:0] exp_q;

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      neg_q <= sum[SUM-1] != neg_i[0];
      magnitude_q <= sum[SUM-1] ? MAG'(-sum) : sum[MAG-1:0];
      exp_q <= top_exp;
    end
  end

  // ---- Stage 2: normalise --------------------------------------------------------------------------------------------------
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
      neg_o <= neg_q && sig_d[S-1];
      exp_o <= exp_d;
      sig_o <= sig_d;
    end
  end
endmodule
