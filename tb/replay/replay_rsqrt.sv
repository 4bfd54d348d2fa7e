// Suite `rsqrt`: four r^2 in, their four rho out. Latency 3.
module replay_rsqrt #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int STIMULUS_BITS = 4 * (E + S),
    localparam int RESPONSE_BITS = 4 * (E + S)
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

  logic [4*E-1:0] exp, rho_exp;
  logic [4*S-1:0] sig, rho_sig;

  assign {exp, sig} = stimulus_i;
  assign response_o = {rho_exp, rho_sig};

  for (genvar g = 0; g < 4; g++) begin : gen_rsqrt
    rsqrt u_rsqrt (
        .clk_i,
        .en_i(1'b1),
        .exp_i(exp[g*E+:E]),
        .sig_i(sig[g*S+:S]),
        .exp_o(rho_exp[g*E+:E]),
        .sig_o(rho_sig[g*S+:S])
    );
  end

  replay_valid #(.LATENCY(LATENCY)) u_valid (.clk_i, .rst_ni, .valid_i, .ready_o, .valid_o);
endmodule
