  // vertex_bank: from the last offer of a quad to the next of its slot id, k_eff (or W), W, Z, attributes, bases, depth limits and whether the
  // weights are areas come out of each read port, a clock or two behind its slot; from its take on squared lengths and class. A sum that is
  // not active has terms of zeros.
  // By induction: one quad, tagged at any offer, is followed through its slot, and taken once.
  // Assumed: the draw state does not change (quadrille asserts it); a take of the slot is the tagged quad's (slot_allocation: a slot has one
  // quad at a time).
  logic first_q = 1'b1;
  always_ff @(posedge clk_i) first_q <= 1'b0;

  localparam int CLASS = 2;
  (* anyseq *) logic choose;
  logic live_q, taken_q, tag, take_tag;
  logic [SLOT-1:0] slot_q;
  logic [ID-1:0] id_tag_q;
  logic [4*WORD-1:0] k_tag, k_tag_q, k_there;
  logic [BLEND-1:0] vertex_tag_q;
  logic [BASE-1:0] base_tag_q;
  logic plane_tag_q;
  logic [6*LENGTH2-1:0] length2_tag_q;
  logic [CLASS-1:0] class_tag_q;
  logic product_q1, overrides_q1, norm_q1, output_q1, output_taken_q1;
  logic blend_q1, blend_q2, blend_taken_q1, base_q1, base_q2, base_q3, length2_q1, length2_q2;
  logic [SETS-1:0] active_q1;
  logic [quadrille_pkg::STATE_BITS-1:0] state_q;

  (* hierconn *) logic [SLOTS*ID-1:0] \u_id.words ;
  (* hierconn *) logic [SLOTS*BLEND-1:0] \u_blend.words ;
  (* hierconn *) logic [SLOTS*BASE-1:0] \u_base.words ;
  (* hierconn *) logic [SLOTS*6*LENGTH2-1:0] \u_length2.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[0].gen_term[0].gen_k.u_k.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[1].gen_term[0].gen_k.u_k.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[2].gen_term[0].gen_k.u_k.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[3].gen_term[0].gen_k.u_k.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[0].gen_term[0].gen_k.u_product_k.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[1].gen_term[0].gen_k.u_product_k.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[2].gen_term[0].gen_k.u_product_k.words ;
  (* hierconn *) logic [SLOTS*WORD-1:0] \gen_vertex[3].gen_term[0].gen_k.u_product_k.words ;
  (* hierconn *) logic [SLOTS*(WORD-1)-1:0] \gen_vertex[0].gen_term[0].gen_k.u_override_k.words ;
  (* hierconn *) logic [SLOTS*(WORD-1)-1:0] \gen_vertex[1].gen_term[0].gen_k.u_override_k.words ;
  (* hierconn *) logic [SLOTS*(WORD-1)-1:0] \gen_vertex[2].gen_term[0].gen_k.u_override_k.words ;
  (* hierconn *) logic [SLOTS*(WORD-1)-1:0] \gen_vertex[3].gen_term[0].gen_k.u_override_k.words ;
  // What the slot has of each, and of the four memories of k for each read
  logic [SLOTS*ID-1:0] id_words;
  logic [SLOTS*BLEND-1:0] blend_words;
  logic [SLOTS*BASE-1:0] base_words;
  logic [SLOTS*6*LENGTH2-1:0] length2_words;
  logic [4*SLOTS*WORD-1:0] k_words, product_words;
  logic [4*SLOTS*(WORD-1)-1:0] override_words;
  logic [ID-1:0] id_there;
  logic [BLEND-1:0] blend_there;
  logic [BASE-1:0] base_there;
  logic [6*LENGTH2-1:0] length2_there;
  logic [4*WORD-1:0] product_there, override_there;

  assign id_words = \u_id.words ;
  assign blend_words = \u_blend.words ;
  assign base_words = \u_base.words ;
  assign length2_words = \u_length2.words ;
  assign id_there = id_words[slot_q*ID+:ID];
  assign blend_there = blend_words[slot_q*BLEND+:BLEND];
  assign base_there = base_words[slot_q*BASE+:BASE];
  assign length2_there = length2_words[slot_q*6*LENGTH2+:6*LENGTH2];
  assign k_words = {\gen_vertex[3].gen_term[0].gen_k.u_k.words ,
      \gen_vertex[2].gen_term[0].gen_k.u_k.words ,
      \gen_vertex[1].gen_term[0].gen_k.u_k.words ,
      \gen_vertex[0].gen_term[0].gen_k.u_k.words };
  assign product_words = {\gen_vertex[3].gen_term[0].gen_k.u_product_k.words ,
      \gen_vertex[2].gen_term[0].gen_k.u_product_k.words ,
      \gen_vertex[1].gen_term[0].gen_k.u_product_k.words ,
      \gen_vertex[0].gen_term[0].gen_k.u_product_k.words };
  assign override_words = {\gen_vertex[3].gen_term[0].gen_k.u_override_k.words ,
      \gen_vertex[2].gen_term[0].gen_k.u_override_k.words ,
      \gen_vertex[1].gen_term[0].gen_k.u_override_k.words ,
      \gen_vertex[0].gen_term[0].gen_k.u_override_k.words };
  assign tag = choose && offer_i;
  assign take_tag = take_i && live_q && !taken_q && setup.slot == slot_q;

  for (genvar v = 0; v < 4; v++) begin : gen_tag
    assign k_tag[v*WORD+:WORD] = state.perspective ? {1'b0, quad.k_exp[v*PE+:PE], quad.k_sig[v*S+:S]} :
        {quad.w_neg[v], quad.w_exp[v*PE+:PE], quad.w_sig[v*S+:S]};
    assign k_there[v*WORD+:WORD] = k_words[(v*SLOTS+slot_q)*WORD+:WORD];
    assign product_there[v*WORD+:WORD] = product_words[(v*SLOTS+slot_q)*WORD+:WORD];
    assign override_there[v*WORD+:WORD] = {1'b0, override_words[(v*SLOTS+slot_q)*(WORD-1)+:WORD-1]};
  end

  // Of term set t from 1 on: W and Z of four vertices, each b of the last three
  logic [BLEND-1:0] vertex_tag, vertex_spec, vertex_out;
  logic [4*WORD-1:0] k_out, k_spec, product_out, override_out, k_magnitude;

  always_comb begin
    vertex_tag = '0;
    vertex_spec = '0;
    vertex_out = '0;
    for (int v = 0; v < 4; v++) begin
      k_out[v*WORD+:WORD] = {blend_neg[v], blend_exp[v*PE+:PE], blend_sig[v*S+:S]};
      k_spec[v*WORD+:WORD] = active_q1[0] ? k_tag_q[v*WORD+:WORD] : '0;
      product_out[v*WORD+:WORD] = {product_k_neg[v], product_k_exp[v*PE+:PE], product_k_sig[v*S+:S]};
      override_out[v*WORD+:WORD] = {1'b0, override_k_exp[v*PE+:PE], override_k_sig[v*S+:S]};
      k_magnitude[v*WORD+:WORD] = {1'b0, k_tag_q[v*WORD+:WORD-1]};
      vertex_tag[v*WORD+:WORD] = {quad.w_neg[v], quad.w_exp[v*PE+:PE], quad.w_sig[v*S+:S]};
      vertex_tag[(4+v)*WORD+:WORD] = {quad.z_neg[v], quad.z_exp[v*PE+:PE], quad.z_sig[v*S+:S]};
      if (active_q1[1]) vertex_spec[v*WORD+:WORD] = vertex_tag_q[v*WORD+:WORD];
      if (active_q1[2]) vertex_spec[(4+v)*WORD+:WORD] = vertex_tag_q[(4+v)*WORD+:WORD];
    end
    for (int n = 0; n < N; n++) begin
      for (int v = 1; v < 4; v++) begin
        vertex_tag[(8+3*n+v-1)*WORD+:WORD] = quad.attr[((v-1)*N+n)*AP+:AP];
        if (active_q1[3+n]) vertex_spec[(8+3*n+v-1)*WORD+:WORD] = vertex_tag_q[(8+3*n+v-1)*WORD+:WORD];
      end
    end
    for (int p = 4; p < TERMS; p++) vertex_out[(p-4)*WORD+:WORD] = {blend_neg[p], blend_exp[p*PE+:PE], blend_sig[p*S+:S]};
  end

  always_ff @(posedge clk_i) begin
    state_q <= state_i;
    active_q1 <= sum_active_o;
    if (tag) begin
      live_q <= 1'b1;
      taken_q <= 1'b0;
      slot_q <= start_slot_i;
      id_tag_q <= quad.id;
      k_tag_q <= k_tag;
      vertex_tag_q <= vertex_tag;
      base_tag_q <= {quad.base_attr, quad.base_depth, limits_i};
      plane_tag_q <= plane_i;
    end else if (first_q || (offer_i && start_slot_i == slot_q)) begin
      live_q <= 1'b0;
      taken_q <= 1'b0;
    end else if (take_tag) begin
      taken_q <= 1'b1;
      length2_tag_q <= setup.length2;
      class_tag_q <= {setup.hull, setup.homogeneous};
    end
    {product_q1, overrides_q1, norm_q1, output_q1, output_taken_q1, blend_q1, blend_taken_q1, base_q1, length2_q1} <= '0;
    {blend_q2, base_q2, base_q3, length2_q2} <= '0;
    if (!first_q && !tag) begin
      product_q1 <= live_q && reads.product == slot_q;
      overrides_q1 <= live_q && reads.overrides == slot_q;
      norm_q1 <= live_q && reads.norm == slot_q;
      output_q1 <= live_q && reads.outputs == slot_q;
      output_taken_q1 <= live_q && taken_q && reads.outputs == slot_q;
      blend_q1 <= live_q && reads.blend == slot_q;
      blend_taken_q1 <= live_q && taken_q && reads.blend == slot_q;
      base_q1 <= live_q && reads.base == slot_q;
      length2_q1 <= live_q && taken_q && reads.length2 == slot_q;
      {blend_q2, base_q2, base_q3, length2_q2} <= {blend_q1, base_q1, base_q2, length2_q1};
    end
  end

  always_comb begin
    if (!first_q) begin
      assume (state_i == state_q);
      assume (!(take_i && live_q && taken_q && setup.slot == slot_q));
      assume (!(take_i && offer_i && setup.slot == start_slot_i));
      assert (!product_q1 || product_out == k_tag_q);
      assert (!overrides_q1 || override_out == k_magnitude);
      assert (!norm_q1 || norm_plane == plane_tag_q);
      assert (!output_q1 || output_id == id_tag_q);
      assert (!output_taken_q1 || {output_hull, output_homogeneous} == class_tag_q);
      assert (!blend_q2 || {vertex_out, k_out} == {vertex_spec, k_spec});
      assert (!blend_taken_q1 || blend_hull == class_tag_q[1]);
      assert (!base_q2 || {base_attr, base_depth} == base_tag_q[BASE-1:LIMITS]);
      assert (!base_q3 || base_limits == base_tag_q[LIMITS-1:0]);
      assert (!length2_q2 || length2 == length2_tag_q);
      // Invariants
      assert (live_q || !taken_q);
      assert (!live_q || (id_there == id_tag_q && k_there == k_tag_q && gen_plane.plane_q[slot_q] == plane_tag_q));
      assert (!live_q || (product_there == k_tag_q && override_there == k_magnitude));
      assert (!live_q || (blend_there == vertex_tag_q && base_there == base_tag_q));
      assert (!taken_q || {hull_q[slot_q], homogeneous_q[slot_q]} == class_tag_q);
      assert (!taken_q || length2_there == length2_tag_q);
      assert (!base_q1 || base_word == base_tag_q);
      assert (!base_q2 || limits_q == base_tag_q[LIMITS-1:0]);
      assert (!length2_q1 || length2_word == length2_tag_q);
      assert (!blend_q1 || blend_word == vertex_tag_q);
      for (int v = 0; v < 4; v++) assert (!blend_q1 || k_read[v*WORD+:WORD] == k_tag_q[v*WORD+:WORD]);
    end
  end

  logic [4*WORD-1:0] k_read;
  for (genvar v = 0; v < 4; v++) begin : gen_read
    assign k_read[v*WORD+:WORD] = gen_vertex[v].gen_term[0].read_word;
  end
