  // tile_ring: an entry is given back as it was written (tag with fetch; linear values with load; tag and values to emission two clocks after its
  // pointer, the words of each part), and is not written over while it is in use; full_o leaves no room unused: it is low when the entry fits.
  // By induction: one entry, tagged at any push, is followed, with the word of one part, chosen freely, and of the functions one of each kind.
  // Assumed of the users: no push when full; complete_i for what was pushed and is not complete; coverage and emission read entries that are
  // complete and not given back, complete_i goes from tile to tile; words are written to entries that are not complete; the head stamp's pointer, or coverage's while there is none, is an entry that is in use, or the next, and never moves back.
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  (* anyseq *) logic choose;
  logic seen_q, live_q, fetched_q, loaded_q, emit_q1, emit_q2, tag;
  logic [RING:0] ptr_q;
  logic [TAG-1:0] tag_kept_q;
  logic [VAL-1:0] value_kept_q;
  (* anyconst *) logic [1:0] part;
  logic [RING-1:0] word_place, word_at;  // of the entry's word; of what is written, from the first entry that is not complete
  logic [QVAL-1:0] word_kept_q;
  logic word_known_q, word_q1, word_q2, word_written;
  logic [RING:0] tail_next, room, from_tail, to_complete, from_tail_emit, from_tail_load, from_tail_fetch, from_tail_ptr, complete_from_tail;

  assign tag = choose && push_i && !seen_q;
  assign tail_next = head_valid_i ? head_ptr_i : stamps_empty_i ? stamp_ptr_i : tail_q;
  assign room = (RING + 1)'(ENTRIES) - used;
  assign from_tail = tail_next - tail_q;
  assign complete_from_tail = complete_q - tail_q;
  assign to_complete = write_q - complete_q;
  assign from_tail_emit = emit_ptr_i - tail_q;
  assign from_tail_load = load_ptr_i - tail_q;
  assign from_tail_fetch = fetch_ptr_i - tail_q;
  assign from_tail_ptr = ptr_q - tail_q;

  logic [RING:0] size, step, to_ptr;  // entries of the tagged tile; that complete_i adds; from the first that is not complete to the tagged one
  logic [RING:0] behind, ptr_to_complete;
  logic complete;  // the tagged one is

  assign size = tag_kept_q[TAG-2] ? PARTS : (RING + 1)'(1);
  assign step = complete_homogeneous_i ? PARTS : (RING + 1)'(1);
  assign to_ptr = ptr_q - complete_q;
  assign behind = write_q - ptr_q;
  assign ptr_to_complete = complete_q - ptr_q;
  assign complete = from_tail_ptr < complete_from_tail;
  assign word_place = ptr_q[RING-1:0] + ((part == quadrille_pkg::PART_SQUARES) ? RING'(0) : RING'(part));
  assign word_at = value_entry_i - complete_q[RING-1:0];
  assign word_written = value_write_i[0] && live_q && value_entry_i == word_place;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      word_known_q <= 1'b0;
      word_q1 <= 1'b0;
      word_q2 <= 1'b0;
    end else begin
      if (word_written) word_known_q <= 1'b1;
      if (word_written) word_kept_q <= value_i[0+:QVAL];
      word_q1 <= live_q && word_known_q && emit_valid_i && emit_ptr_i == ptr_q && emit_part_i == part
          && (tag_kept_q[TAG-2] || part == quadrille_pkg::PART_SQUARES || part == quadrille_pkg::PART_WHOLE);
      word_q2 <= word_q1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      seen_q <= 1'b0;
      live_q <= 1'b0;
      fetched_q <= 1'b0;
      loaded_q <= 1'b0;
      emit_q1 <= 1'b0;
      emit_q2 <= 1'b0;
    end else begin
      if (tag) begin
        seen_q <= 1'b1;
        live_q <= 1'b1;
        ptr_q <= write_q;
        tag_kept_q <= {end_i, in_parts, slot_i, tile_x_i, tile_y_i};
        value_kept_q <= lin_value_i[0+:VAL];
      end else if (live_q && from_tail > from_tail_ptr) begin
        live_q <= 1'b0;
      end
      fetched_q <= fetch_i ? live_q && fetch_ptr_i == ptr_q : fetched_q;
      loaded_q <= load_i ? live_q && load_ptr_i == ptr_q : loaded_q;
      emit_q1 <= live_q && emit_valid_i && emit_ptr_i == ptr_q;
      emit_q2 <= emit_q1;
    end
  end

  always_comb begin
    if (rst_ni) begin
      assume (!push_i || !full_o);
      assume (!complete_i || to_complete >= step);
      assume (!complete_i || !live_q || complete || (to_ptr == '0 ? step == size : step <= to_ptr));
      assume (from_tail <= complete_from_tail);
      assume (!fetch_i || from_tail_fetch < complete_from_tail);
      assume (!load_i || from_tail_load < complete_from_tail);
      assume (!emit_valid_i || from_tail_emit < complete_from_tail);
      assume (!value_write_i[0] || {1'b0, word_at} < to_complete);
      // The next entry begins behind this one's last.
      assert (!live_q || behind >= size);
      assert (!word_q2 || emit_quad_value_o[0+:QVAL] == word_kept_q);
      assert (full_o == (room < (in_parts ? PARTS : (RING + 1)'(1))));
      assert (used <= (RING + 1)'(ENTRIES));
      assert (!fetched_q || {stamp_end_o, stamp_homogeneous_o, stamp_slot_o, stamp_tile_x_o, stamp_tile_y_o} == tag_kept_q);
      assert (!loaded_q || stamp_lin_value_o[0+:VAL] == value_kept_q);
      assert (!emit_q1 || tag_slot_o == tag_kept_q[2*TC+:SLOT]);
      assert (!emit_q2 || {emit_slot_o, emit_tile_x_o, emit_tile_y_o} == tag_kept_q[TAG-3:0]);
      assert (!emit_q2 || emit_lin_value_o[0+:VAL] == value_kept_q);
      // Invariants
      assert (complete_from_tail <= used);
      assert (!live_q || !complete || ptr_to_complete >= size);
      assert (!live_q || from_tail_ptr < used);
      assert (seen_q || (!word_known_q && !word_q1 && !word_q2));
      assert (!live_q || !word_known_q || gen_quadratic[0].value_q[word_place] == word_kept_q);
      assert (!word_q1 || (word_index_q == word_place && gen_quadratic[0].value_q[word_place] == word_kept_q));
      assert (seen_q || !(live_q || fetched_q || loaded_q || emit_q1 || emit_q2));
      assert (!live_q || (tag_q[ptr_q[RING-1:0]] == tag_kept_q && gen_linear[0].value_q[ptr_q[RING-1:0]] == value_kept_q));
      assert (!emit_q1 || (emit_index_q == ptr_q[RING-1:0] && {tag_tile_x_q, tag_tile_y_q} == tag_kept_q[2*TC-1:0]));
      assert (!emit_q1 || gen_linear[0].value_q[ptr_q[RING-1:0]] == value_kept_q);
    end
  end
