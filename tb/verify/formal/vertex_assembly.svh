  // vertex_assembly: four accepted beats are a quad, each with its own vertex, all of its fields and its W as a significand number among them (of the
  // first vertex no attributes), and id, bases and corner codes of the first beat; the quad is stable until it is taken; nothing is lost or taken twice; ready whenever there is room, so no deadlock. flush_i discards
  // the beats of a quad that is not full, one that comes with it among them, and nothing of a full one. The judgements of a quad do not change while it is
  // held. Of the
  // beats so far: least and greatest X and Y are those of some vertex and none is beyond; ordinary if and only if every W is ONE; behind_o, a
  // judgement of quad_reject, if and only if none is positive. (empty_o: proof range_empty; depth_o and limits_o: proof quad_reject; the interval:
  // proof depth_interval.)
  // By induction, with one vertex of the four chosen freely and kept.
  // Assumed: reset at the start and no more; leave_i only of a full quad (quadrille_front: move and drop_vertices have full in them); the draw state does
  // not change (quadrille asserts it).
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  (* anyconst *) logic [1:0] which;
  localparam int V = quadrille_pkg::VIEWPORT_BITS;
  localparam int DB = quadrille_pkg::DEPTH_BITS;
  localparam int CODE = quadrille_pkg::CORNER_DEPTH_BITS;
  localparam int BASE = quadrille_pkg::ATTRIBUTE_SLOTS * quadrille_pkg::ATTR_OUT_BITS;
  localparam int KEPT = 2 * T + W + 2 * (PE + S) + 1 + ATTR;
  localparam int OF_QUAD = quadrille_pkg::QUAD_ID_BITS + BASE + DB + 1 + 2 * CODE;
  logic [2:0] held_q, ones_q, positive_q;  // beats in; those of them whose W is ONE, is positive
  logic [KEPT-1:0] kept_q, there;
  logic [W-1:0] kept_w;
  logic [OF_QUAD-1:0] of_quad_q;
  logic have;
  logic stays_q;
  logic [2:0] judged_q;
  localparam int STATE = 1 + 2 * (DB + 1) + 4 * (V + 1);
  logic [STATE-1:0] state_q;
  logic [2:0] after_leave;  // full, and not taken in this clock: 4

  assign after_leave = leave_i ? 3'd0 : held_q;
  assign have = held_q > {1'b0, which};
  assign kept_w = kept_q[2*(PE+S)+1+ATTR+:W];

  always_ff @(posedge clk_i) begin
    stays_q <= rst_ni && full_o && !leave_i;
    judged_q <= {empty_o, behind_o, depth_o};
    state_q <= {state.depth, state.znear, state.zfar, state.scissor_x0, state.scissor_y0, state.scissor_x1, state.scissor_y1};
    if (!rst_ni) begin
      held_q <= '0;
    end else begin
      held_q <= (flush_i && after_leave != 3'd4) ? 3'd0 : after_leave + 3'(accept);
      if (accept && after_leave == 3'd0) begin
        of_quad_q <= {vertex.id, vertex.base_attr, vertex.base_depth, vertex.depth_low, vertex.depth_high};
      end
      if (accept) ones_q <= ((after_leave == 3'd0) ? 3'd0 : ones_q) + 3'(vertex.w == W'(1 << quadrille_pkg::FRAC));
      if (accept) positive_q <= ((after_leave == 3'd0) ? 3'd0 : positive_q) + 3'($signed(vertex.w) > 0);
      if (accept && after_leave == {1'b0, which}) begin
        kept_q <= {vertex.x, vertex.y, vertex.w, vertex.k_exp, vertex.k_sig, vertex.z_neg, vertex.z_exp, vertex.z_sig,
                   (which == 2'd0) ? ATTR'(0) : vertex.attr};
      end
    end
  end

  // The chosen vertex at the outputs; and of its W, fp_from_magnitude of rtl/SPEC.md, Numbers
  logic w_neg_there;
  logic [PE-1:0] w_exp_there, w_exp_spec;
  logic [S-1:0] w_sig_there, w_sig_spec;
  logic [W-1:0] kept_magnitude;

  assign kept_magnitude = kept_w[W-1] ? -kept_w : kept_w;

  always_comb begin
    there = '0;
    {w_neg_there, w_exp_there, w_sig_there} = '0;
    for (int v = 0; v < 4; v++) begin
      if (which == 2'(v)) begin
        there = {x[v*T+:T], y[v*T+:T], w[v*W+:W], k_exp[v*PE+:PE], k_sig[v*S+:S], z_neg[v], z_exp[v*PE+:PE], z_sig[v*S+:S], ATTR'(0)};
        if (v != 0) there[0+:ATTR] = attr[((v == 0) ? 0 : v - 1)*ATTR+:ATTR];
        {w_neg_there, w_exp_there, w_sig_there} = {w_negs[v], w_exp[PE-1:0], w_sig};
        if (held_q != 3'(v + 1)) {w_exp_there, w_sig_there} = {w_exps[(v%3)*PE+:PE], w_sigs[(v%3)*S+:S]};  // in its register
      end
    end
    {w_exp_spec, w_sig_spec} = '0;
    for (int p = 0; p < W; p++) begin  // the last that is set: the highest one
      if (kept_magnitude[p]) begin
        w_exp_spec = PE'(p - quadrille_pkg::FRAC);
        w_sig_spec = S'(((W + S)'(kept_magnitude) << S) >> (p + 1));
      end
    end
  end

  // Box of the beats so far, from the vertices at the outputs
  logic [3:0] is_low_x, is_high_x, is_low_y, is_high_y, inside;  // of a vertex that is in

  always_comb begin
    for (int v = 0; v < 4; v++) begin
      is_low_x[v] = held_q > 3'(v) && low_x == x[v*T+:T];
      is_high_x[v] = held_q > 3'(v) && high_x == x[v*T+:T];
      is_low_y[v] = held_q > 3'(v) && low_y == y[v*T+:T];
      is_high_y[v] = held_q > 3'(v) && high_y == y[v*T+:T];
      inside[v] = held_q <= 3'(v) || ($signed(low_x) <= $signed(x[v*T+:T]) && $signed(x[v*T+:T]) <= $signed(high_x) &&
                                      $signed(low_y) <= $signed(y[v*T+:T]) && $signed(y[v*T+:T]) <= $signed(high_y));
    end
  end

  always_comb begin
    if (rst_ni) begin
      assume (!leave_i || full_o);
      assume ({state.depth, state.znear, state.zfar, state.scissor_x0, state.scissor_y0, state.scissor_x1, state.scissor_y1} == state_q);
      assert (held_q <= 3'd4);
      assert (full_o == (held_q == 3'd4));
      assert (busy_o == (held_q != 3'd0));
      assert (vertex_ready_o == (held_q != 3'd4 || leave_i));
      assert (!have || there == kept_q);
      assert (!have || {w_neg_there, w_exp_there, w_sig_there} == {kept_w[W-1], w_exp_spec, w_sig_spec});
      assert (held_q == 3'd0 || {id, base_attr, base_depth, depth_low, depth_high} == of_quad_q);
      assert (held_q == 3'd0 || (is_low_x != '0 && is_high_x != '0 && is_low_y != '0 && is_high_y != '0));
      assert (inside == '1);
      assert (!stays_q || {empty_o, behind_o, depth_o} == judged_q);
      assert (held_q == 3'd0 || ordinary == (ones_q == held_q));
      assert (held_q == 3'd0 || behind_o == (positive_q == 3'd0));
      // Invariants
      assert (count_q == held_q[1:0]);
      assert (held_q == 3'd0 || (ones_q <= held_q && positive_q <= held_q));
    end
  end
