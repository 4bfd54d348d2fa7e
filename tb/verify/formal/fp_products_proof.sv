// fp_product gives what fp_multiply (proof fp_multiply) and fp_term give, fp_term the upper TERM_BITS bits of the product and the order of its
// exponent, fp_raw_product sign, exponent and product as they are: for all inputs. Nothing is assumed.
module fp_products_proof #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic neg_i,
    input logic [E-1:0] a_exp_i,
    input logic [S-1:0] a_sig_i,
    input logic [E-1:0] b_exp_i,
    input logic [S-1:0] b_sig_i
);
  logic [E-1:0] exp, multiply_exp, raw_exp, exp_spec, exp_expected;
  logic [S-1:0] sig, multiply_sig;
  logic [RANK-1:0] rank, term_rank, rank_spec;
  logic [TERM-1:0] term, term_term;
  logic [2*S-1:0] raw_product, product_spec, product_expected;
  logic term_neg, raw_neg, neg_expected;

  quadrille_fp_multiply u_multiply (.clk_i, .a_exp_i, .a_sig_i, .b_exp_i, .b_sig_i, .exp_o(multiply_exp), .sig_o(multiply_sig));
  quadrille_fp_term u_term (.clk_i, .neg_i, .a_exp_i, .a_sig_i, .b_exp_i, .b_sig_i, .rank_o(term_rank), .neg_o(term_neg), .term_o(term_term));
  quadrille_fp_product u_product (.clk_i, .a_exp_i, .a_sig_i, .b_exp_i, .b_sig_i, .exp_o(exp), .sig_o(sig), .rank_o(rank), .term_o(term));
  quadrille_fp_raw_product u_raw (.clk_i, .neg_i, .a_exp_i, .a_sig_i, .b_exp_i, .b_sig_i, .neg_o(raw_neg), .exp_o(raw_exp), .prod_o(raw_product));

  always_comb begin
    exp_spec = a_exp_i + b_exp_i;
    product_spec = (2 * S)'(a_sig_i) * (2 * S)'(b_sig_i);
    // Unsigned order: the exponent from its least one on, above it a one for a product that is not 0
    rank_spec = (a_sig_i[S-1] && b_sig_i[S-1]) ? RANK'(1 << E) + RANK'(E'(exp_spec + E'(1 << (E - 1)))) : '0;
  end

  always_ff @(posedge clk_i) {neg_expected, exp_expected, product_expected} <= {neg_i, exp_spec, product_spec};

  always_comb begin
    assert ({exp, sig} == {multiply_exp, multiply_sig});
    assert (rank == rank_spec && term_rank == rank_spec);
    assert (term == product_expected[2*S-1-:TERM] && term_term == term);
    assert (term_neg == neg_expected);
    assert ({raw_neg, raw_exp, raw_product} == {neg_expected, exp_expected, product_expected});
  end
endmodule
