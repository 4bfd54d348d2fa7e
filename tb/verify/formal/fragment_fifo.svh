  // fragment_fifo: what is pushed is handed over once, in order, with its mask; a word is at the port two clocks after its push; freed_o is the
  // hand-over of the clock before; valid held and word stable under stall, zero while not valid, no overflow (the unit's own assertions).
  // By induction: a word tagged at any push is followed through the buffer, `ahead_q` words before it.
  // Assumed of the user: a push only while less than DEPTH words are in (pixel_emit counts them).
  localparam int USED = DEPTH_LOG2 + 1;
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  (* anyseq *) logic choose;
  logic [USED-1:0] used_q, ahead_q;
  logic seen_q, in_q, waited_q, pop, popped_q;
  logic [LANES+WIDTH-1:0] tagged_q;
  logic tag;

  assign tag = choose && push && !seen_q;
  assign pop = valid_o && ready_i;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      used_q <= '0;
      seen_q <= 1'b0;
      in_q <= 1'b0;
      waited_q <= 1'b0;
      popped_q <= 1'b0;
    end else begin
      used_q <= used_q + USED'(push) - USED'(pop);
      waited_q <= used_q != '0 && !valid_o;
      popped_q <= pop;
      if (tag) begin
        seen_q <= 1'b1;
        in_q <= 1'b1;
        tagged_q <= {push_i, data_i};
        ahead_q <= used_q - USED'(pop);
      end else if (in_q && pop) begin
        in_q <= ahead_q != '0;
        ahead_q <= ahead_q - USED'(1);
      end
    end
  end

  logic [DEPTH_LOG2-1:0] place, write;
  localparam int WORD = LANES + WIDTH;
  (* hierconn *) logic [DEPTH*WORD-1:0] \u_word.words ;
  logic [DEPTH*WORD-1:0] words;
  logic [WORD-1:0] there;

  assign write = read_q + DEPTH_LOG2'(count_q);
  assign place = read_q + DEPTH_LOG2'(ahead_q) - DEPTH_LOG2'(valid_o);
  assign words = \u_word.words ;
  assign there = words[place*WORD+:WORD];

  always_comb begin
    if (rst_ni) begin
      assume (!push || used_q < USED'(DEPTH));
      if (in_q && ahead_q == '0 && valid_o) assert ({mask_o, data_o} == tagged_q);
      assert (!in_q || ahead_q < used_q);
      assert (busy_o == (used_q != '0));
      assert (!waited_q || valid_o);
      assert (freed_o == popped_q);
      // Invariants
      assert (used_q == count_q + USED'(valid_o) && used_q <= USED'(DEPTH));
      assert (write_q == write);
      assert (some_q == (count_q != '0));
      assert (!waited_q || used_q != '0);
      assert (!in_q || tagged_q[WIDTH+:LANES] != '0);
      assert (!in_q || (valid_o && ahead_q == '0) || there == tagged_q);
    end
  end

  // Invariant of the memory: some lane of each word has a fragment.
  for (genvar i = 0; i < DEPTH; i++) begin : gen_masks
    logic [DEPTH_LOG2-1:0] behind;
    logic [LANES-1:0] lanes;
    assign behind = DEPTH_LOG2'(i) - read_q;
    assign lanes = words[i*WORD+WIDTH+:LANES];
    always_comb if (rst_ni) assert ({1'b0, behind} >= count_q || lanes != '0);
  end
