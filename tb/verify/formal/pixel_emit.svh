  // pixel_emit: each pixel of a stamp is sent once, the PIXELS_PER_CLOCK lowest that are left a clock, lowest in lane 0, with its own front and tie;
  // of a homogeneous quad after its two parts; the head is popped with the last; an end entry gives an end beat. Never more pixels than places;
  // something goes out in each clock in which there is a head and a place, so no deadlock.
  // By induction, with one pixel of the row chosen freely.
  // Assumed: the head stays until it is popped and has a pixel unless it is an end; places are given back that were taken (fragment_fifo:
  // freed_o is a hand-over; a pixel is discarded or pushed once).
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);

  (* anyconst *) logic [TILE_LOG2-1:0] which;
  localparam int TAKEN = PLACES + 2;
  localparam int HEAD = 2 + RING + 1 + TILE_LOG2 + 3 * TILE;
  logic [TAKEN-1:0] taken_q;  // places that pixels have
  logic [TILE-1:0] left_q, left;  // of the head's pixels
  logic fresh_q;  // nothing of the head has been sent
  logic [1:0] parts_q;  // of its next pixels that went before
  logic [HEAD-1:0] whole_head, head_q;
  logic held_q;
  logic go, pixels, mine;
  logic [TILE_LOG2:0] below;  // pixels that are left below the chosen one
  logic pixels_q, mine_q, front_q, tie_q, end_q;
  logic [TILE_LOG2-1:0] row_q;
  logic [1:0] part_spec_q;
  logic [TILE_LOG2:0] below_q;
  logic [TILE_LOG2:0] many;  // pixels that are left

  assign whole_head = {head.end_token, head.homogeneous, head.tile_ptr, head.row, head.mask, head.front, head.tie};
  assign left = fresh_q ? head.mask : left_q;
  assign go = head_valid_i && !head.end_token && taken_q < TAKEN'(1 << PLACES);
  assign pixels = go && (!head.homogeneous || parts_q == 2'd2);

  always_comb begin
    below = '0;
    many = '0;
    for (int i = 0; i < TILE; i++) begin
      if (left[i] && TILE_LOG2'(i) < which) below = below + 1;
      if (left[i]) many = many + 1;
    end
  end

  assign mine = pixels && left[which] && below < P;

  logic [TILE-1:0] left_next;  // by its own count from below
  logic [TILE_LOG2:0] gone;

  always_comb begin
    left_next = left;
    gone = '0;
    for (int i = 0; i < TILE; i++) begin
      if (left[i] && gone < P) begin
        left_next[i] = 1'b0;
        gone = gone + 1;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      taken_q <= '0;
      fresh_q <= 1'b1;
      parts_q <= '0;
      held_q <= 1'b0;
      pixels_q <= 1'b0;
      mine_q <= 1'b0;
      end_q <= 1'b0;
      part_spec_q <= '0;
    end else begin
      taken_q <= taken_q + TAKEN'(pixels) - TAKEN'(freed_i) - TAKEN'(discard_i);
      if (pop_o) fresh_q <= 1'b1;
      else if (pixels) fresh_q <= 1'b0;
      if (pixels) left_q <= left_next;
      if (go) parts_q <= (!head.homogeneous || parts_q == 2'd2) ? 2'd0 : parts_q + 2'd1;
      held_q <= head_valid_i && !pop_o;
      pixels_q <= pixels;
      mine_q <= mine;
      end_q <= head_valid_i && head.end_token;
      part_spec_q <= (go && head.homogeneous) ? parts_q + 2'd1 : 2'd0;
    end
    head_q <= whole_head;
    below_q <= below;
    front_q <= head.front[which];
    tie_q <= head.tie[which];
    row_q <= head.row;
  end

  logic [P-1:0] is_mine;
  always_comb for (int g = 0; g < P; g++) is_mine[g] = sent_valid[g] && sent_dx[g*TILE_LOG2+:TILE_LOG2] == which;

  always_comb begin
    if (rst_ni) begin
      assume (!held_q || (head_valid_i && whole_head == head_q));
      assume (!head_valid_i || head.end_token || head.mask != '0);
      assume (TAKEN'(freed_i) + TAKEN'(discard_i) <= taken_q);
      assert (taken_q <= TAKEN'(1 << PLACES));
      assert (pop_o == (head_valid_i && (head.end_token || (pixels && left_next == '0))));
      // A clock later: the chosen pixel in the lane of its rank, and nowhere else
      assert (sent_valid[0] == pixels_q);
      assert (is_mine == (mine_q ? P'(1) << below_q : P'(0)));
      for (int g = 0; g < P; g++) if (mine_q && is_mine[g]) assert (sent_front[g] == front_q && sent_tie[g] == tie_q);
      assert (!mine_q || sent_row == row_q);
      assert (sent_end == end_q && sent_part == part_spec_q);
      // Invariants
      assert (spare_q == TAKEN'((1 << PLACES) - 1) - taken_q);
      assert (part_q == parts_q && parts_q < 2'd3);
      assert (fresh_q || held_q);
      assert (parts_q == 2'd0 || (held_q && head.homogeneous));
      assert (sent_q == (fresh_q ? TILE'(0) : head.mask & ~left_q));
      assert (fresh_q || (left_q != '0 && (left_q & ~head.mask) == '0));
    end
  end
