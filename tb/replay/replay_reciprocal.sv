// Suite `reciprocal`: a number in, its reciprocal out. Latency 3.
module replay_reciprocal #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int STIMULUS_BITS = 1 + E + S,
    localparam int RESPONSE_BITS = 1 + E + S
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

  logic neg, result_neg;
  logic [E-1:0] exp, result_exp;
  logic [S-1:0] sig, result_sig;

  assign {neg, exp, sig} = stimulus_i;
  assign response_o = {result_neg, result_exp, result_sig};

  reciprocal u_reciprocal (
      .clk_i,
      .en_i(1'b1),
      .neg_i(neg),
      .exp_i(exp),
      .sig_i(sig),
      .neg_o(result_neg),
      .exp_o(result_exp),
      .sig_o(result_sig)
  );

  replay_valid #(.LATENCY(LATENCY)) u_valid (.clk_i, .rst_ni, .valid_i, .ready_o, .valid_o);
endmodule
