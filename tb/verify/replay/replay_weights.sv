// Suite `weights`: signs, k_eff, r (of ROOT_STAGE), u and v (of RATIO_STAGE) together in, the `weight` boundary out.
//
// The class word is singular_class's, from integers that have the signs given: A = -1, 0, 1, D = -1 or 1, r^2 = 0 or 1.
module replay_weights (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;
  localparam int PE = quadrille_pkg::PORT_EXP_BITS;
  localparam int VAL = quadrille_pkg::VAL_BITS;
  localparam int QVAL = quadrille_pkg::QVAL_BITS;
  localparam int CLASS = quadrille_pkg::CLASS_BITS;

  // ---- Class -----------------------------------------------------------------------------------------------------------
  logic [4*VAL-1:0] a;
  logic [4*QVAL-1:0] d, r2;
  logic [CLASS-1:0] early_class, ratio_class;
  logic unused_corner;

  for (genvar g = 0; g < 4; g++) begin : gen_sign
    assign a[g*VAL+:VAL] = {{(VAL - 1) {a_sign_i[2*g+1]}}, a_sign_i[2*g]};
    assign d[g*QVAL+:QVAL] = {{(QVAL - 1) {d_negative_i[g]}}, 1'b1};
    assign r2[g*QVAL+:QVAL] = QVAL'(!corner_i[g]);
  end

  quadrille_singular_class u_class (
      .clk_i,
      .active_i(1'b1),
      .a_i(a),
      .d_i(d),
      .r2_i(r2),
      .corner_o(unused_corner),
      .class_o(early_class)
  );

  // ---- Each input to its stage ---------------------------------------------------------------------------------------------
  localparam int TO_RATIO = quadrille_pkg::RATIO_STAGE - quadrille_pkg::ROOT_STAGE;
  localparam int TO_OVERRIDE = quadrille_pkg::OVERRIDE_STAGE - 1 - quadrille_pkg::RATIO_STAGE;
  localparam int K = 4 * (1 + PE + S);
  logic [6*E-1:0] u_exp, v_exp;
  logic [6*S-1:0] u_sig, v_sig;
  logic [5:0] d_neg;
  logic [3:0] k_neg, override_k_neg;
  logic [4*PE-1:0] k_exp, override_k_exp;
  logic [4*S-1:0] k_sig, override_k_sig;
  logic unused, count_area;

  quadrille_delay_line #(.WIDTH(CLASS), .DEPTH(TO_RATIO - quadrille_pkg::NORMALISE_STAGES)) u_class_ratio (
      .clk_i, .data_i(early_class), .data_o(ratio_class));
  quadrille_delay_line #(.WIDTH(12 * (E + S)), .DEPTH(TO_RATIO)) u_ratio (
      .clk_i, .data_i({u_exp_i, u_sig_i, v_exp_i, v_sig_i}), .data_o({u_exp, u_sig, v_exp, v_sig}));
  quadrille_delay_line #(.WIDTH(6), .DEPTH(TO_RATIO)) u_d_neg (.clk_i, .data_i(d_negative_i), .data_o(d_neg));
  quadrille_delay_line #(.WIDTH(K), .DEPTH(TO_RATIO)) u_k (
      .clk_i, .data_i({k_neg_i, k_exp_i, k_sig_i}), .data_o({k_neg, k_exp, k_sig}));
  quadrille_delay_line #(.WIDTH(K), .DEPTH(TO_OVERRIDE)) u_override_k (
      .clk_i, .data_i({k_neg, k_exp, k_sig}), .data_o({override_k_neg, override_k_exp, override_k_sig}));

  assign unused = ^{override_k_neg, count_area};  // overrides take the magnitude

  quadrille_mean_value_weights u_weights (
      .clk_i,
      .root_exp_i,
      .root_sig_i,
      .u_exp_i(u_exp),
      .u_sig_i(u_sig),
      .v_exp_i(v_exp),
      .v_sig_i(v_sig),
      .d_neg_i(d_neg),
      .class_i(ratio_class),
      .plane_i(1'b0),
      .behind_diagonal_i(1'b0),
      .k_neg_i(k_neg),
      .k_exp_i(k_exp),
      .k_sig_i(k_sig),
      .override_k_exp_i(override_k_exp),
      .override_k_sig_i(override_k_sig),
      .count_area_o(count_area),
      .m_exp_o(exp_o),
      .m_sig_o(sig_o)
  );

  replay_valid #(.LATENCY(quadrille_pkg::WEIGHT_STAGE - quadrille_pkg::ROOT_STAGE)) u_valid (.*);
endmodule
