  // slot_allocation: a slot is given to one quad at a time, from its start to its release or drop; while a slot is free one is offered after
  // at most SLOTS clocks; busy_o while one is in use.
  // By induction: one quad, tagged at any start, is followed through its slot.
  // Assumed: reset at the start and no more; start only when a slot is available (front: start has slot_available in it; asserted in
  // slot_allocation); drop and release only of a slot in use, not both of one (quad_setup drops or hands over, once; an end beat leaves the
  // pipeline once, proof pixel_pipeline; it is pushed behind the take).
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  (* anyseq *) logic choose;
  logic seen_q, live_q, tag;
  logic [SLOT-1:0] slot_q;
  logic [SLOTS-1:0] used_q;  // by what came and went at the ports
  logic [SLOT:0] waited_q;  // clocks with a free slot and none offered

  assign tag = choose && start_i && !seen_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      seen_q <= 1'b0;
      live_q <= 1'b0;
      used_q <= '0;
      waited_q <= '0;
    end else begin
      if (release_i) used_q[release_slot_i] <= 1'b0;
      if (drop_i) used_q[drop_slot_i] <= 1'b0;
      if (start_i) used_q[alloc_o] <= 1'b1;
      waited_q <= (available_o || used_q == '1) ? '0 : waited_q + (SLOT + 1)'(1);
      if (tag) begin
        seen_q <= 1'b1;
        live_q <= 1'b1;
        slot_q <= alloc_o;
      end else if ((release_i && release_slot_i == slot_q) || (drop_i && drop_slot_i == slot_q)) begin
        live_q <= 1'b0;
      end
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

  always_comb begin
    if (rst_ni) begin
      assume (!start_i || available_o);
      assume (!drop_i || used_q[drop_slot_i]);
      assume (!release_i || used_q[release_slot_i]);
      assume (!drop_i || !release_i || drop_slot_i != release_slot_i);
      assert (!live_q || !start_i || alloc_o != slot_q);  // nobody else gets it
      assert (busy_o == (used_q != '0));
      assert (waited_q < (SLOT + 1)'(SLOTS));
      // Invariants
      assert (in_use_q == used_q);
      assert (seen_q || !live_q);
      assert (!live_q || in_use_q[slot_q]);
      assert (used_q == '1 || (SLOT + 1)'(ahead) + waited_q < (SLOT + 1)'(SLOTS));
    end
  end
