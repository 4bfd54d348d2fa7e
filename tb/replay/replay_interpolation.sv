// Suite `interpolation`: M and the four corners' k_eff, W, Z, b in, the `sum` boundary out. Latency 3, stages 18 to 20.
module replay_interpolation #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int SETS = 3 + N,
    localparam int STIMULUS_BITS = 4 * (E + S) + SETS * 4 * (1 + PE + S),
    localparam int RESPONSE_BITS = SETS * (1 + E + S)
) (
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    input logic [STIMULUS_BITS-1:0] stimulus_i,
    output logic valid_o,
    output logic [RESPONSE_BITS-1:0] response_o
);
  localparam int LATENCY = 3;

  logic [4*E-1:0] m_exp;
  logic [4*S-1:0] m_sig;
  logic [3:0] k_neg, w_neg, z_neg;
  logic [4*PE-1:0] k_exp, w_exp, z_exp;
  logic [4*S-1:0] k_sig, w_sig, z_sig;
  logic [4*N-1:0] b_neg;
  logic [4*N*PE-1:0] b_exp;
  logic [4*N*S-1:0] b_sig;
  logic [SETS-1:0] neg;
  logic [SETS*E-1:0] exp;
  logic [SETS*S-1:0] sig;

  assign {m_exp, m_sig, k_neg, k_exp, k_sig, w_neg, w_exp, w_sig, z_neg, z_exp, z_sig, b_neg, b_exp, b_sig} = stimulus_i;
  // sets: 0 k_eff, 1 W, 2 Z, 3.. attributes
  assign response_o = {
    neg[SETS-1:3],
    exp[SETS*E-1:3*E],
    sig[SETS*S-1:3*S],
    neg[2],
    exp[2*E+:E],
    sig[2*S+:S],
    neg[0],
    exp[0+:E],
    sig[0+:S],
    neg[1],
    exp[E+:E],
    sig[S+:S]
  };

  interpolate u_interpolate (
      .clk_i,
      .en_i(1'b1),
      .m_exp_i(m_exp),
      .m_sig_i(m_sig),
      .term_neg_i({b_neg, z_neg, w_neg, k_neg}),
      .term_exp_i({b_exp, z_exp, w_exp, k_exp}),
      .term_sig_i({b_sig, z_sig, w_sig, k_sig}),
      .sum_neg_o(neg),
      .sum_exp_o(exp),
      .sum_sig_o(sig)
  );

  replay_valid #(.LATENCY(LATENCY)) u_valid (.clk_i, .rst_ni, .valid_i, .ready_o, .valid_o);
endmodule
