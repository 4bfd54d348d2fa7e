// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Coverage of one tile row (a TILE x 1 stamp) a clock: the five edge functions at each pixel, the two clauses in both
// orientations, culling, the scissor rectangle. Stamps with a covered pixel go to the stamp FIFO, an end entry passes
// through.
//
// Ties: E = 0 counts as the sign of (dE/dx, dE/dy), the first that is not 0 (tie_pos_i, tie_neg_i); an edge function
// without gradient has no sign. An entry comes in three registers: its tag (read with fetch_o), then its values and its
// quad's constants (read with load_o), then the rows' own, with the multiples of gx that the pixels of a row need.
// Behind them a row takes three registers (values; signs; masks) that never wait: it is sent in only while the FIFO has
// a place for it, and the place of a row without a covered pixel is given back.
module quadrille_stamp_coverage #(
    localparam int V = quadrille_pkg::VIEWPORT_BITS, TC = quadrille_pkg::TC_BITS, VAL = quadrille_pkg::VAL_BITS,
    localparam int GRAD = quadrille_pkg::GRAD_BITS, RING = quadrille_pkg::RING_LOG2,
    localparam int PLACES = quadrille_pkg::STAMP_PLACES, TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int TILE = quadrille_pkg::TILE
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // Tile ring: the tag is there the clock after fetch_o, until the next
    input logic present_i,
    output logic fetch_o,
    output logic [RING:0] fetch_ptr_o,
    input logic fetch_homogeneous_i,  // of the entry at fetch_ptr_o
    input logic [quadrille_pkg::TAG_BITS-1:0] tag_i,
    // Tile ring and quad: values and constants are there the clock after load_o, until the next
    output logic load_o,
    output logic [RING:0] load_ptr_o,
    input logic [5*VAL-1:0] lin_value_i,
    input logic [quadrille_pkg::EDGES_BITS-1:0] edges_i,
    // Hidden tiles: what goes with the registers; a tile that waits stays in the tag register
    output logic [quadrille_pkg::ROWS_BITS-1:0] rows_o,
    input logic wait_i,
    input logic hidden_i,  // of the tile in the rows register nothing can be seen: one row is issued
    input logic [TILE-1:0] seen_i,  // of the covered pixels of the row issued two clocks before, those that may be seen
    // Stamp FIFO: freed_i when a stamp has left it. No row of an entry before the stamp's tile is still to come
    input logic freed_i,
    output logic push_o,
    output logic [quadrille_pkg::STAMP_BITS-1:0] stamp_o,
    // For performance_counters, else 0: a tile's rows are left out, a row is tested; the rows register has a tile,
    // another is behind it
    output logic [3:0] events_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_TAG_T, tag)
  `QUADRILLE_IN(`QUADRILLE_EDGES_T, edges)
  // ---- Control ------------------------------------------------------------------------------------------------------
  localparam logic [RING:0] PARTS = (RING + 1)'(quadrille_pkg::HOMOGENEOUS_PARTS);
  logic [RING:0] fetch_q, load_q, row_ptr_q;
  logic tag_valid_q, context_valid_q, rows_valid_q, rows_load, rows_done, issue, context_end_q, rows_end_q;
  logic context_homogeneous_q, rows_homogeneous_q;
  logic [TILE_LOG2-1:0] row_q, last_row_q, context_last_row_q;
  localparam int ROOM = $clog2(PLACES + 1);
  logic [ROOM-1:0] room_q;  // places of the FIFO that no stamp has, nor a row on its way
  logic freed_q, drop;
  logic [TILE-1:0] covered;  // of the row issued two clocks before
  assign events_o = {4{quadrille_pkg::PERFORMANCE_COUNTERS != 0}} &
      {issue && !rows_end_q && hidden_i, issue && !rows_end_q && !hidden_i, rows_valid_q, context_valid_q};
  assign issue = rows_valid_q && room_q != '0;
  assign rows_done = issue && (rows_end_q || hidden_i || row_q == last_row_q);
  assign rows_load = context_valid_q && (!rows_valid_q || rows_done);
  assign load_o = tag_valid_q && (!context_valid_q || rows_load) && !wait_i;
  assign fetch_o = present_i && (!tag_valid_q || load_o);
  assign fetch_ptr_o = fetch_q;
  assign load_ptr_o = load_q;
  assign rows_o = {load_o, rows_load, issue, rows_done, row_q, covered};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      fetch_q <= '0;
      load_q <= '0;
      row_ptr_q <= '0;
      tag_valid_q <= 1'b0;
      context_valid_q <= 1'b0;
      rows_valid_q <= 1'b0;
      freed_q <= 1'b0;
      room_q <= ROOM'(PLACES);
    end else begin
      if (fetch_o) fetch_q <= fetch_q + (fetch_homogeneous_i ? PARTS : (RING + 1)'(1));
      if (load_o) load_q <= load_q + (tag.homogeneous ? PARTS : (RING + 1)'(1));
      if (rows_done) row_ptr_q <= row_ptr_q + (rows_homogeneous_q ? PARTS : (RING + 1)'(1));
      tag_valid_q <= fetch_o || (tag_valid_q && !load_o);
      context_valid_q <= load_o || (context_valid_q && !rows_load);
      rows_valid_q <= rows_load || (rows_valid_q && !rows_done);
      freed_q <= freed_i;
      room_q <= room_q - ROOM'(issue) + ROOM'(drop) + ROOM'(freed_q);
    end
  end

  logic [TC-1:0] context_x_q, context_y_q, tile_x_q, tile_y_q;
  logic [4:0] tie_pos_q, tie_neg_q;
  logic [3:0] visible_q;

  always_ff @(posedge clk_i) begin
    if (load_o) begin
      {context_end_q, context_homogeneous_q, context_x_q, context_y_q} <= {tag.end_token, tag.homogeneous, tag.tile_x,
          tag.tile_y};
      context_last_row_q <= tag.last_row;
    end
    if (rows_load) begin
      {rows_end_q, rows_homogeneous_q, tile_x_q, tile_y_q} <= {context_end_q, context_homogeneous_q, context_x_q,
          context_y_q};
      {tie_pos_q, tie_neg_q, visible_q} <= {edges.tie_pos, edges.tie_neg, edges.visible};
      row_q <= '0;
      last_row_q <= context_last_row_q;
    end else if (issue) begin
      row_q <= row_q + TILE_LOG2'(1);
    end
  end

  // ---- Values, and their signs -------------------------------------------------------------------------------------
  // A row's values differ from its first by less than TILE |gx|: if that is further from zero than they reach, all have
  // its sign.
  localparam int MULT = GRAD + TILE_LOG2;  // TILE gx
  localparam int CLOSE = (MULT + 2 < VAL) ? MULT + 2 : VAL;  // a first value that is close, and what it reaches
  logic [5*TILE-1:0] is_neg_q2, is_zero_q2;

  for (genvar g = 0; g < 5; g++) begin : gen_edge
    logic [MULT-1:0] gx;
    logic [GRAD-1:0] gy_q;
    logic [VAL-1:0] row_value_q;
    logic far, far_q1, far_neg_q1;
    assign gx = MULT'($signed(edges.gx[g*GRAD+:GRAD]));

    always_ff @(posedge clk_i) begin
      if (rows_load) begin
        row_value_q <= lin_value_i[g*VAL+:VAL];
        gy_q <= edges.gy[g*GRAD+:GRAD];
      end else if (issue) begin
        row_value_q <= row_value_q + VAL'($signed(gy_q));
      end
    end

    // Close: the sign, from the bit below the sign of CLOSE bits on.
    assign far = CLOSE < VAL && row_value_q[VAL-1:CLOSE-2] != '0 && row_value_q[VAL-1:CLOSE-2] != '1;

    always_ff @(posedge clk_i) if (issue) {far_q1, far_neg_q1} <= {far, row_value_q[VAL-1]};

    // Odd multiples: the neighbour that four divides, plus or minus gx.
    for (genvar k = 0; k < TILE / 2; k++) begin : gen_multiple
      localparam int ODD = 2 * k + 1, NEAR = (ODD % 4 == 3) ? ODD + 1 : ODD - 1;
      localparam int ZEROS = (NEAR % 16 == 0) ? 4 : (NEAR % 8 == 0) ? 3 : 2;  // NEAR = its odd part times 2^ZEROS
      logic [MULT-1:0] multiple, multiple_q;

      if (ODD == 1) begin : gen_one
        assign multiple = gx;
      end else if (NEAR > ODD) begin : gen_below
        assign multiple = (gen_multiple[(NEAR>>ZEROS)/2].multiple << ZEROS) - gx;
      end else begin : gen_above
        assign multiple = (gen_multiple[(NEAR>>ZEROS)/2].multiple << ZEROS) + gx;
      end

      always_ff @(posedge clk_i) if (rows_load) multiple_q <= multiple;
    end

    for (genvar dx = 0; dx < TILE; dx++) begin : gen_pixel
      // dx = its odd part times 2^ZEROS
      localparam int ZEROS = (dx % 8 == 0) ? 3 : (dx % 4 == 0) ? 2 : (dx % 2 == 0) ? 1 : 0;
      logic [CLOSE-1:0] value_q1;

      if (dx == 0) begin : gen_first
        always_ff @(posedge clk_i) if (issue) value_q1 <= row_value_q[CLOSE-1:0];
      end else begin : gen_next
        always_ff @(posedge clk_i) if (issue) value_q1 <= row_value_q[CLOSE-1:0] +
            (CLOSE'($signed(gen_multiple[(dx>>ZEROS)/2].multiple_q)) << ZEROS);
      end

      always_ff @(posedge clk_i) begin
        if (row_valid_q[0]) begin
          is_zero_q2[g*TILE+dx] <= value_q1 == '0 && !far_q1;
          is_neg_q2[g*TILE+dx] <= far_q1 ? far_neg_q1 : value_q1[CLOSE-1];
        end
      end
    end
  end

  // ---- Scissor, beside the values ----------------------------------------------------------------------------------
  logic [V:0] y;
  logic [TC-1:0] first_tile, end_tile;  // of the rectangle's columns
  logic [TILE_LOG2-1:0] first_dx, end_dx;
  logic row_inside_q1, right_of_first_q1, in_first_q1, left_of_end_q1, in_end_q1;
  logic [TILE-1:0] in_scissor_q2;
  assign y = {tile_y_q, row_q};
  assign {first_tile, first_dx} = state.scissor_x0;
  assign {end_tile, end_dx} = state.scissor_x1;

  always_ff @(posedge clk_i) begin
    row_inside_q1 <= y >= state.scissor_y0 && y < state.scissor_y1;
    right_of_first_q1 <= tile_x_q > first_tile;
    in_first_q1 <= tile_x_q == first_tile;
    left_of_end_q1 <= tile_x_q < end_tile;
    in_end_q1 <= tile_x_q == end_tile;
    if (row_valid_q[0]) begin
      for (int dx = 0; dx < TILE; dx++) begin
        in_scissor_q2[dx] <= row_inside_q1 && (right_of_first_q1 || (in_first_q1 && TILE_LOG2'(dx) >= first_dx))
            && (left_of_end_q1 || (in_end_q1 && TILE_LOG2'(dx) < end_dx));
      end
    end
  end

  // ---- What goes with a row ----------------------------------------------------------------------------------------
  localparam int SIGNS = 5 + 5 + 4;
  logic [2:0] row_valid_q;
  logic end_q1, end_q2, end_q3, homogeneous_q1, homogeneous_q2, homogeneous_q3;
  logic [RING:0] ptr_q1, ptr_q2, ptr_q3;
  logic [TILE_LOG2-1:0] row_q1, row_q2, row_q3;
  logic [SIGNS-1:0] signs_q1, signs_q2;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      row_valid_q <= '0;
      ptr_q1 <= '0;
      ptr_q2 <= '0;
      ptr_q3 <= '0;
    end else begin
      row_valid_q <= {row_valid_q[1:0], issue};
      ptr_q1 <= row_ptr_q;
      ptr_q2 <= ptr_q1;
      ptr_q3 <= ptr_q2;
    end
  end

  always_ff @(posedge clk_i) begin
    {end_q1, homogeneous_q1, row_q1, signs_q1} <= {rows_end_q, rows_homogeneous_q, row_q, tie_pos_q, tie_neg_q,
        visible_q};
    {end_q2, homogeneous_q2, row_q2, signs_q2} <= {end_q1, homogeneous_q1, row_q1, signs_q1};
    {end_q3, homogeneous_q3, row_q3} <= {end_q2, homogeneous_q2, row_q2};
  end

  // ---- Clauses -----------------------------------------------------------------------------------------------------
  logic [4:0] tie_pos, tie_neg;
  logic [3:0] visible;
  logic [5*TILE-1:0] pos, neg, zero;
  logic [TILE-1:0] back, front, mask, mask_q3, front_q3, tie_q3;
  assign {tie_pos, tie_neg, visible} = signs_q2;

  for (genvar g = 0; g < 5; g++) begin : gen_sign
    logic [TILE-1:0] is_zero, is_neg;
    assign is_zero = is_zero_q2[g*TILE+:TILE];
    assign is_neg = is_neg_q2[g*TILE+:TILE];
    assign zero[g*TILE+:TILE] = is_zero & {TILE{tie_pos[g] || tie_neg[g]}};  // an all-zero edge decides nothing
    assign neg[g*TILE+:TILE] = is_neg | (is_zero & {TILE{tie_neg[g]}});
    assign pos[g*TILE+:TILE] = (~is_neg & ~is_zero) | (is_zero & {TILE{tie_pos[g]}});
  end

  quadrille_inside_expression #(.PLACES(TILE)) u_inside (
      .cull_i(state.cull), .visible_i(visible), .pos_i(pos), .neg_i(neg), .back_o(back), .front_o(front)
  );

  assign covered = end_q2 ? '0 : (back | front) & in_scissor_q2;
  assign mask = covered & seen_i;

  always_ff @(posedge clk_i) begin
    mask_q3 <= mask;
    front_q3 <= front & mask;
    tie_q3 <= (zero[0+:TILE] | zero[TILE+:TILE] | zero[2*TILE+:TILE] | zero[3*TILE+:TILE] | zero[4*TILE+:TILE]) & mask;
  end

  // ---- Push --------------------------------------------------------------------------------------------------------
  assign push_o = row_valid_q[2] && (end_q3 || mask_q3 != '0);
  assign drop = row_valid_q[2] && !push_o;
  assign stamp_o = {homogeneous_q3, end_q3, ptr_q3, row_q3, mask_q3, front_q3, tie_q3};  // an end entry's row is 0

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_room_range, room_q <= ROOM'(PLACES), "the count of free places is in range")
      `QUADRILLE_ASSERT(assert_end_empty,
          !row_valid_q[2] || !end_q3 || (row_q3 == '0 && mask_q3 == '0),
          "an end entry has no row and no pixel")
    end
  end
`endif
endmodule
