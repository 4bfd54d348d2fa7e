  // tile_ring: an entry is given back as it was written (tag and last row with fetch; linear values with load; tag and values to emission two clocks
  // after its pointer, of each of its parts the words of all four quadratic functions), and is not written over while it is in use. stamp_present_o
  // is high at every entry that is complete and low at the first that is not; full_o leaves no room unused: it is low when the entry fits; the tail
  // follows the tile of the head, or coverage's while there is none: so the ring neither stops with something complete in it nor stays full.
  // By induction. Entries pushed, complete and given back are counted here, from the ports alone; one entry, tagged at any push, is followed with all
  // six linear functions, and with the word of one quadratic function of one part, both chosen freely.
  // Assumed of the users, where it is guaranteed behind it:
  //   reset at the start and no more; no push when full (tile_walk waits for ring_full; asserted in tile_ring, so in simulation too)
  //   words.complete, tile by tile in the order of the pushes, for what was pushed and is not complete (tile_context, one tile at a time, last step)
  //   words are written to entries that were pushed and are not complete, that of this clock's words.complete included (tile_context: a step's job
  //     has its entry with it, and complete_o leaves job_q with the last one)
  //   fetch and load of complete entries not given back (stamp_coverage fetches what is present, and loads what it fetched; stamp_ptr_o is behind)
  //   emission reads such entries (pixel_emit: ptr_o is the head's pointer of the clock before, which the tail has reached then)
  //   the head's pointer, or coverage's while there is none, is a complete entry in use or the first that is not complete, and never moves back
  //     (stamps leave sync_fifo in order, proof sync_fifo; stamp_ptr_o counts entries up)
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  // ---- Counts from the ports: next entry to push, first that is not complete, first in use ---------------------------------------------
  logic [RING:0] pushed_q, completed_q, given_q, given_next;
  logic [RING:0] push_size, step, occupied, complete_in_use, to_complete;
  logic parts_come;

  assign parts_come = homogeneous_i && !end_i;
  assign push_size = parts_come ? PARTS : (RING + 1)'(1);
  assign step = words.complete_homogeneous ? PARTS : (RING + 1)'(1);
  assign given_next = head_valid_i ? head_ptr_i : stamps_empty_i ? stamp_ptr_i : given_q;
  assign occupied = pushed_q - given_q;
  assign complete_in_use = completed_q - given_q;
  assign to_complete = pushed_q - completed_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      pushed_q <= '0;
      completed_q <= '0;
      given_q <= '0;
    end else begin
      if (push_i) pushed_q <= pushed_q + push_size;
      if (words.complete) completed_q <= completed_q + step;
      given_q <= given_next;
    end
  end

  localparam int ROW = quadrille_pkg::TILE_LOG2;  // bits of a tag below its place

  // ---- The tagged entry ----------------------------------------------------------------------------------------------------------------
  (* anyseq *) logic choose;
  (* anyconst *) logic [1:0] part, which;
  logic seen_q, live_q, fetched_q, loaded_q, emit_q1, emit_q2, word_q1, word_q2, tag;
  logic [RING:0] ptr_q;
  logic [TAG-1:0] tag_kept_q;
  logic [6*VAL-1:0] value_kept_q, value_there;
  logic [RING-1:0] place, word_place;  // of the entry, and of the word of the part
  logic [RING:0] size, from_given, given_step, to_ptr, behind, past_complete;
  logic complete, has_part;  // the tagged one is; it has the chosen part

  assign tag = choose && push_i && !seen_q;
  assign place = ptr_q[RING-1:0];
  assign word_place = place + ((part == quadrille_pkg::PART_SQUARES) ? RING'(0) : RING'(part));
  assign size = tag_kept_q[TAG-2] ? PARTS : (RING + 1)'(1);
  assign from_given = ptr_q - given_q;
  assign given_step = given_next - given_q;
  assign to_ptr = ptr_q - completed_q;
  assign behind = pushed_q - ptr_q;
  assign past_complete = completed_q - ptr_q;
  assign complete = from_given < complete_in_use;
  assign has_part = tag_kept_q[TAG-2] || part == quadrille_pkg::PART_SQUARES || part == quadrille_pkg::PART_WHOLE;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      seen_q <= 1'b0;
      live_q <= 1'b0;
      fetched_q <= 1'b0;
      loaded_q <= 1'b0;
      emit_q1 <= 1'b0;
      emit_q2 <= 1'b0;
      word_q1 <= 1'b0;
      word_q2 <= 1'b0;
    end else begin
      if (tag) begin
        seen_q <= 1'b1;
        live_q <= 1'b1;
        ptr_q <= pushed_q;
        tag_kept_q <= {end_i, parts_come, tile.slot, tile.tile_x, tile.tile_y, tile.last_row};
        value_kept_q <= tile.lin_value;
      end else if (live_q && given_step > from_given) begin
        live_q <= 1'b0;
      end
      if (fetch_i) fetched_q <= live_q && fetch_ptr_i == ptr_q;
      if (load_i) loaded_q <= live_q && load_ptr_i == ptr_q;
      emit_q1 <= live_q && emit_valid_i && emit_ptr_i == ptr_q;
      emit_q2 <= emit_q1;
      word_q1 <= live_q && emit_valid_i && emit_ptr_i == ptr_q && emit_part_i == part && has_part;
      word_q2 <= word_q1;
    end
  end

  (* hierconn *) logic [ENTRIES*TAG-1:0] \u_tag.words ;
  (* hierconn *) logic [ENTRIES*PLACED-1:0] \u_emit_tag.words ;
  (* hierconn *) logic [ENTRIES*5*VAL-1:0] \u_value.words ;
  (* hierconn *) logic [ENTRIES*6*VAL-1:0] \u_emit_value.words ;
  (* hierconn *) logic [ENTRIES*QVAL-1:0] \gen_quadratic[0].u_value.words ;
  (* hierconn *) logic [ENTRIES*QVAL-1:0] \gen_quadratic[1].u_value.words ;
  (* hierconn *) logic [ENTRIES*QVAL-1:0] \gen_quadratic[2].u_value.words ;
  (* hierconn *) logic [ENTRIES*QVAL-1:0] \gen_quadratic[3].u_value.words ;
  (* hierconn *) logic [ENTRIES*2*QGRAD-1:0] \gen_quadratic[0].u_gradient.words ;
  (* hierconn *) logic [ENTRIES*2*QGRAD-1:0] \gen_quadratic[1].u_gradient.words ;
  (* hierconn *) logic [ENTRIES*2*QGRAD-1:0] \gen_quadratic[2].u_gradient.words ;
  (* hierconn *) logic [ENTRIES*2*QGRAD-1:0] \gen_quadratic[3].u_gradient.words ;
  (* hierconn *) logic [ENTRIES*QCURV-1:0] \gen_quadratic[0].u_q.words ;
  (* hierconn *) logic [ENTRIES*QCURV-1:0] \gen_quadratic[1].u_q.words ;
  (* hierconn *) logic [ENTRIES*QCURV-1:0] \gen_quadratic[2].u_q.words ;
  (* hierconn *) logic [ENTRIES*QCURV-1:0] \gen_quadratic[3].u_q.words ;
  logic [ENTRIES*TAG-1:0] tag_words;
  logic [ENTRIES*PLACED-1:0] emit_tag_words;
  logic [ENTRIES*5*VAL-1:0] value_words;
  logic [ENTRIES*6*VAL-1:0] emit_value_words;
  logic [4*ENTRIES*QVAL-1:0] quad_value_words;
  logic [4*ENTRIES*2*QGRAD-1:0] quad_gradient_words;
  logic [4*ENTRIES*QCURV-1:0] quad_q_words;
  logic [TAG-1:0] tag_there;
  logic [PLACED-1:0] emit_tag_there;
  logic [5*VAL-1:0] stamp_value_there;

  assign tag_words = \u_tag.words ;
  assign emit_tag_words = \u_emit_tag.words ;
  assign value_words = \u_value.words ;
  assign emit_value_words = \u_emit_value.words ;
  assign quad_value_words = {\gen_quadratic[3].u_value.words ,
      \gen_quadratic[2].u_value.words ,
      \gen_quadratic[1].u_value.words ,
      \gen_quadratic[0].u_value.words };
  assign quad_gradient_words = {\gen_quadratic[3].u_gradient.words ,
      \gen_quadratic[2].u_gradient.words ,
      \gen_quadratic[1].u_gradient.words ,
      \gen_quadratic[0].u_gradient.words };
  assign quad_q_words = {\gen_quadratic[3].u_q.words ,
      \gen_quadratic[2].u_q.words ,
      \gen_quadratic[1].u_q.words ,
      \gen_quadratic[0].u_q.words };
  assign tag_there = tag_words[place*TAG+:TAG];
  assign emit_tag_there = emit_tag_words[place*PLACED+:PLACED];
  assign stamp_value_there = value_words[place*5*VAL+:5*VAL];
  assign value_there = emit_value_words[place*6*VAL+:6*VAL];

  // Its words: what was written last of each function
  logic [RING:0] value_at, gradient_at, q_at;  // entries written, from the first that is not complete

  assign value_at = {1'b0, RING'(words.value_entry - completed_q[RING-1:0])};
  assign gradient_at = {1'b0, RING'(words.gradient_entry - completed_q[RING-1:0])};
  assign q_at = {1'b0, RING'(words.q_entry - completed_q[RING-1:0])};

  // What is written, stored and given out of the chosen function
  logic [QVAL-1:0] value_in, value_stored, value_out, value_word_q;
  logic [2*QGRAD-1:0] gradient_in, gradient_stored, gradient_out, gradient_word_q;  // {gx, gy}
  logic [QCURV-1:0] q_in, q_stored, q_out, q_word_q;
  logic value_known_q, gradient_known_q, q_known_q;
  logic [4*QVAL-1:0] values_stored;
  logic [4*2*QGRAD-1:0] gradients_stored;
  logic [4*QCURV-1:0] qs_stored;

  for (genvar g = 0; g < 4; g++) begin : gen_stored
    assign values_stored[g*QVAL+:QVAL] = quad_value_words[(g*ENTRIES+word_place)*QVAL+:QVAL];
    assign gradients_stored[g*2*QGRAD+:2*QGRAD] = quad_gradient_words[(g*ENTRIES+word_place)*2*QGRAD+:2*QGRAD];
    assign qs_stored[g*QCURV+:QCURV] = quad_q_words[(g*ENTRIES+word_place)*QCURV+:QCURV];
  end

  always_comb begin
    {value_in, value_stored, value_out} = '0;
    {gradient_in, gradient_stored, gradient_out} = '0;
    {q_in, q_stored, q_out} = '0;
    for (int g = 0; g < 4; g++) begin
      if (which == 2'(g)) begin
        value_in = words.value[(g%BUSES)*QVAL+:QVAL];
        value_stored = values_stored[g*QVAL+:QVAL];
        value_out = emit_quad_value[g*QVAL+:QVAL];
        gradient_in = {words.gx[(g%BUSES)*QGRAD+:QGRAD], words.gy[(g%BUSES)*QGRAD+:QGRAD]};
        gradient_stored = gradients_stored[g*2*QGRAD+:2*QGRAD];
        gradient_out = {emit_quad_gx[g*QGRAD+:QGRAD], emit_quad_gy[g*QGRAD+:QGRAD]};
        q_in = words.q[(g%PAIRS)*QCURV+:QCURV];
        q_stored = qs_stored[g*QCURV+:QCURV];
        q_out = emit_quad_q[g*QCURV+:QCURV];
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {value_known_q, gradient_known_q, q_known_q} <= '0;
    end else if (live_q) begin
      if (words.value_write[which] && words.value_entry == word_place) {value_known_q, value_word_q} <= {1'b1, value_in};
      if (words.gradient_write[which] && words.gradient_entry == word_place) {gradient_known_q, gradient_word_q} <= {1'b1, gradient_in};
      if (words.q_write[which] && words.q_entry == word_place) {q_known_q, q_word_q} <= {1'b1, q_in};
    end
  end

  always_comb begin
    if (rst_ni) begin
      assert (!word_q2 || !value_known_q || value_out == value_word_q);
      assert (!word_q2 || !gradient_known_q || gradient_out == gradient_word_q);
      assert (!word_q2 || !q_known_q || q_out == q_word_q);
      // Invariants. In a clock in which the entry is read it is complete, and no longer written.
      assert (seen_q || !(value_known_q || gradient_known_q || q_known_q));
      assert (!(live_q || word_q1) || !value_known_q || value_stored == value_word_q);
      assert (!(live_q || word_q1) || !gradient_known_q || gradient_stored == gradient_word_q);
      assert (!(live_q || word_q1) || !q_known_q || q_stored == q_word_q);
    end
  end

  always_comb begin
    if (rst_ni) begin
      assume (!push_i || !full_o);
      assume (!words.complete || to_complete >= step);
      assume (!words.complete || !live_q || complete || (to_ptr == '0 ? step == size : step <= to_ptr));
      assume (given_step <= complete_in_use);
      assume (!fetch_i || (RING + 1)'(fetch_ptr_i - given_q) < complete_in_use);
      assume (!load_i || (RING + 1)'(load_ptr_i - given_q) < complete_in_use);
      assume (!emit_valid_i || (RING + 1)'(emit_ptr_i - given_q) < complete_in_use);
      assume (words.value_write == '0 || value_at < to_complete);
      assume (words.gradient_write == '0 || gradient_at < to_complete);
      assume (words.q_write == '0 || q_at < to_complete);
      assert (stamp_present_o == (fetch_ptr_i != completed_q));
      assert (entry_o == pushed_q[RING-1:0]);
      assert (full_o == (occupied + push_size > (RING + 1)'(ENTRIES)));
      assert (!live_q || fetch_ptr_i != ptr_q || fetch_homogeneous_o == tag_kept_q[TAG-2]);
      assert (!fetched_q || tag_o == tag_kept_q);
      assert (!loaded_q || stamp_lin_value_o == value_kept_q[5*VAL-1:0]);
      assert (!emit_q1 || tag_slot_o == tag_kept_q[ROW+2*TC+:SLOT]);
      assert (!emit_q2 || {emit_slot, emit_tile_x, emit_tile_y} == tag_kept_q[ROW+:PLACED]);
      assert (!emit_q2 || emit_lin_value == value_kept_q);
      // The registers are what the ports say.
      assert (write_q == pushed_q && complete_q == completed_q && tail_q == given_q);
      assert (full_q == (occupied == ALL) && full_parts_q == (occupied > ALL - PARTS));
      // Invariants. The next entry begins behind this one's last.
      assert (occupied <= (RING + 1)'(ENTRIES) && complete_in_use <= occupied);
      assert (!live_q || (behind >= size && from_given < occupied && (!complete || past_complete >= size)));
      assert (seen_q || !(live_q || fetched_q || loaded_q || emit_q1 || emit_q2 || word_q1 || word_q2));
      assert (!live_q || (tag_there == tag_kept_q && homogeneous_q[place] == tag_kept_q[TAG-2]));
      assert (!live_q || (emit_tag_there == tag_kept_q[ROW+:PLACED] && stamp_value_there == value_kept_q[5*VAL-1:0]));
      assert (!(live_q || emit_q1) || value_there == value_kept_q);
      assert (!emit_q1 || (emit_index_q == place && tag_tile_q == tag_kept_q[ROW+:2*TC]));
      assert (!word_q1 || word_index_q == word_place);
    end
  end
