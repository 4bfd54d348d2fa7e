  // fragment_output: rtl/SPEC.md's rule for what leaves, in integers with bits to spare, of whatever the products' fixed point gives. Attribute: base and
  // quotient, rounded to nearest, halves away from zero; clamped to +-(2^(INT+FRAC)-1), flag 7 if it was. Depth: likewise, clamped to least and greatest;
  // discarded beyond those that cut, or if the quad is outside. Behind the eye nothing of a quad is drawn whose hull holds it.
  // From any contents of all registers, the latency on. Products and fixed point are left out (`cut`): their outputs are anything.
  // Assumed: no reset; of the limits the least is not above the greatest (quad_reject; where znear is above zfar all is discarded either way).
  always_comb assume (rst_ni);

  localparam int TO_SUM = quadrille_pkg::PRODUCT_STAGES + TO_FIXED;
  localparam int WIDE = 2 * (AO + DB) + 4;
  localparam int LIMIT_SHIFT = AO - 1;

  // {rounded quotient}, of fixed_point's outputs: magnitude with a bit that rounds, inverted where negative
  logic [WIDE-1:0] quotient, sum, limit, z_quotient, z_sum, least_wide, greatest_wide;
  logic attr_sign, zero_w, neg_w;
  logic [WIDE-1:0] attr_spec, attr_q1, attr_q2, attr_q3;
  logic flag_spec, flag_q1, flag_q2, flag_q3;
  logic [WIDE-1:0] z_q1, z_clamped, z_q2, z_q3;
  logic z_overflow_q1, z_high_q1, behind_q1, behind_q2;
  logic below_spec, beyond_spec, discard_spec_q2;
  logic valid_q3;

  quadrille_delay_line #(.WIDTH(1), .DEPTH(TO_FIXED)) u_attr_sign (.clk_i, .data_i(gen_attribute[0].prod_neg), .data_o(attr_sign));
  quadrille_delay_line #(.WIDTH(2), .DEPTH(TO_SUM)) u_w_spec (.clk_i, .data_i({rw_sig_i == '0, rw_neg_i}), .data_o({zero_w, neg_w}));

  assign limit = (WIDE'(1) << LIMIT_SHIFT) - WIDE'(1);
  assign quotient = (WIDE'(gen_attribute[0].fixed ^ {(AO + 1) {gen_attribute[0].neg}}) + WIDE'(1)) >> 1;
  assign sum = WIDE'($signed(base_attr_i)) + (gen_attribute[0].neg ? WIDE'(0) - quotient : quotient);
  assign z_quotient = (WIDE'(z_fixed ^ {(DB + 2) {z_neg}}) + WIDE'(1)) >> 1;
  assign z_sum = WIDE'(base_depth_i) + (z_neg ? WIDE'(0) - z_quotient : z_quotient);
  assign least_wide = WIDE'(depth_limits_i[DB+1+:DB+1]);
  assign greatest_wide = WIDE'(depth_limits_i[0+:DB+1]);

  always_comb begin
    attr_spec = sum;
    flag_spec = 1'b1;
    if (gen_attribute[0].overflow_d) attr_spec = attr_sign ? WIDE'(0) - limit : limit;
    else if ($signed(sum) > $signed(limit)) attr_spec = limit;
    else if ($signed(sum) < $signed(WIDE'(0) - limit)) attr_spec = WIDE'(0) - limit;
    else flag_spec = 1'b0;
    below_spec = z_overflow_q1 ? !z_high_q1 : $signed(z_q1) < $signed(least_wide);
    beyond_spec = z_overflow_q1 ? z_high_q1 : $signed(z_q1) > $signed(greatest_wide);
    z_clamped = below_spec ? least_wide : beyond_spec ? greatest_wide : z_q1;
  end

  always_ff @(posedge clk_i) begin
    {attr_q1, flag_q1} <= {attr_spec, flag_spec};
    {attr_q2, flag_q2} <= (attributes_i != '0) ? {attr_q1, flag_q1} : '0;
    {attr_q3, flag_q3} <= {attr_q2, flag_q2};
    z_q1 <= z_sum;
    z_overflow_q1 <= z_overflow || zero_w;
    z_high_q1 <= zero_w || !late_z_neg;
    {behind_q2, behind_q1} <= {behind_q1, zero_w || neg_w};
    z_q2 <= depth_on_i ? z_clamped : '0;
    discard_spec_q2 <= depth_on_i && (depth_limits_i[2*DB+4] || (below_spec && depth_limits_i[2*DB+3]) || (beyond_spec && depth_limits_i[2*DB+2]));
    z_q3 <= z_q2;
    valid_q3 <= valid_i && !discard_spec_q2 && !(hull_i && behind_q2);
  end

  always_comb begin
    assume (least_wide <= greatest_wide);
    assert (valid_o == valid_q3);
    assert (valid_o || fragment_o == '0);
    assert (!valid_o || WIDE'($signed(fragment_o[AO-1:0])) == attr_q3);
    assert (!valid_o || WIDE'(fragment_o[AO+:DB+1]) == z_q3);
    assert (!valid_o || fragment_o[AO+DB+8] == flag_q3);
  end
