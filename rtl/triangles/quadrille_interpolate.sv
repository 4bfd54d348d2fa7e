// SPDX-License-Identifier: Apache-2.0
// Triangle machine: weighted sums over three corners, sum_t = M_0 c_t0 + M_1 c_t1 + M_2 c_t2, for the sets k_eff, W, Z,
// b_0, b_1, ... An attribute has no term of corner 0. The terms stand as the quad machine's.
module quadrille_interpolate #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS, PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int SETS = 3 + quadrille_pkg::ATTRIBUTE_SLOTS, TERMS = quadrille_pkg::BLEND_TERMS
) (
    input logic clk_i,
    input logic [3*E-1:0] m_exp_i,
    input logic [3*S-1:0] m_sig_i,
    input logic [TERMS-1:0] term_neg_i,
    input logic [TERMS*PE-1:0] term_exp_i,
    input logic [TERMS*S-1:0] term_sig_i,
    output logic [SETS-1:0] sum_neg_o,
    output logic [SETS*E-1:0] sum_exp_o,
    output logic [SETS*S-1:0] sum_sig_o
);
  localparam int TERM = quadrille_pkg::TERM_BITS, RANK = quadrille_pkg::RANK_BITS;

  for (genvar t = 0; t < SETS; t++) begin : gen_set
    localparam int CORNERS = (t < 3) ? 3 : 2, FIRST = (t < 3) ? 4 * t : 12 + 3 * (t - 3);
    logic [CORNERS*RANK-1:0] rank;
    logic [CORNERS-1:0] neg;
    logic [CORNERS*TERM-1:0] term;

    for (genvar c = 0; c < CORNERS; c++) begin : gen_corner
      localparam int V = 3 - CORNERS + c;
      quadrille_fp_term u_term (
          .clk_i, .neg_i(term_neg_i[FIRST+c]), .a_exp_i(m_exp_i[V*E+:E]), .a_sig_i(m_sig_i[V*S+:S]),
          .b_exp_i(E'($signed(term_exp_i[(FIRST+c)*PE+:PE]))), .b_sig_i(term_sig_i[(FIRST+c)*S+:S]),
          .rank_o(rank[c*RANK+:RANK]), .neg_o(neg[c]), .term_o(term[c*TERM+:TERM])
      );
    end

    quadrille_fp_sum #(.TERMS(CORNERS)) u_sum (
        .clk_i, .rank_i(rank), .neg_i(neg), .term_i(term), .neg_o(sum_neg_o[t]), .exp_o(sum_exp_o[t*E+:E]),
        .sig_o(sum_sig_o[t*S+:S])
    );
  end

  logic unused;
  assign unused = ^{term_neg_i, term_exp_i, term_sig_i};
endmodule
