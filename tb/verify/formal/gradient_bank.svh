  // gradient_bank: from a quad's take to the next take of its slot its gradients, ties and visibility come out of both read ports.
  // By induction: one quad, tagged at any take, is followed.
  logic first_q = 1'b1;
  always_ff @(posedge clk_i) first_q <= 1'b0;

  (* anyseq *) logic choose;
  logic live_q, tag, emit_q1, stamp_q1;
  logic [SLOT-1:0] slot_q;
  localparam int EDGES = quadrille_pkg::EDGES_BITS;
  (* hierconn *) logic [SLOTS*EDGES-1:0] \u_edges.words ;
  (* hierconn *) logic [SLOTS*12*GRAD-1:0] \u_gradients.words ;
  logic [SLOTS*EDGES-1:0] edges_words;
  logic [SLOTS*12*GRAD-1:0] gradients_words;
  logic [EDGES-1:0] edges_tag_q, edges_there;
  logic [12*GRAD-1:0] gradients_tag_q, gradients_there;  // {gx, gy}

  assign tag = choose && take_i;

  assign edges_words = \u_edges.words ;
  assign gradients_words = \u_gradients.words ;
  assign edges_there = edges_words[slot_q*EDGES+:EDGES];
  assign gradients_there = gradients_words[slot_q*12*GRAD+:12*GRAD];

  always_ff @(posedge clk_i) begin
    if (tag) begin
      live_q <= 1'b1;
      slot_q <= setup.slot;
      gradients_tag_q <= {setup.lin_gx, setup.lin_gy};
      edges_tag_q <= {setup.lin_gx[5*GRAD-1:0], setup.lin_gy[5*GRAD-1:0], setup.tie_pos, setup.tie_neg, setup.visible};
    end else if (first_q || (take_i && setup.slot == slot_q)) begin
      live_q <= 1'b0;
    end
    emit_q1 <= !first_q && !tag && live_q && emit_slot_i == slot_q;
    if (first_q || tag) stamp_q1 <= 1'b0;
    else if (stamp_load_i) stamp_q1 <= live_q && stamp_slot_i == slot_q;
  end

  always_comb begin
    if (!first_q) begin
      assert (!emit_q1 || {emit_gx_o, emit_gy_o} == gradients_tag_q);
      assert (!stamp_q1 || edges_o == edges_tag_q);
      // Invariants
      assert (!live_q || (gradients_there == gradients_tag_q && edges_there == edges_tag_q));
    end
  end
