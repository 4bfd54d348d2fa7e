// fp_sum of two terms behind its fp_terms is fp_sum of rtl/SPEC.md, Numbers, for all signs and all pairs of products.
// Assumed: the factors are significand numbers, and the exponents of the products stay in EXP_BITS (numbers do).
module fp_sum_proof #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic [1:0] neg_i,
    input logic [2*E-1:0] a_exp_i,
    input logic [2*S-1:0] a_sig_i,
    input logic [2*E-1:0] b_exp_i,
    input logic [2*S-1:0] b_sig_i
);
`include "fp_two_terms.svh"

  logic [1:0] neg;
  logic [2*RANK-1:0] rank;
  logic [2*TERM-1:0] term;
  logic neg_o, neg_expected;
  logic [E-1:0] exp, exp_expected;
  logic [S-1:0] sig, sig_expected;

  for (genvar k = 0; k < 2; k++) begin : gen_term
    quadrille_fp_term u_term (
        .clk_i,
        .neg_i(neg_i[k]),
        .a_exp_i(a_exp_i[k*E+:E]),
        .a_sig_i(a_sig_i[k*S+:S]),
        .b_exp_i(b_exp_i[k*E+:E]),
        .b_sig_i(b_sig_i[k*S+:S]),
        .rank_o(rank[k*RANK+:RANK]),
        .neg_o(neg[k]),
        .term_o(term[k*TERM+:TERM])
    );
  end

  quadrille_fp_sum #(.TERMS(2)) u_dut (
      .clk_i,
      .rank_i(rank),
      .neg_i(neg),
      .term_i(term),
      .neg_o(neg_o),
      .exp_o(exp),
      .sig_o(sig)
  );

  quadrille_delay_line #(.WIDTH(1 + E + S), .DEPTH(quadrille_pkg::PRODUCT_STAGES + quadrille_pkg::FP_SUM_STAGES)) u_spec (
      .clk_i,
      .data_i({negative, exp_spec, sig_spec}),
      .data_o({neg_expected, exp_expected, sig_expected})
  );

  always_comb assert ({neg_o, exp, sig} == {neg_expected, exp_expected, sig_expected});
endmodule
