  // gradient_bank: from a quad's take to the next take of its slot its gradients, ties and visibility come out of both read ports.
  // By induction: one quad, tagged at any take, is followed.
  logic first_q = 1'b1;
  always_ff @(posedge clk_i) first_q <= 1'b0;

  (* anyseq *) logic choose;
  logic live_q, tag, emit_q1, stamp_q1;
  logic [SLOT-1:0] slot_q;
  logic [6*GRAD-1:0] gx_tag_q, gy_tag_q, gx_there, gy_there;
  logic [13:0] stamp_tag_q;

  assign tag = choose && take_i;

  for (genvar g = 0; g < 6; g++) begin : gen_there
    assign gx_there[g*GRAD+:GRAD] = gen_linear[g].gx_q[slot_q];
    assign gy_there[g*GRAD+:GRAD] = gen_linear[g].gy_q[slot_q];
  end

  always_ff @(posedge clk_i) begin
    if (tag) begin
      live_q <= 1'b1;
      slot_q <= setup.slot;
      gx_tag_q <= setup.lin_gx;
      gy_tag_q <= setup.lin_gy;
      stamp_tag_q <= {setup.tie_pos, setup.tie_neg, setup.visible};
    end else if (first_q || (take_i && setup.slot == slot_q)) begin
      live_q <= 1'b0;
    end
    emit_q1 <= !first_q && !tag && live_q && emit_slot_i == slot_q;
    if (first_q || tag) stamp_q1 <= 1'b0;
    else if (stamp_load_i) stamp_q1 <= live_q && stamp_slot_i == slot_q;
  end

  always_comb begin
    if (!first_q) begin
      assert (!emit_q1 || {emit_gx_o, emit_gy_o} == {gx_tag_q, gy_tag_q});
      assert (!stamp_q1 || {stamp_gx, stamp_gy} == {gx_tag_q[5*GRAD-1:0], gy_tag_q[5*GRAD-1:0]});
      assert (!stamp_q1 || {stamp_tie_pos, stamp_tie_neg, stamp_visible} == stamp_tag_q);
      // Invariants
      assert (!live_q || (gx_there == gx_tag_q && gy_there == gy_tag_q && stamp_q[slot_q] == stamp_tag_q));
    end
  end
