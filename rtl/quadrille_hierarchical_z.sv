// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Hidden tiles: a memory of bounds that no depth of a tile exceeds in the depth buffer (SPEC.md, hierarchical_z),
// looked at while tile_walk tests a tile.
//
// The tile that is tested in a clock (column_i, row_i, from the quad's first) is read then; in the next, in which the
// walk knows the signs of its functions, hidden_o says that nothing of it can be seen, and the entry is lowered if the
// quad covers all of it. A tile is never read in the clock of a write of another one at its place: neighbours in a walk
// have different places, and between quads and blocks the walk does not test for a clock. So what a test sees is what
// all tiles before it left, whatever waited.
//
// A word is {tag, epoch, far}: the tile's coordinates above those of its place, the clear it belongs to, and the bound,
// all ones for none. A clear takes a clock and then wipes the SECTION places that the epoch names: after as many clears
// as there are epochs every place was wiped once, so that no word of an epoch is older than it. Reset wipes all of
// them. ready_o is low meanwhile: no vertex may be taken.
module quadrille_hierarchical_z #(
    localparam int TC = quadrille_pkg::TC_BITS, V = quadrille_pkg::VIEWPORT_BITS, SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int TL = quadrille_pkg::TILE_LOG2, H = quadrille_pkg::DEPTH_CODE_BITS,
    localparam int PLACE = quadrille_pkg::HIERARCHICAL_Z_TILES_LOG2, EPOCH = quadrille_pkg::HIDDEN_EPOCH_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic clear_i,  // never while the machine is busy
    output logic ready_o,
    output logic [PLACE-1:0] wipe_place_o,  // wiped in this clock, where not ready
    output logic [EPOCH-1:0] epoch_o,
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic on_i,
    // Quad: depth_interval's judgement the clock after start, read at take
    input logic start_i,
    input logic [SLOT-1:0] start_slot_i,
    input logic [H-1:0] near_i, far_i,
    input logic lowers_i, take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // Walk: what it tests; a clock later whether the tile is hidden, or the block
    input logic [quadrille_pkg::TEST_BITS-1:0] test_i,
    output logic hidden_o, block_hidden_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  `QUADRILLE_IN(`QUADRILLE_TEST_T, test)
  localparam int ROW = PLACE / 2;
  localparam int COLUMN = PLACE - ROW;
  // Coordinates of a tile have TC - 1 bits. A tag has one at least, which then is 0.
  localparam int TAG_X = (TC - 1 > COLUMN) ? TC - 1 - COLUMN : 1, TAG_Y = (TC - 1 > ROW) ? TC - 1 - ROW : 1;
  localparam int TAG = TAG_X + TAG_Y, SECTION_LOG2 = quadrille_pkg::HIDDEN_SECTION_LOG2, WORD = TAG + EPOCH + H;
  localparam int WIDE = TC + PLACE;  // so that the slices below exist

  // ---- The quad ----------------------------------------------------------------------------------------------------
  logic start_q1, lowers_q;
  logic [SLOT-1:0] start_slot_q1;
  logic [H-1:0] near_q, far_q;
  logic [TC-1:0] tile_x0_q, tile_y0_q;

  always_ff @(posedge clk_i) begin
    start_q1 <= start_i;
    start_slot_q1 <= start_slot_i;
    if (take_i) begin
      tile_x0_q <= setup.tile_x0;
      tile_y0_q <= setup.tile_y0;
    end
  end

  quadrille_memory #(.WIDTH(2 * H + 1), .DEPTH(1 << SLOT)) u_interval (
      .clk_i, .write_i(start_q1), .write_place_i(start_slot_q1), .write_data_i({lowers_i && on_i, near_i, far_i}),
      .read_i(take_i), .read_place_i(setup.slot), .clear_i(1'b0), .data_o({lowers_q, near_q, far_q})
  );

  // ---- The tile under test -----------------------------------------------------------------------------------------
  logic [TC-1:0] tile_x, tile_y;
  logic [WIDE-1:0] wide_x, wide_y;
  logic [PLACE-1:0] place, place_q1;
  logic [TAG-1:0] tag, tag_q1;
  logic [V:0] x_after, y_after;  // the first column and row of pixels behind it
  logic whole_q1;  // it lies wholly inside the scissor rectangle
  assign tile_x = tile_x0_q + test.column;
  assign tile_y = tile_y0_q + test.row;
  assign wide_x = WIDE'(tile_x);
  assign wide_y = WIDE'(tile_y);
  assign place = {wide_y[ROW-1:0], wide_x[COLUMN-1:0]};
  assign tag = {wide_y[ROW+:TAG_Y], wide_x[COLUMN+:TAG_X]};
  assign x_after = ((V + 1)'(tile_x) + (V + 1)'(1)) << TL;
  assign y_after = ((V + 1)'(tile_y) + (V + 1)'(1)) << TL;

  always_ff @(posedge clk_i) begin
    if (test.go) begin
      place_q1 <= place;
      tag_q1 <= tag;
      whole_q1 <= (V + 1)'(tile_x) << TL >= state.scissor_x0 && x_after <= state.scissor_x1 && (V +
          1)'(tile_y) << TL >= state.scissor_y0 &&
          y_after <= state.scissor_y1;
    end
  end

  // ---- Memory, epochs ----------------------------------------------------------------------------------------------
  logic [WORD-1:0] word_q1, write_word;
  logic [PLACE-1:0] write_place, wipe_q;
  logic [EPOCH-1:0] epoch_q, word_epoch;
  logic [TAG-1:0] word_tag;
  logic [H-1:0] word_far;
  logic wiping_q, wipe_all_q, known, lower;
  assign ready_o = !wiping_q;
  assign wipe_place_o = wipe_q;
  assign epoch_o = epoch_q;
  assign {word_tag, word_epoch, word_far} = word_q1;
  assign known = word_tag == tag_q1 && word_epoch == epoch_q;
  assign hidden_o = on_i && known && near_q >= word_far;
  assign lower = test.tested && test.covered && whole_q1 && lowers_q && !(known && word_far <= far_q);
  assign write_place = wiping_q ? wipe_q : place_q1;
  assign write_word = {tag_q1, epoch_q, wiping_q ? {H{1'b1}} : far_q};

  quadrille_memory #(.WIDTH(WORD), .DEPTH(1 << PLACE), .OLD(1)) u_word (
      .clk_i, .write_i(wiping_q || (lower && test.go)), .write_place_i(write_place), .write_data_i(write_word),
      .read_i(test.go), .read_place_i(place), .clear_i(1'b0), .data_o(word_q1)
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      wiping_q <= 1'b1;
      wipe_all_q <= 1'b1;
      wipe_q <= '0;
      epoch_q <= '0;
    end else if (wiping_q) begin
      wipe_q <= wipe_q + PLACE'(1);
      if (&wipe_q[SECTION_LOG2-1:0] && (!wipe_all_q || &wipe_q)) begin
        wiping_q <= 1'b0;
        wipe_all_q <= 1'b0;
      end
    end else if (clear_i) begin
      wiping_q <= 1'b1;
      wipe_q <= {epoch_q + EPOCH'(1), SECTION_LOG2'(0)};
      epoch_q <= epoch_q + EPOCH'(1);
    end
  end

  // ---- Blocks of tiles ---------------------------------------------------------------------------------------------
  logic learn, block_behind;
  logic [H-1:0] near_next_q;  // what a hidden tile teaches is behind near: a quad hides nothing of itself
  assign learn = test.tested && (hidden_o || (test.covered && whole_q1 && lowers_q));

  assign block_hidden_o = on_i && block_behind;

  always_ff @(posedge clk_i) near_next_q <= near_q + H'(1);

  quadrille_hidden_blocks u_blocks (
      .clk_i, .rst_ni, .wipe_i(wiping_q), .wipe_place_i(wipe_q), .epoch_i(epoch_q), .go_i(test.go),
      .test_i(test.block_test), .tile_x_i(tile_x0_q + test.block_column), .tile_y_i(tile_y0_q + test.block_row),
      .last_column_i(test.block_last_column), .last_row_i(test.block_last_row), .near_i(near_q),
      .hidden_o(block_behind), .learn_x_i(tile_x), .learn_y_i(tile_y), .learn_i(learn), .learn_hidden_i(hidden_o),
      .near_next_i(near_next_q), .far_i(far_q)
  );

  logic unused;
  assign unused = ^{wide_x, wide_y};

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) `QUADRILLE_ASSERT(assert_wipe_alone, !wiping_q || !test.tested,
        "no tile is tested while tiles are wiped")
  end
`endif
endmodule
