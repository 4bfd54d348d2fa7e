  // sync_fifo: what is pushed comes out once, in order; a word is at the head two clocks after its push; no overflow, no pop of nothing (the
  // unit's own assertions). By induction: a word tagged at any push is followed through the buffer, `ahead_q` words before it.
  // Assumed of the user: a push only while less than DEPTH words are in, a pop only of a valid head.
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  (* anyseq *) logic choose;
  logic [COUNT-1:0] used_q, ahead_q;
  logic seen_q, in_q, waited_q;
  logic [WIDTH-1:0] tagged_q;
  logic tag;
  logic [POINTER-1:0] place, write;
  (* hierconn *) logic [(1<<POINTER)*WIDTH-1:0] \u_word.words ;
  logic [(1<<POINTER)*WIDTH-1:0] words;
  logic [WIDTH-1:0] there;

  // Of the tagged word, if it is not the head; of the next that is pushed.
  assign place = read_q + POINTER'(ahead_q) - POINTER'(valid_q);
  assign write = read_q + POINTER'(count_q);
  assign words = \u_word.words ;
  assign there = words[place*WIDTH+:WIDTH];
  assign tag = choose && push_i && !seen_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      used_q <= '0;
      seen_q <= 1'b0;
      in_q <= 1'b0;
      waited_q <= 1'b0;
    end else begin
      used_q <= used_q + COUNT'(push_i) - COUNT'(pop_i);
      waited_q <= used_q != '0 && !valid_o;
      if (tag) begin
        seen_q <= 1'b1;
        in_q <= 1'b1;
        tagged_q <= data_i;
        ahead_q <= used_q - COUNT'(pop_i);
      end else if (in_q && pop_i) begin
        in_q <= ahead_q != '0;
        ahead_q <= ahead_q - COUNT'(1);
      end
    end
  end

  always_comb begin
    if (rst_ni) begin
      assume (!push_i || used_q < COUNT'(DEPTH));
      assume (!pop_i || valid_o);
      if (in_q && ahead_q == '0 && valid_o) assert (data_o == tagged_q);
      assert (!in_q || ahead_q < used_q);
      assert (empty_o == (used_q == '0));
      assert (!waited_q || valid_o);
      // Invariants
      assert (used_q == count_q + COUNT'(valid_q) && used_q <= COUNT'(DEPTH));
      assert (write_q == write);
      assert (!waited_q || used_q != '0);
      assert (!in_q || (valid_q && ahead_q == '0) || there == tagged_q);
    end
  end
