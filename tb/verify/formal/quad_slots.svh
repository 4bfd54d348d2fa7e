  // quad_slots: a slot is given to one quad at a time, and from its start to its end gives back what is that quad's, at each of its read ports: id, k_eff
  // (or W), W, Z, attributes, bases and depth limits and whether the weights are areas from the start on; gradients, squared lengths, ties, visibility and class from the take
  // on. While a slot is free one is offered after at most SLOTS clocks; busy_o while one is in use; release_i frees the slot of two clocks before.
  // By induction: one quad, tagged at any start, is followed through its slot.
  // Assumed: reset at the start and no more; start only when a slot is available (quadrille: start has slot_available in it; asserted in quad_slots);
  // drop and release only of a slot in use, not both of one, take of a quad once, and before its end (quad_setup drops or hands over, once; an end
  // beat leaves the pipeline once, proof pixel_pipeline; it is pushed behind the take).
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  localparam int VERTICES = BLEND;
  localparam int STAMP = 5 + 5 + 4;
  (* anyseq *) logic choose;
  logic seen_q, live_q, taken_q, tag, take_tag;
  logic [SLOT-1:0] slot_q, left_q1, left_q2;  // slots that left the pipeline one and two clocks before
  logic [ID-1:0] id_tag_q;
  logic [4*WORD-1:0] k_tag, k_tag_q, k_there;
  logic [VERTICES-1:0] vertex_tag_q;
  logic [BASE-1:0] base_tag_q;
  logic plane_tag_q;
  logic [6*GRAD-1:0] gx_tag_q, gy_tag_q, gx_there, gy_there;
  logic [6*LENGTH2-1:0] length2_tag_q;
  logic [STAMP-1:0] stamp_tag_q;
  logic [1:0] class_tag_q;
  logic blend_q1, blend_taken_q1, base_q1, emit_q1, length2_q1, stamp_q1;  // what is read out of its slot
  logic [SLOTS-1:0] used_q;  // by what came and went at the ports
  logic [SLOT:0] waited_q;  // clocks with a free slot and none offered

  assign tag = choose && start_i && !seen_q;
  assign take_tag = take_i && live_q && take_slot_i == slot_q;

  for (genvar v = 0; v < 4; v++) begin : gen_tag
    assign k_tag[v*WORD+:WORD] = perspective_i ? {1'b0, k_exp_i[v*PE+:PE], k_sig_i[v*S+:S]} : {w_neg_i[v], w_exp_i[v*PE+:PE], w_sig_i[v*S+:S]};
    assign k_there[v*WORD+:WORD] = gen_vertex[v].gen_term[0].gen_k.bank_q[slot_q];
  end

  for (genvar g = 0; g < 6; g++) begin : gen_gradient
    assign gx_there[g*GRAD+:GRAD] = gen_linear[g].gx_q[slot_q];
    assign gy_there[g*GRAD+:GRAD] = gen_linear[g].gy_q[slot_q];
  end

  // Of term set t from 1 on: W and Z of four vertices, each b of the last three
  logic [VERTICES-1:0] vertex_tag, vertex_out;
  logic [4*WORD-1:0] k_out;

  always_comb begin
    vertex_tag = '0;
    vertex_out = '0;
    k_out = '0;
    for (int v = 0; v < 4; v++) begin
      k_out[v*WORD+:WORD] = {blend_neg_o[v], blend_exp_o[v*PE+:PE], blend_sig_o[v*S+:S]};
      vertex_tag[v*WORD+:WORD] = {w_neg_i[v], w_exp_i[v*PE+:PE], w_sig_i[v*S+:S]};
      vertex_tag[(4+v)*WORD+:WORD] = {z_neg_i[v], z_exp_i[v*PE+:PE], z_sig_i[v*S+:S]};
    end
    for (int n = 0; n < N; n++) begin
      for (int v = 1; v < 4; v++) vertex_tag[(8+3*n+v-1)*WORD+:WORD] = attr_i[((v-1)*N+n)*AP+:AP];
    end
    for (int p = 4; p < TERMS; p++) vertex_out[(p-4)*WORD+:WORD] = {blend_neg_o[p], blend_exp_o[p*PE+:PE], blend_sig_o[p*S+:S]};
  end

  always_ff @(posedge clk_i) begin
    {left_q2, left_q1} <= {left_q1, output_slot_i};
    if (!rst_ni) begin
      seen_q <= 1'b0;
      live_q <= 1'b0;
      taken_q <= 1'b0;
      used_q <= '0;
      waited_q <= '0;
      {blend_q1, blend_taken_q1, base_q1, emit_q1, length2_q1, stamp_q1} <= '0;
    end else begin
      if (release_i) used_q[left_q2] <= 1'b0;
      if (drop_i) used_q[drop_slot_i] <= 1'b0;
      if (start_i) used_q[alloc_o] <= 1'b1;
      waited_q <= (available_o || used_q == '1) ? '0 : waited_q + (SLOT + 1)'(1);
      if (tag) begin
        seen_q <= 1'b1;
        live_q <= 1'b1;
        slot_q <= alloc_o;
        id_tag_q <= id_i;
        k_tag_q <= k_tag;
        vertex_tag_q <= vertex_tag;
        base_tag_q <= {base_attr_i, base_depth_i, depth_limits_i};
        plane_tag_q <= plane_i;
      end else if ((release_i && left_q2 == slot_q) || (drop_i && drop_slot_i == slot_q)) begin
        live_q <= 1'b0;
      end
      if (take_tag) begin
        taken_q <= 1'b1;
        gx_tag_q <= lin_gx_i;
        gy_tag_q <= lin_gy_i;
        length2_tag_q <= length2_i;
        stamp_tag_q <= {tie_pos_i, tie_neg_i, visible_i};
        class_tag_q <= {hull_i, homogeneous_i};
      end
      blend_q1 <= live_q && blend_slot_i == slot_q;
      blend_taken_q1 <= live_q && taken_q && blend_slot_i == slot_q;
      base_q1 <= live_q && base_slot_i == slot_q;
      emit_q1 <= live_q && taken_q && emit_slot_i == slot_q;
      length2_q1 <= live_q && taken_q && length2_slot_i == slot_q;
      if (stamp_load_i) stamp_q1 <= live_q && taken_q && stamp_slot_i == slot_q;
    end
  end

  logic [SLOT-1:0] ahead, at;  // slots from the offered one to the next that is free
  logic found;

  always_comb begin
    ahead = '0;
    at = '0;
    found = 1'b0;
    for (int i = 0; i < SLOTS; i++) begin
      at = alloc_q + SLOT'(i);
      if (!found && !in_use_q[at]) begin
        found = 1'b1;
        ahead = SLOT'(i);
      end
    end
  end

  logic [4*WORD-1:0] product_word, override_word;
  logic [4*WORD-1:0] k_tag_magnitude;  // without signs

  always_comb begin
    for (int v = 0; v < 4; v++) begin
      product_word[v*WORD+:WORD] = {product_k_neg_o[v], product_k_exp_o[v*PE+:PE], product_k_sig_o[v*S+:S]};
      override_word[v*WORD+:WORD] = {1'b0, override_k_exp_o[v*PE+:PE], override_k_sig_o[v*S+:S]};
      k_tag_magnitude[v*WORD+:WORD] = {1'b0, k_tag_q[v*WORD+:WORD-1]};
    end
  end

  always_comb begin
    if (rst_ni) begin
      assume (!start_i || available_o);
      assume (!drop_i || used_q[drop_slot_i]);
      assume (!release_i || used_q[left_q2]);
      assume (!drop_i || !release_i || drop_slot_i != left_q2);
      assume (!take_i || (used_q[take_slot_i] && !(live_q && taken_q && take_slot_i == slot_q)));
      assert (!live_q || !start_i || alloc_o != slot_q);  // nobody else gets it
      assert (!live_q || output_slot_i != slot_q || output_id_o == id_tag_q);
      assert (!live_q || !taken_q || output_slot_i != slot_q || {output_hull_o, output_homogeneous_o} == class_tag_q);
      assert (!live_q || product_slot_i != slot_q || product_word == k_tag_q);
      assert (!live_q || override_slot_i != slot_q || override_word == k_tag_magnitude);
      assert (!live_q || norm_slot_i != slot_q || norm_plane_o == plane_tag_q);
      assert (!blend_q1 || {vertex_out, k_out} == {vertex_tag_q, k_tag_q});
      assert (!base_q1 || {base_attr_o, base_depth_o, base_limits_o} == base_tag_q);
      assert (!blend_taken_q1 || blend_hull_o == class_tag_q[1]);
      assert (!emit_q1 || {emit_gx_o, emit_gy_o} == {gx_tag_q, gy_tag_q});
      assert (!length2_q1 || length2_o == length2_tag_q);
      assert (!stamp_q1 || {stamp_gx_o, stamp_gy_o} == {gx_tag_q[5*GRAD-1:0], gy_tag_q[5*GRAD-1:0]});
      assert (!stamp_q1 || {stamp_tie_pos_o, stamp_tie_neg_o, stamp_visible_o} == stamp_tag_q);
      assert (busy_o == (used_q != '0));
      assert (waited_q < (SLOT + 1)'(SLOTS));
      // Invariants
      assert (in_use_q == used_q);
      assert (release_slot_q == left_q2 && output_slot_q == left_q1);
      assert (!live_q || (in_use_q[slot_q] && id_q[slot_q] == id_tag_q && k_there == k_tag_q));
      assert (!live_q || gen_plane.plane_q[slot_q] == plane_tag_q);
      assert (seen_q || !(live_q || taken_q || blend_q1 || blend_taken_q1 || base_q1 || emit_q1 || length2_q1 || stamp_q1));
      assert (taken_q || !(blend_taken_q1 || emit_q1 || length2_q1 || stamp_q1));
      assert (!live_q || !taken_q || (class_q[slot_q] == class_tag_q && stamp_q[slot_q] == stamp_tag_q));
      assert (!live_q || !taken_q || (gx_there == gx_tag_q && gy_there == gy_tag_q && length2_q[slot_q] == length2_tag_q));
      assert (used_q == '1 || (SLOT + 1)'(ahead) + waited_q < (SLOT + 1)'(SLOTS));
    end
  end

  always_comb if (rst_ni) assert (!live_q || (blend_q[slot_q] == vertex_tag_q && base_q[slot_q] == base_tag_q));
