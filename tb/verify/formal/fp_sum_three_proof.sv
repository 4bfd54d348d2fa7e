// fp_sum of three terms is fp_sum of four of which one is zero: the rule of rtl/SPEC.md, Numbers, says nothing of how many terms there are.
// Assumed: ranks and terms are those of fp_term (proof fp_products), of exponents that stay in EXP_BITS.
module fp_sum_three_proof #(
    parameter int ZERO = 3,  // the one of the four that is zero
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic [3*RANK-1:0] rank_i,
    input logic [2:0] neg_i,
    input logic [3*TERM-1:0] term_i,
    input logic zero_neg_i
);
  logic [3*RANK-1:0] rank_q;
  logic [4*RANK-1:0] rank_four;
  logic [3:0] neg_four;
  logic [4*TERM-1:0] term_four;
  logic neg3, neg4;
  logic [E-1:0] exp3, exp4;
  logic [S-1:0] sig3, sig4;

  always_ff @(posedge clk_i) rank_q <= rank_i;  // ranks come a clock before the terms

  always_comb begin
    rank_four = '0;
    neg_four = {4{zero_neg_i}};
    term_four = '0;
    for (int k = 0; k < 3; k++) begin
      assume ((rank_q[k*RANK+:RANK] == '0) == (term_i[k*TERM+:TERM] == '0));
      assume (rank_q[k*RANK+:RANK] == '0 || (rank_q[k*RANK+RANK-1] && term_i[k*TERM+TERM-2+:2] != 2'b00));
      for (int at = 0; at < 4; at++) begin
        if (at == k + ((k >= ZERO) ? 1 : 0)) begin
          rank_four[at*RANK+:RANK] = rank_i[k*RANK+:RANK];
          neg_four[at] = neg_i[k];
          term_four[at*TERM+:TERM] = term_i[k*TERM+:TERM];
        end
      end
    end
  end

  quadrille_fp_sum #(.TERMS(3)) u_three (
      .clk_i,
      .rank_i,
      .neg_i,
      .term_i,
      .neg_o(neg3),
      .exp_o(exp3),
      .sig_o(sig3)
  );

  quadrille_fp_sum #(.TERMS(4)) u_four (
      .clk_i,
      .rank_i(rank_four),
      .neg_i(neg_four),
      .term_i(term_four),
      .neg_o(neg4),
      .exp_o(exp4),
      .sig_o(sig4)
  );

  always_comb assert ({neg3, exp3, sig3} == {neg4, exp4, sig4});
endmodule
