// Weighted sums over the four corners: term set t gives sum_t = M_0 c_t0 + M_1 c_t1 + M_2 c_t2 + M_3 c_t3, signed, for the sets
// k_eff, W, Z, b_0, b_1, ... Latency PRODUCT_STAGES + FP_SUM_STAGES (quadrille_pkg), one pixel per clock.
//
// Term t of corner v is at index t*4+v; term exponents have the port's width. Does not divide.
module interpolate #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int SETS = 3 + quadrille_pkg::ATTRIBUTE_SLOTS
) (
    input logic clk_i,
    input logic [4*E-1:0] m_exp_i,
    input logic [4*S-1:0] m_sig_i,
    input logic [SETS*4-1:0] term_neg_i,
    input logic [SETS*4*PE-1:0] term_exp_i,
    input logic [SETS*4*S-1:0] term_sig_i,
    output logic [SETS-1:0] sum_neg_o,
    output logic [SETS*E-1:0] sum_exp_o,
    output logic [SETS*S-1:0] sum_sig_o
);
  localparam int TERM = quadrille_pkg::TERM_BITS;
  localparam int RANK = quadrille_pkg::RANK_BITS;

  for (genvar t = 0; t < SETS; t++) begin : gen_set
    logic [4*RANK-1:0] rank;
    logic [3:0] neg;
    logic [4*TERM-1:0] term;

    for (genvar v = 0; v < 4; v++) begin : gen_corner
      fp_term u_term (
          .clk_i,
          .neg_i(term_neg_i[t*4+v]),
          .a_exp_i(m_exp_i[v*E+:E]),
          .a_sig_i(m_sig_i[v*S+:S]),
          .b_exp_i(E'($signed(term_exp_i[(t*4+v)*PE+:PE]))),
          .b_sig_i(term_sig_i[(t*4+v)*S+:S]),
          .rank_o(rank[v*RANK+:RANK]),
          .neg_o(neg[v]),
          .term_o(term[v*TERM+:TERM])
      );
    end

    fp_sum #(.TERMS(4)) u_sum (
        .clk_i,
        .rank_i(rank),
        .neg_i(neg),
        .term_i(term),
        .neg_o(sum_neg_o[t]),
        .exp_o(sum_exp_o[t*E+:E]),
        .sig_o(sum_sig_o[t*S+:S])
    );
  end
endmodule
