// fp_add behind two products is fp_sum of rtl/SPEC.md, Numbers, without signs, for all pairs of products.
// Assumed: the factors are significand numbers, and the exponents of the products stay in EXP_BITS (numbers do).
module fp_add_proof #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic [2*E-1:0] a_exp_i,
    input logic [2*S-1:0] a_sig_i,
    input logic [2*E-1:0] b_exp_i,
    input logic [2*S-1:0] b_sig_i
);
  logic [1:0] neg_i;
  assign neg_i = '0;
`include "fp_two_terms.svh"

  logic [2*RANK-1:0] rank, rank_q;
  logic [2*TERM-1:0] term;
  logic [E-1:0] exp, exp_expected;
  logic [S-1:0] sig, sig_expected;

  for (genvar k = 0; k < 2; k++) begin : gen_term
    logic unused;
    quadrille_fp_term u_term (
        .clk_i,
        .neg_i(1'b0),
        .a_exp_i(a_exp_i[k*E+:E]),
        .a_sig_i(a_sig_i[k*S+:S]),
        .b_exp_i(b_exp_i[k*E+:E]),
        .b_sig_i(b_sig_i[k*S+:S]),
        .rank_o(rank[k*RANK+:RANK]),
        .neg_o(unused),
        .term_o(term[k*TERM+:TERM])
    );
  end

  always_ff @(posedge clk_i) rank_q <= rank;

  quadrille_fp_add u_dut (
      .clk_i,
      .a_rank_i(rank_q[0+:RANK]),
      .a_term_i(term[0+:TERM]),
      .b_rank_i(rank_q[RANK+:RANK]),
      .b_term_i(term[TERM+:TERM]),
      .exp_o(exp),
      .sig_o(sig)
  );

  quadrille_delay_line #(.WIDTH(E + S), .DEPTH(quadrille_pkg::PRODUCT_STAGES + quadrille_pkg::FP_ADD_STAGES)) u_spec (
      .clk_i,
      .data_i({exp_spec, sig_spec}),
      .data_o({exp_expected, sig_expected})
  );

  always_comb assert ({exp, sig} == {exp_expected, sig_expected});
endmodule
