// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
// Hidden blocks: of blocks of 8x8 tiles of the viewport's grid, bounds that no depth of theirs exceeds in the depth
// buffer (SPEC.md, hidden_blocks), looked at while tile_walk tests a block, and learned from what hierarchical_z says
// of each tile under test.
//
// A block of the walk begins at any tile and so lies over up to four blocks of the grid. They are read at once, from
// four banks by the lowest bit of a block's column and row: what two neighbours have in common never is that bit.
// hidden_o says in the clock after the test that near does not lie before any of those that a tile of the walk's block
// is in.
//
// What a tile's test says goes into its block's word a step of the walk later; the word is read with the test, and
// those of the two tiles before go around the memory. A block that is tested meanwhile does not see it, nor need it:
// what a quad teaches hides nothing of itself, and what the walk has in hand at once lies less than four columns and
// rows of blocks apart, so that none of it is forgotten for another (asserted). The next quad's first block is tested
// later.
module quadrille_hidden_blocks #(
    localparam int TC = quadrille_pkg::TC_BITS, H = quadrille_pkg::DEPTH_CODE_BITS,
    localparam int BLOCK_LOG2 = quadrille_pkg::BLOCK_LOG2, PLACE = quadrille_pkg::HIERARCHICAL_Z_TILES_LOG2,
    localparam int EPOCH = quadrille_pkg::HIDDEN_EPOCH_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // hierarchical_z: a place of a tile is wiped in this clock
    input logic wipe_i,
    input logic [PLACE-1:0] wipe_place_i,
    input logic [EPOCH-1:0] epoch_i,
    // The block under test, by its first tile and the tiles behind that
    input logic go_i,  // the walk moves
    input logic test_i,  // and tests a block
    input logic [TC-1:0] tile_x_i, tile_y_i,
    input logic [BLOCK_LOG2-1:0] last_column_i, last_row_i,
    input logic [H-1:0] near_i,  // of its quad; a clock later
    output logic hidden_o,  // if it was a block, nothing of it can be seen
    // The tile under test; a clock later: no depth of it is beyond far, or it is hidden, and none is beyond near + 1
    input logic [TC-1:0] learn_x_i, learn_y_i,
    input logic learn_i, learn_hidden_i,
    input logic [H-1:0] near_next_i,  // of its quad, for another step
    input logic [H-1:0] far_i
);
  // Blocks in a row and a column of places: four at least, 2^PLACE tiles where that is more.
  localparam int ROW = (PLACE / 2 > BLOCK_LOG2 + 2) ? PLACE / 2 - BLOCK_LOG2 : 2;
  localparam int COLUMN = (PLACE - PLACE / 2 > BLOCK_LOG2 + 2) ? PLACE - PLACE / 2 - BLOCK_LOG2 : 2;
  localparam int PLACES = ROW + COLUMN;
  localparam int INDEX = PLACES - 2;  // of a bank
  // Coordinates of a tile have TC - 1 bits, those of a block BLOCK_LOG2 less. A tag has one at least, which then is 0.
  localparam int COORDINATE = TC - 1 - BLOCK_LOG2, TAG_X = (COORDINATE > COLUMN) ? COORDINATE - COLUMN : 1;
  localparam int TAG_Y = (COORDINATE > ROW) ? COORDINATE - ROW : 1, TAG = TAG_X + TAG_Y;
  localparam int WIDE = TC + PLACE;  // so that the slices below exist
  localparam int BANKS = 4;  // {lowest bit of the row, of the column}
  localparam int TILES = 1 << 2 * BLOCK_LOG2;
  localparam logic [H-1:0] UNKNOWN = {H{1'b1}};  // not '1, of which Yosys 0.23 makes 1 in a parameter

  localparam int BOUND = TAG + EPOCH + H;  // {tag, epoch, far}: what a test reads
  localparam int WORD = BOUND + H + TILES;  // {bound, masked_far, mask}: what a tile that is learned reads

  // ---- The block under test ----------------------------------------------------------------------------------------
  // Columns and rows without their lowest bit: with a first column that is odd, the even one is the next.
  logic [WIDE-1:0] first_x, first_y;
  logic [BLOCK_LOG2:0] end_x, end_y;
  logic [WIDE-1:0] even_x, odd_x, even_y, odd_y;
  logic [1:0] needs_x, needs_y;  // by the lowest bit
  assign first_x = WIDE'(tile_x_i) >> BLOCK_LOG2;
  assign first_y = WIDE'(tile_y_i) >> BLOCK_LOG2;
  assign end_x = (BLOCK_LOG2 + 1)'(tile_x_i[BLOCK_LOG2-1:0]) + (BLOCK_LOG2 + 1)'(last_column_i);
  assign end_y = (BLOCK_LOG2 + 1)'(tile_y_i[BLOCK_LOG2-1:0]) + (BLOCK_LOG2 + 1)'(last_row_i);
  assign even_x = (first_x + WIDE'(1)) >> 1;
  assign odd_x = first_x >> 1;
  assign even_y = (first_y + WIDE'(1)) >> 1;
  assign odd_y = first_y >> 1;
  assign needs_x = {first_x[0] || end_x[BLOCK_LOG2], !first_x[0] || end_x[BLOCK_LOG2]};
  assign needs_y = {first_y[0] || end_y[BLOCK_LOG2], !first_y[0] || end_y[BLOCK_LOG2]};

  // ---- The tile that is tested -------------------------------------------------------------------------------------
  // 1: its test is known, its block's word is there; 2: what it teaches becomes the block's.
  logic learn_q2, learn_q3, again_q2;
  logic [WIDE-1:0] learn_x, learn_y;
  logic [PLACES-1:0] place, place_q1, place_q2, place_q3;  // {bank, place in it}
  logic [TAG-1:0] learn_tag, tag_q1, tag_q2;
  logic [2*BLOCK_LOG2-1:0] tile_q1, tile_q2;
  logic hidden_q2;
  assign learn_x = WIDE'(learn_x_i) >> BLOCK_LOG2;
  assign learn_y = WIDE'(learn_y_i) >> BLOCK_LOG2;
  assign place = {learn_y[0], learn_x[0], learn_y[ROW-1:1], learn_x[COLUMN-1:1]};
  assign learn_tag = {learn_y[ROW+:TAG_Y], learn_x[COLUMN+:TAG_X]};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) {learn_q2, learn_q3} <= '0;
    else if (go_i) {learn_q2, learn_q3} <= {learn_i, learn_q2};
  end

  always_ff @(posedge clk_i) begin
    if (go_i) begin
      place_q1 <= place;
      tag_q1 <= learn_tag;
      tile_q1 <= {learn_y_i[BLOCK_LOG2-1:0], learn_x_i[BLOCK_LOG2-1:0]};
      place_q2 <= place_q1;
      tag_q2 <= tag_q1;
      tile_q2 <= tile_q1;
      hidden_q2 <= learn_hidden_i;
      again_q2 <= learn_q2 && place_q1 == place_q2;
      place_q3 <= place_q2;
    end
  end

  // ---- What it makes of its block ----------------------------------------------------------------------------------
  // {far, masked_far, mask}; masked_far is 0 where the mask is empty. A word is read a step before that of the tile two
  // before is written; tiles so near one another in the walk that have one place have one block.
  localparam int STATE = 2 * H + TILES;
  logic [WORD-1:0] word_q1;
  logic [STATE-1:0] state_q2, before_q3, state, next;
  logic [TAG-1:0] word_tag;
  logic [EPOCH-1:0] word_epoch;
  logic [STATE-1:0] word_state;
  logic [H-1:0] state_far, state_masked, far, masked;
  logic [TILES-1:0] state_mask, mask;
  logic known, whole, joins, again_q1;
  assign {word_tag, word_epoch, word_state} = word_q1;
  assign known = word_tag == tag_q1 && word_epoch == epoch_i;
  assign again_q1 = learn_q3 && place_q1 == place_q3;
  assign state = again_q2 ? before_q3 : state_q2;
  assign {state_far, state_masked, state_mask} = state;
  assign far = hidden_q2 ? near_next_i : far_i;
  assign masked = far > state_masked ? far : state_masked;
  assign joins = learn_q2 && far < state_far;
  assign whole = mask == {TILES{1'b1}};
  assign next = whole ? {masked, H'(0), TILES'(0)} : {state_far, masked, mask};

  always_comb for (int i = 0; i < TILES; i++) mask[i] = tile_q2 == (2 * BLOCK_LOG2)'(i) || state_mask[i];

  always_ff @(posedge clk_i) begin
    if (go_i) begin
      if (again_q1) state_q2 <= before_q3;
      else state_q2 <= known ? word_state : {UNKNOWN, (H + TILES)'(0)};
      before_q3 <= joins ? next : state;
    end
  end

  // ---- Memory ------------------------------------------------------------------------------------------------------
  // A word that is written while it is read is not looked at, but before_q3 (asserted).
  logic write;
  logic [INDEX-1:0] wipe_index, write_index;
  logic [WORD-1:0] new_word;
  logic [PLACES-1:0] write_place;
  // what the bank's word tells of the block under test: nothing of it can be seen, or it is not asked
  logic [BANKS-1:0] behind;
  assign write = wipe_i || (joins && go_i);
  assign write_place = wipe_i ? wipe_place_i[PLACE-1-:PLACES] : place_q2;
  assign wipe_index = wipe_place_i[PLACE-1-:INDEX];
  assign write_index = wipe_i ? wipe_index : place_q2[INDEX-1:0];
  assign new_word = {tag_q2, epoch_i, wipe_i ? {UNKNOWN, (H + TILES)'(0)} : next};

  quadrille_memory #(.WIDTH(WORD), .DEPTH(1 << PLACES)) u_word (
      .clk_i, .write_i(write), .write_place_i(write_place), .write_data_i(new_word), .read_i(go_i),
      .read_place_i(place), .clear_i(1'b0), .data_o(word_q1)
  );

  for (genvar b = 0; b < BANKS; b++) begin : gen_bank
    logic [BOUND-1:0] bound_q1;
    logic [WIDE-1:0] x, y;
    logic [INDEX-1:0] index;
    logic [TAG-1:0] tag, asked_q1, bound_tag;
    logic [EPOCH-1:0] bound_epoch;
    logic [H-1:0] bound_far;
    logic needed_q1;
    assign x = (b % 2 == 0) ? even_x : odd_x;
    assign y = (b / 2 == 0) ? even_y : odd_y;
    assign index = {y[ROW-2:0], x[COLUMN-2:0]};
    assign tag = {y[ROW-1+:TAG_Y], x[COLUMN-1+:TAG_X]};
    quadrille_memory #(.WIDTH(BOUND), .DEPTH(1 << INDEX), .OLD(1)) u_bound (
        .clk_i, .write_i(write && (wipe_i || place_q2[PLACES-1-:2] == 2'(b))), .write_place_i(write_index),
        .write_data_i(new_word[WORD-1-:BOUND]), .read_i(test_i), .read_place_i(index), .clear_i(1'b0), .data_o(bound_q1)
    );

    always_ff @(posedge clk_i) begin
      if (test_i) begin
        asked_q1 <= tag;
        needed_q1 <= needs_x[b%2] && needs_y[b/2];
      end
    end

    assign {bound_tag, bound_epoch, bound_far} = bound_q1;
    assign behind[b] = !needed_q1 || (bound_tag == asked_q1 && bound_epoch == epoch_i && near_i >= bound_far);

    logic unused;
    assign unused = ^{x, y};

`ifndef SYNTHESIS
    // Nothing that a test reads is on its way to be forgotten.
    always_ff @(posedge clk_i) begin
      if (rst_ni && test_i && needs_x[b%2] && needs_y[b/2]) begin
        `QUADRILLE_ASSERT(assert_read_tag,
            !(learn_i && place_q1 == {2'(b), index}) || tag_q1 == tag,
            "a block learned in this clock is read with its tag")
        `QUADRILLE_ASSERT(assert_written_tag,
            !(learn_q2 && place_q2 == {2'(b), index}) || tag_q2 == tag,
            "a block written is read with its tag")
      end
    end
`endif
  end

  assign hidden_o = &behind;

  logic unused;
  assign unused = ^{first_x, first_y, end_x, end_y, learn_x, learn_y, wipe_place_i};

`ifndef SYNTHESIS
  logic written_q1;  // while word_q1 was read

  always_ff @(posedge clk_i) begin
    if (go_i) written_q1 <= write && write_place == place;
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_learned_again,
          !(go_i && learn_i && written_q1) || again_q1,
          "a block learned twice running is known as such")
      `QUADRILLE_ASSERT(assert_wipe_alone, !wipe_i || !learn_q2, "nothing is learned while blocks are wiped")
      `QUADRILLE_ASSERT(assert_one_tag,
          !(learn_i && learn_q2 && place_q1 == place_q2) || tag_q1 == tag_q2,
          "two neighbours of one place have one tag")
    end
  end
`endif
endmodule
