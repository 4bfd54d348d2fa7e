// Suite `interpolation`: M, the four corners' k_eff, W, Z and three corners' b in, the `sum` boundary out.
module replay_interpolation (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"

  // sets: 0 k_eff, 1 W, 2 Z, 3.. attributes
  quadrille_interpolate u_interpolate (
      .term_neg_i({b_neg_i, z_neg_i, w_neg_i, k_neg_i}),
      .term_exp_i({b_exp_i, z_exp_i, w_exp_i, k_exp_i}),
      .term_sig_i({b_sig_i, z_sig_i, w_sig_i, k_sig_i}),
      .sum_neg_o({attr_neg_o, z_neg_o, den_w_neg_o, den_k_neg_o}),
      .sum_exp_o({attr_exp_o, z_exp_o, den_w_exp_o, den_k_exp_o}),
      .sum_sig_o({attr_sig_o, z_sig_o, den_w_sig_o, den_k_sig_o}),
      .*
  );

  replay_valid #(.LATENCY(quadrille_pkg::SUM_STAGE - quadrille_pkg::WEIGHT_STAGE)) u_valid (.*);
endmodule
