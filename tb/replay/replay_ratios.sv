// Suite `ratios`: A, D (stage 3) and rho (stage 6) together in, the `ratio` boundary out. Latency 7, stages 4 to 10.
module replay_ratios #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int STIMULUS_BITS = 6 + 16 * (E + S),
    localparam int RESPONSE_BITS = 12 * (E + S)
) (
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    input logic [STIMULUS_BITS-1:0] stimulus_i,
    output logic valid_o,
    output logic [RESPONSE_BITS-1:0] response_o
);
  localparam int LATENCY = 7;

  logic [6*E-1:0] a_exp, d_exp, n_exp, result_d_exp;
  logic [6*S-1:0] a_sig, d_sig, n_sig, result_d_sig;
  logic [5:0] d_neg;
  logic [4*(E+S)-1:0] rho, rho_6;

  assign {a_exp, a_sig, d_neg, d_exp, d_sig, rho} = stimulus_i;
  assign response_o = {n_exp, n_sig, result_d_exp, result_d_sig};

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(3)) u_rho_6 (.clk_i, .en_i(1'b1), .data_i(rho), .data_o(rho_6));

  mean_value_ratios u_ratios (
      .clk_i,
      .en_i(1'b1),
      .a_exp_i(a_exp),
      .a_sig_i(a_sig),
      .d_neg_i(d_neg),
      .d_exp_i(d_exp),
      .d_sig_i(d_sig),
      .rho_exp_i(rho_6[4*S+:4*E]),
      .rho_sig_i(rho_6[0+:4*S]),
      .n_exp_o(n_exp),
      .n_sig_o(n_sig),
      .d_exp_o(result_d_exp),
      .d_sig_o(result_d_sig)
  );

  replay_valid #(.LATENCY(LATENCY)) u_valid (.clk_i, .rst_ni, .valid_i, .ready_o, .valid_o);
endmodule
