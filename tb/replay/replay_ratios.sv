// Suite `ratios`: A, D (of NORM_STAGE) and rho (of RHO_STAGE) together in, the `ratio` boundary out.
module replay_ratios (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;

  logic [4*E-1:0] late_rho_exp;
  logic [4*S-1:0] late_rho_sig;

  delay_line #(.WIDTH(4 * (E + S)), .DEPTH(quadrille_pkg::RSQRT_STAGES)) u_rho (.clk_i, .data_i({rho_exp_i, rho_sig_i}), .data_o({late_rho_exp, late_rho_sig}));

  mean_value_ratios u_ratios (.rho_exp_i(late_rho_exp), .rho_sig_i(late_rho_sig), .*);

  replay_valid #(.LATENCY(quadrille_pkg::RATIO_STAGE - quadrille_pkg::NORM_STAGE)) u_valid (.*);
endmodule
