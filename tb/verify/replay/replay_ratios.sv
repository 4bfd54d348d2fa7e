// Suite `ratios`: A, D (of NORM_STAGE) and r (of ROOT_STAGE) together in, the `ratio` boundary out.
module replay_ratios (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;

  logic [4*E-1:0] late_root_exp;
  logic [4*S-1:0] late_root_sig;

  quadrille_delay_line #(.WIDTH(4 * (E + S)), .DEPTH(quadrille_pkg::SQRT_STAGES)) u_root (.clk_i, .data_i({root_exp_i, root_sig_i}), .data_o({late_root_exp, late_root_sig}));

  logic unused;
  assign unused = ^d_neg_i;  // |D|

  quadrille_mean_value_ratios u_ratios (.root_exp_i(late_root_exp), .root_sig_i(late_root_sig), .*);

  replay_valid #(.LATENCY(quadrille_pkg::RATIO_STAGE - quadrille_pkg::NORM_STAGE)) u_valid (.*);
endmodule
