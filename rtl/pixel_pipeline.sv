// Everything behind the stamp FIFO: a pipeline of 26 registers with one enable, from a pixel's position to its fragment.
//
// Stage n's register is written n enabled clocks after emission (README.md section 5); names end in the stage of their register.
// en_o = the output register is free. Per-quad data is not carried: the slot index is, and the bank is read at the stage that needs
// it. An end beat (end, not valid) travels with the pixels; at the last register it releases its slot.
module pixel_pipeline #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS,
    localparam int ID = quadrille_pkg::QUAD_ID_BITS,
    localparam int FB = quadrille_pkg::FRAGMENT_BITS,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int OFFSET_DIGITS = TILE_LOG2 / 2 + 1,
    localparam int NORM_DIGITS = (2 * TILE_LOG2 + 1) / 2 + 1,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS,
    localparam int QCURV = quadrille_pkg::QCURV_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int SETS = 3 + N
) (
    input logic clk_i,
    input logic rst_ni,
    output logic en_o,
    // Draw state
    input logic depth_on_i,
    input logic [DB:0] znear_i,
    input logic [DB:0] zfar_i,
    input logic [3:0] attributes_i,
    // Emission
    input logic valid_i,
    input logic end_i,
    input logic [SLOT-1:0] slot_i,
    input logic [V-1:0] x_i,
    input logic [V-1:0] y_i,
    input logic [TILE_LOG2-1:0] row_i,
    input logic [TILE_LOG2-1:0] dx_i,
    input logic front_i,
    input logic tie_i,
    input logic [6*VAL-1:0] lin_value_i,
    input logic [6*GRAD-1:0] lin_gx_i,
    input logic [6*GRAD-1:0] lin_gy_i,
    input logic [10*QVAL-1:0] quad_value_i,
    input logic [10*QGRAD-1:0] quad_gx_i,
    input logic [10*QGRAD-1:0] quad_gy_i,
    input logic [10*QCURV-1:0] quad_q_i,
    // Slot bank
    output logic [SLOT-1:0] product_slot_o,
    input logic [3:0] product_k_neg_i,
    input logic [4*PE-1:0] product_k_exp_i,
    input logic [4*S-1:0] product_k_sig_i,
    output logic [SLOT-1:0] override_slot_o,
    input logic [4*PE-1:0] override_k_exp_i,
    input logic [4*S-1:0] override_k_sig_i,
    output logic [SLOT-1:0] blend_slot_o,
    input logic [SETS*4-1:0] blend_neg_i,
    input logic [SETS*4*PE-1:0] blend_exp_i,
    input logic [SETS*4*S-1:0] blend_sig_i,
    output logic [SLOT-1:0] output_slot_o,
    input logic [ID-1:0] output_id_i,
    input logic output_hull_i,
    input logic output_homogeneous_i,
    output logic release_o,
`ifdef QUADRILLE_PROBES
    output logic probe_diff_valid_o,
    output quadrille_pkg::probe_diff_t probe_diff_o,
    output logic probe_norm_valid_o,
    output quadrille_pkg::probe_norm_t probe_norm_o,
    output logic probe_rsqrt_valid_o,
    output quadrille_pkg::probe_rsqrt_t probe_rsqrt_o,
    output logic probe_ratio_valid_o,
    output quadrille_pkg::probe_ratio_t probe_ratio_o,
    output logic probe_weight_valid_o,
    output quadrille_pkg::probe_weight_t probe_weight_o,
    output logic probe_sum_valid_o,
    output quadrille_pkg::probe_sum_t probe_sum_o,
`endif
    // Fragment
    output logic fragment_valid_o,
    input logic fragment_ready_i,
    output logic [FB-1:0] fragment_o
);
  localparam int LAST = quadrille_pkg::LATENCY - 1;  // the output register

  logic en;
  logic [LAST-1:0] valid_q;  // stages 0 to 24; stage 25 is the output's own
  logic [LAST:0] end_q;

  assign en = !fragment_valid_o || fragment_ready_i;
  assign en_o = en;
  assign release_o = end_q[LAST] && en;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      valid_q <= '0;
      end_q <= '0;
    end else if (en) begin
      valid_q <= {valid_q[LAST-2:0], valid_i};
      end_q <= {end_q[LAST-1:0], end_i};
    end
  end

  // ---- Side band: slot, position, facing, tie, class ----------------------------------------------------------------------
  localparam int TAG = SLOT + 2 * V + 2;
  localparam int META = TAG + 13;
  logic [TAG-1:0] tag_1, tag_3;
  logic [META-1:0] meta_3, meta_10, meta_13, meta_14, meta_17, meta_24;
  logic [12:0] class_3;

  delay_line #(.WIDTH(TAG), .DEPTH(2)) u_tag_1 (
      .clk_i,
      .en_i(en),
      .data_i({slot_i, x_i, y_i, front_i, tie_i}),
      .data_o(tag_1)
  );
  delay_line #(.WIDTH(TAG), .DEPTH(2)) u_tag_3 (.clk_i, .en_i(en), .data_i(tag_1), .data_o(tag_3));
  delay_line #(.WIDTH(META), .DEPTH(7)) u_meta_10 (.clk_i, .en_i(en), .data_i(meta_3), .data_o(meta_10));
  delay_line #(.WIDTH(META), .DEPTH(3)) u_meta_13 (.clk_i, .en_i(en), .data_i(meta_10), .data_o(meta_13));
  delay_line #(.WIDTH(META), .DEPTH(1)) u_meta_14 (.clk_i, .en_i(en), .data_i(meta_13), .data_o(meta_14));
  delay_line #(.WIDTH(META), .DEPTH(3)) u_meta_17 (.clk_i, .en_i(en), .data_i(meta_14), .data_o(meta_17));
  delay_line #(.WIDTH(META), .DEPTH(7)) u_meta_24 (.clk_i, .en_i(en), .data_i(meta_17), .data_o(meta_24));

  assign meta_3 = {tag_3, class_3};
  assign product_slot_o = meta_10[META-1-:SLOT];
  assign override_slot_o = meta_14[META-1-:SLOT];
  assign blend_slot_o = meta_17[META-1-:SLOT];
  assign output_slot_o = meta_24[META-1-:SLOT];

  // ---- Stages 0, 1: exact functions at the pixel --------------------------------------------------------------------------
  logic [6*VAL-1:0] a_1;
  logic [10*QVAL-1:0] quad_1;
  logic [2*OFFSET_DIGITS-1:0] row_digits, dx_digits;
  logic [2*NORM_DIGITS-1:0] norm_digits;

  offset_digits u_offset (
      .row_i,
      .dx_i,
      .row_digits_o(row_digits),
      .dx_digits_o(dx_digits),
      .norm_digits_o(norm_digits)
  );

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    forward_difference #(
        .VALUE_BITS(VAL),
        .GRAD_BITS(GRAD),
        .QUADRATIC(1'b0)
    ) u_difference (
        .clk_i,
        .en_i(en),
        .row_digits_i(row_digits),
        .dx_digits_i(dx_digits),
        .norm_digits_i(norm_digits),
        .value_i(lin_value_i[g*VAL+:VAL]),
        .gx_i(lin_gx_i[g*GRAD+:GRAD]),
        .gy_i(lin_gy_i[g*GRAD+:GRAD]),
        .q_i(1'b0),
        .value_o(a_1[g*VAL+:VAL])
    );
  end

  for (genvar g = 0; g < 10; g++) begin : gen_quadratic
    forward_difference #(
        .VALUE_BITS(QVAL),
        .GRAD_BITS(QGRAD),
        .CURV_BITS(QCURV)
    ) u_difference (
        .clk_i,
        .en_i(en),
        .row_digits_i(row_digits),
        .dx_digits_i(dx_digits),
        .norm_digits_i(norm_digits),
        .value_i(quad_value_i[g*QVAL+:QVAL]),
        .gx_i(quad_gx_i[g*QGRAD+:QGRAD]),
        .gy_i(quad_gy_i[g*QGRAD+:QGRAD]),
        .q_i(quad_q_i[g*QCURV+:QCURV]),
        .value_o(quad_1[g*QVAL+:QVAL])
    );
  end

  // ---- Stages 2, 3: significand numbers and class -------------------------------------------------------------------------
  logic [5:0] a_neg_3, d_neg_3;
  logic [6*E-1:0] a_exp_3, d_exp_3;
  logic [6*S-1:0] a_sig_3, d_sig_3;
  logic [3:0] r2_neg_3;
  logic [4*E-1:0] r2_exp_3;
  logic [4*S-1:0] r2_sig_3;

  for (genvar g = 0; g < 6; g++) begin : gen_norm
    normalise #(
        .WIDTH(VAL),
        .BIAS(-quadrille_pkg::QDROP)
    ) u_a (
        .clk_i,
        .en_i(en),
        .value_i(a_1[g*VAL+:VAL]),
        .neg_o(a_neg_3[g]),
        .exp_o(a_exp_3[g*E+:E]),
        .sig_o(a_sig_3[g*S+:S])
    );

    normalise #(.WIDTH(QVAL)) u_d (
        .clk_i,
        .en_i(en),
        .value_i(quad_1[g*QVAL+:QVAL]),
        .neg_o(d_neg_3[g]),
        .exp_o(d_exp_3[g*E+:E]),
        .sig_o(d_sig_3[g*S+:S])
    );
  end

  for (genvar g = 0; g < 4; g++) begin : gen_norm_r2
    normalise #(
        .WIDTH(QVAL),
        .CLAMP(1'b1)
    ) u_r2 (
        .clk_i,
        .en_i(en),
        .value_i(quad_1[(6+g)*QVAL+:QVAL]),
        .neg_o(r2_neg_3[g]),
        .exp_o(r2_exp_3[g*E+:E]),
        .sig_o(r2_sig_3[g*S+:S])
    );
  end

  singular_class u_class (
      .clk_i,
      .en_i(en),
      .a_i(a_1[0+:4*VAL]),
      .d_i(quad_1[0+:4*QVAL]),
      .r2_i(quad_1[6*QVAL+:4*QVAL]),
      .class_o(class_3)
  );

  // ---- Stages 4 to 6: rho_i = 1/R_i ---------------------------------------------------------------------------------------
  logic [4*E-1:0] rho_exp_6;
  logic [4*S-1:0] rho_sig_6;

  for (genvar g = 0; g < 4; g++) begin : gen_rsqrt
    rsqrt u_rsqrt (
        .clk_i,
        .en_i(en),
        .exp_i(r2_exp_3[g*E+:E]),
        .sig_i(r2_sig_3[g*S+:S]),
        .exp_o(rho_exp_6[g*E+:E]),
        .sig_o(rho_sig_6[g*S+:S])
    );
  end

  // ---- Stages 7 to 17: ratios and weights ---------------------------------------------------------------------------------
  logic [6*E-1:0] n_exp_10, d_exp_10;
  logic [6*S-1:0] n_sig_10, d_sig_10;
  logic [4*E-1:0] m_exp_17;
  logic [4*S-1:0] m_sig_17;

  mean_value_ratios u_ratios (
      .clk_i,
      .en_i(en),
      .a_exp_i(a_exp_3),
      .a_sig_i(a_sig_3),
      .d_neg_i(d_neg_3),
      .d_exp_i(d_exp_3),
      .d_sig_i(d_sig_3),
      .rho_exp_i(rho_exp_6),
      .rho_sig_i(rho_sig_6),
      .n_exp_o(n_exp_10),
      .n_sig_o(n_sig_10),
      .d_exp_o(d_exp_10),
      .d_sig_o(d_sig_10)
  );

  mean_value_weights u_weights (
      .clk_i,
      .en_i(en),
      .rho_exp_i(rho_exp_6),
      .rho_sig_i(rho_sig_6),
      .n_exp_i(n_exp_10),
      .n_sig_i(n_sig_10),
      .d_exp_i(d_exp_10),
      .d_sig_i(d_sig_10),
      .class_10_i(meta_10[12:0]),
      .k_neg_10_i(product_k_neg_i),
      .k_exp_10_i(product_k_exp_i),
      .k_sig_10_i(product_k_sig_i),
      .class_13_i(meta_13[12:0]),
      .class_14_i(meta_14[12:0]),
      .k_exp_14_i(override_k_exp_i),
      .k_sig_14_i(override_k_sig_i),
      .m_exp_o(m_exp_17),
      .m_sig_o(m_sig_17)
  );

  // ---- Stages 18 to 20: sums. Sets: 0 k_eff, 1 W, 2 Z, 3.. attributes ------------------------------------------------------
  logic [SETS-1:0] sum_neg_20;
  logic [SETS*E-1:0] sum_exp_20;
  logic [SETS*S-1:0] sum_sig_20;

  interpolate u_interpolate (
      .clk_i,
      .en_i(en),
      .m_exp_i(m_exp_17),
      .m_sig_i(m_sig_17),
      .term_neg_i(blend_neg_i),
      .term_exp_i(blend_exp_i),
      .term_sig_i(blend_sig_i),
      .sum_neg_o(sum_neg_20),
      .sum_exp_o(sum_exp_20),
      .sum_sig_o(sum_sig_20)
  );

  // ---- Stages 21 to 23: reciprocals, the numerators wait ------------------------------------------------------------------
  localparam int NUMS = 1 + N;  // Z and the attributes
  logic rk_neg_23, rw_neg_23;
  logic [E-1:0] rk_exp_23, rw_exp_23;
  logic [S-1:0] rk_sig_23, rw_sig_23;
  logic [NUMS-1:0] num_neg_23;
  logic [NUMS*E-1:0] num_exp_23;
  logic [NUMS*S-1:0] num_sig_23;

  reciprocal u_reciprocal_k (
      .clk_i,
      .en_i(en),
      .neg_i(sum_neg_20[0]),
      .exp_i(sum_exp_20[0+:E]),
      .sig_i(sum_sig_20[0+:S]),
      .neg_o(rk_neg_23),
      .exp_o(rk_exp_23),
      .sig_o(rk_sig_23)
  );

  reciprocal u_reciprocal_w (
      .clk_i,
      .en_i(en),
      .neg_i(sum_neg_20[1]),
      .exp_i(sum_exp_20[E+:E]),
      .sig_i(sum_sig_20[S+:S]),
      .neg_o(rw_neg_23),
      .exp_o(rw_exp_23),
      .sig_o(rw_sig_23)
  );

  for (genvar g = 0; g < NUMS; g++) begin : gen_numerator
    delay_line #(.WIDTH(1 + E + S), .DEPTH(3)) u_delay (
        .clk_i,
        .en_i(en),
        .data_i({sum_neg_20[2+g], sum_exp_20[(2+g)*E+:E], sum_sig_20[(2+g)*S+:S]}),
        .data_o({num_neg_23[g], num_exp_23[g*E+:E], num_sig_23[g*S+:S]})
    );
  end

  // ---- Stages 24, 25: quotients, output -----------------------------------------------------------------------------------
  fragment_output u_output (
      .clk_i,
      .rst_ni,
      .en_i(en),
      .depth_on_i,
      .znear_i,
      .zfar_i,
      .attributes_i,
      .attr_neg_i(num_neg_23[NUMS-1:1]),
      .attr_exp_i(num_exp_23[NUMS*E-1:E]),
      .attr_sig_i(num_sig_23[NUMS*S-1:S]),
      .z_neg_i(num_neg_23[0]),
      .z_exp_i(num_exp_23[E-1:0]),
      .z_sig_i(num_sig_23[S-1:0]),
      .rk_neg_i(rk_neg_23),
      .rk_exp_i(rk_exp_23),
      .rk_sig_i(rk_sig_23),
      .rw_neg_i(rw_neg_23),
      .rw_exp_i(rw_exp_23),
      .rw_sig_i(rw_sig_23),
      .valid_24_i(valid_q[LAST-1]),
      .id_i(output_id_i),
      .hull_i(output_hull_i),
      .homogeneous_i(output_homogeneous_i),
      .x_i(meta_24[15+V+:V]),
      .y_i(meta_24[15+:V]),
      .front_i(meta_24[14]),
      .tie_i(meta_24[13]),
      .class_i(meta_24[12:0]),
      .valid_o(fragment_valid_o),
      .fragment_o
  );

  logic unused;
  assign unused = ^{r2_neg_3, a_neg_3, meta_10[META-SLOT-1:13], meta_13[META-1:13], meta_14[META-SLOT-1:13],
      meta_17[META-SLOT-1:0]};

`ifdef QUADRILLE_PROBES
  // ---- Probes -------------------------------------------------------------------------------------------------------------
  assign probe_diff_valid_o = valid_q[1];
  assign probe_diff_o = {tag_1, a_1, quad_1[0+:6*QVAL], quad_1[6*QVAL+:4*QVAL]};
  assign probe_norm_valid_o = valid_q[3];
  assign probe_norm_o = {class_3[12:9], a_neg_3, a_exp_3, a_sig_3, d_neg_3, d_exp_3, d_sig_3, r2_exp_3, r2_sig_3};
  assign probe_rsqrt_valid_o = valid_q[6];
  assign probe_rsqrt_o = {rho_exp_6, rho_sig_6};
  assign probe_ratio_valid_o = valid_q[10];
  assign probe_ratio_o = {n_exp_10, n_sig_10, d_exp_10, d_sig_10};
  assign probe_weight_valid_o = valid_q[17];
  assign probe_weight_o = {m_exp_17, m_sig_17};
  assign probe_sum_valid_o = valid_q[20];
  assign probe_sum_o = {
    sum_neg_20[SETS-1:3],
    sum_exp_20[SETS*E-1:3*E],
    sum_sig_20[SETS*S-1:3*S],
    sum_neg_20[2],
    sum_exp_20[2*E+:E],
    sum_sig_20[2*S+:S],
    sum_neg_20[0],
    sum_exp_20[0+:E],
    sum_sig_20[0+:S],
    sum_neg_20[1],
    sum_exp_20[E+:E],
    sum_sig_20[S+:S]
  };
`endif

`ifndef SYNTHESIS
  // Output port: valid held and payload stable under stall; zero when not valid. An end beat carries no pixel.
  logic held_q;
  logic [FB-1:0] fragment_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= 1'b0;
    end else begin
      held_q <= fragment_valid_o && !fragment_ready_i;
      fragment_q <= fragment_o;
      assert (!held_q || (fragment_valid_o && fragment_o == fragment_q));
      assert (fragment_valid_o || fragment_o == '0);
      assert ((valid_q & end_q[LAST-1:0]) == '0);
      assert (!(fragment_valid_o && end_q[LAST]));
      assert (!valid_q[3] || ((class_3[12:9] & (class_3[12:9] - 4'd1)) == '0));
    end
  end
`endif
endmodule
