// Suite `weights`: signs, k_eff, rho (stage 6), n and d (stage 10) together in, the `weight` boundary out. Latency 11, stages 7 to 17.
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

  // ---- Class -----------------------------------------------------------------------------------------------------------
  logic [4*VAL-1:0] a;
  logic [4*QVAL-1:0] d, r2;
  logic [12:0] class_8, class_10, class_13, class_14;

  for (genvar g = 0; g < 4; g++) begin : gen_sign
    assign a[g*VAL+:VAL] = {{(VAL - 1) {a_sign_i[2*g+1]}}, a_sign_i[2*g]};
    assign d[g*QVAL+:QVAL] = {{(QVAL - 1) {d_negative_i[g]}}, 1'b1};
    assign r2[g*QVAL+:QVAL] = QVAL'(!corner_i[g]);
  end

  singular_class u_class (
      .clk_i,
      .en_i(1'b1),
      .a_i(a),
      .d_i(d),
      .r2_i(r2),
      .class_o(class_8)
  );

  // ---- Each input to its stage ---------------------------------------------------------------------------------------------
  logic [4*(1+PE+S)-1:0] k_10, k_14;
  logic [12*(E+S)-1:0] ratio_10;

  delay_line #(.WIDTH(13), .DEPTH(2)) u_class_10 (.clk_i, .en_i(1'b1), .data_i(class_8), .data_o(class_10));
  delay_line #(.WIDTH(13), .DEPTH(3)) u_class_13 (.clk_i, .en_i(1'b1), .data_i(class_10), .data_o(class_13));
  delay_line #(.WIDTH(13), .DEPTH(1)) u_class_14 (.clk_i, .en_i(1'b1), .data_i(class_13), .data_o(class_14));
  delay_line #(.WIDTH(12 * (E + S)), .DEPTH(4)) u_ratio_10 (.clk_i, .en_i(1'b1), .data_i({n_exp_i, n_sig_i, d_exp_i, d_sig_i}), .data_o(ratio_10));
  delay_line #(.WIDTH(4 * (1 + PE + S)), .DEPTH(4)) u_k_10 (.clk_i, .en_i(1'b1), .data_i({k_neg_i, k_exp_i, k_sig_i}), .data_o(k_10));
  delay_line #(.WIDTH(4 * (1 + PE + S)), .DEPTH(4)) u_k_14 (.clk_i, .en_i(1'b1), .data_i(k_10), .data_o(k_14));

  logic [6*E-1:0] n_exp_10, d_exp_10;
  logic [6*S-1:0] n_sig_10, d_sig_10;
  logic [3:0] k_neg_10, k_neg_14;
  logic [4*PE-1:0] k_exp_10, k_exp_14;
  logic [4*S-1:0] k_sig_10, k_sig_14;
  logic unused;

  assign {n_exp_10, n_sig_10, d_exp_10, d_sig_10} = ratio_10;
  assign {k_neg_10, k_exp_10, k_sig_10} = k_10;
  assign {k_neg_14, k_exp_14, k_sig_14} = k_14;
  assign unused = ^k_neg_14;  // overrides take the magnitude

  mean_value_weights u_weights (
      .en_i(1'b1),
      .n_exp_i(n_exp_10),
      .n_sig_i(n_sig_10),
      .d_exp_i(d_exp_10),
      .d_sig_i(d_sig_10),
      .class_10_i(class_10),
      .k_neg_10_i(k_neg_10),
      .k_exp_10_i(k_exp_10),
      .k_sig_10_i(k_sig_10),
      .class_13_i(class_13),
      .class_14_i(class_14),
      .k_exp_14_i(k_exp_14),
      .k_sig_14_i(k_sig_14),
      .m_exp_o(exp_o),
      .m_sig_o(sig_o),
      .*
  );

  replay_valid #(.LATENCY(11)) u_valid (.*);
endmodule
