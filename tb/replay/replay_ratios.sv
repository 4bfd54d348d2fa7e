// Suite `ratios`: A, D (stage 3) and rho (stage 6) together in, the `ratio` boundary out. Latency 7, stages 4 to 10.
module replay_ratios (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;

  logic [4*E-1:0] rho_exp_6;
  logic [4*S-1:0] rho_sig_6;

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(3)) u_rho_6 (.clk_i, .en_i(1'b1), .data_i({rho_exp_i, rho_sig_i}), .data_o({rho_exp_6, rho_sig_6}));

  mean_value_ratios u_ratios (.en_i(1'b1), .rho_exp_i(rho_exp_6), .rho_sig_i(rho_sig_6), .*);

  replay_valid #(.LATENCY(7)) u_valid (.*);
endmodule
