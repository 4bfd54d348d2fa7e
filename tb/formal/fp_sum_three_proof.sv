// fp_sum of three terms is fp_sum of rtl/README.md section 2, for all signs and all terms that products have (fp_term, proof fp_products).
// Assumed: a term is 0 or at least 1, of which the upper two places are integer bits; its exponent stays in EXP_BITS.
module fp_sum_three_proof #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS,
    localparam int G = quadrille_pkg::ALIGN_GUARD_BITS
) (
    input logic clk_i,
    input logic [2:0] neg_i,
    input logic [3*E-1:0] exp_i,
    input logic [3*TERM-1:0] term_i
);
  localparam int SUM = TERM + 3;
  logic [3*RANK-1:0] rank;
  logic [2:0] neg_q;
  logic [3*TERM-1:0] term_q;
  logic neg, neg_spec, neg_expected;
  logic [E-1:0] exp, exp_spec, exp_expected;
  logic [S-1:0] sig, sig_spec, sig_expected;

  for (genvar k = 0; k < 3; k++) begin : gen_rank
    assign rank[k*RANK+:RANK] = quadrille_pkg::exponent_rank(exp_i[k*E+:E], term_i[k*TERM+:TERM] != '0);
  end

  always_ff @(posedge clk_i) begin
    neg_q <= neg_i;
    term_q <= term_i;
  end

  fp_sum #(.TERMS(3)) u_dut (
      .clk_i,
      .rank_i(rank),
      .neg_i(neg_q),
      .term_i(term_q),
      .neg_o(neg),
      .exp_o(exp),
      .sig_o(sig)
  );

  // In the exponent of the largest term, of those that are not 0
  logic some;
  logic signed [E-1:0] e;
  logic [E:0] below;
  logic [SUM-1:0] sum, m;

  always_comb begin
    some = 1'b0;
    e = '0;
    for (int k = 0; k < 3; k++) begin
      assume (term_i[k*TERM+:TERM] == '0 || term_i[k*TERM+TERM-2+:2] != 2'b00);
      if (term_i[k*TERM+:TERM] != '0 && (!some || $signed(exp_i[k*E+:E]) > e)) begin
        some = 1'b1;
        e = exp_i[k*E+:E];
      end
    end
    sum = '0;
    for (int k = 0; k < 3; k++) begin
      below = {e[E-1], e} - {exp_i[k*E+E-1], exp_i[k*E+:E]};
      m = (term_i[k*TERM+:TERM] == '0) ? '0 : SUM'(term_i[k*TERM+:TERM]) >> below;
      sum = neg_i[k] ? sum - m : sum + m;
    end
    neg_spec = sum[SUM-1];
    m = neg_spec ? -sum : sum;
    exp_spec = '0;
    sig_spec = '0;
    for (int h = 0; h < SUM; h++) begin
      if (m[h] && (m >> h) == SUM'(1)) begin  // h: the highest one
        exp_spec = E'(e) + E'(h) - E'(S - 1 + G);
        sig_spec = (h >= S - 1) ? S'(m >> (h - (S - 1))) : S'(m << (S - 1 - h));
      end
    end
  end

  delay_line #(.WIDTH(1 + E + S), .DEPTH(quadrille_pkg::PRODUCT_STAGES + quadrille_pkg::FP_SUM_STAGES)) u_spec (
      .clk_i,
      .data_i({neg_spec, exp_spec, sig_spec}),
      .data_o({neg_expected, exp_expected, sig_expected})
  );

  always_comb assert ({neg, exp, sig} == {neg_expected, exp_expected, sig_expected});
endmodule
