  // vertex_assembly: four accepted beats are a quad, each with its own vertex, the id of the first; the quad is stable until it is taken or
  // dropped; nothing is lost or taken twice; ready whenever there is room, so no deadlock; least and greatest X and Y, all W are ONE.
  // By induction, with one vertex of the four chosen freely and kept.
  // Assumed of the user: start or drop only of a full quad.
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  (* anyconst *) logic [1:0] which;
  logic [2:0] held_q;  // beats in
  logic [T-1:0] kept_x_q, kept_y_q;
  logic [W-1:0] kept_w_q;
  logic [PE+S-1:0] kept_k_q;
  logic [ATTR-1:0] kept_attr_q;
  logic [quadrille_pkg::QUAD_ID_BITS-1:0] kept_id_q;
  logic have;
  logic [2:0] after_leave;

  assign after_leave = (start_i || drop_i) ? 3'd0 : held_q;
  assign have = held_q > {1'b0, which};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= '0;
    end else begin
      held_q <= after_leave + 3'(accept);
      if (accept && after_leave == 3'd0) kept_id_q <= vertex.id;
      if (accept && after_leave == {1'b0, which}) begin
        kept_x_q <= vertex.x;
        kept_y_q <= vertex.y;
        kept_w_q <= vertex.w;
        kept_k_q <= {vertex.k_exp, vertex.k_sig};
        kept_attr_q <= vertex.attr;
      end
    end
  end

  logic [T-1:0] x_which, y_which;
  logic [W-1:0] w_which;
  logic [PE+S-1:0] k_which;
  logic [ATTR-1:0] attr_which;

  always_comb begin
    x_which = '0;
    y_which = '0;
    w_which = '0;
    k_which = '0;
    attr_which = '0;
    for (int v = 0; v < 4; v++) begin
      if (which == 2'(v)) begin
        x_which = x_o[v*T+:T];
        y_which = y_o[v*T+:T];
        w_which = w_o[v*W+:W];
        k_which = {k_exp_o[v*PE+:PE], k_sig_o[v*S+:S]};
        attr_which = attr_o[v*ATTR+:ATTR];
      end
    end
  end

  always_comb begin
    if (rst_ni) begin
      assume (!(start_i || drop_i) || full_o);
      assert (held_q <= 3'd4);
      assert (full_o == (held_q == 3'd4));
      assert (busy_o == (held_q != 3'd0));
      assert (vertex_ready_o == (held_q != 3'd4 || start_i || drop_i));
      assert (!have || {x_which, y_which, w_which, k_which, attr_which} == {kept_x_q, kept_y_q, kept_w_q, kept_k_q, kept_attr_q});
      assert (held_q == 3'd0 || id_o == kept_id_q);
      assert (!have || ($signed(low_x_o) <= $signed(kept_x_q) && $signed(kept_x_q) <= $signed(high_x_o)));
      assert (!have || ($signed(low_y_o) <= $signed(kept_y_q) && $signed(kept_y_q) <= $signed(high_y_o)));
      assert (!have || !ordinary_o || kept_w_q == ONE);
      // Invariant
      assert (count_q == held_q[1:0]);
    end
  end
