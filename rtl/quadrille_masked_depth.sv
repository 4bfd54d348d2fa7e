// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Masked depth: for each tile two bounds that depths in the depth buffer do not exceed, one for all of the tile and a
// nearer one for the pixels in a mask (SPEC.md, masked_depth), looked at and lowered by stamp_coverage.
//
// An entry is read when its tile leaves coverage's tag register (load_i), and judged beside the context register. Its
// rows go with coverage's: a row's covered pixels come two clocks after it is issued, and are written the clock after
// that; what holds for the tile is written with its last row. wait_o keeps a tile in the tag register while one before
// it may still write to its place: then what a tile sees is what all tiles before it left, whatever waited.
//
// Epochs and wiped places are hierarchical_z's. A mask of another epoch, or of a bound that is all ones, is none, so
// masks are not wiped.
module quadrille_masked_depth #(
    localparam int TC = quadrille_pkg::TC_BITS, SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2, TILE = quadrille_pkg::TILE, H = quadrille_pkg::DEPTH_CODE_BITS,
    localparam int PLACE = quadrille_pkg::HIERARCHICAL_Z_TILES_LOG2, EPOCH = quadrille_pkg::HIDDEN_EPOCH_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // hierarchical_z: a place is wiped in this clock
    input logic wipe_i,
    input logic [PLACE-1:0] wipe_place_i,
    input logic [EPOCH-1:0] epoch_i,
    // Quad: depth_interval's judgement the clock after start
    input logic on_i, start_i,
    input logic [SLOT-1:0] start_slot_i,
    input logic [H-1:0] near_i, far_i,
    input logic lowers_i,
    // Coverage: the tile in its tag register, and what its registers do
    input logic [quadrille_pkg::TAG_BITS-1:0] tile_i,
    output logic wait_o,
    input logic [quadrille_pkg::ROWS_BITS-1:0] rows_i,
    output logic hidden_o,  // nothing of the tile in the rows register can be seen: one row, without a pixel, is issued
    output logic [TILE-1:0] seen_o  // pixels that may be seen, of the row issued two clocks before
);
  `QUADRILLE_IN(`QUADRILLE_TAG_T, tile)
  `QUADRILLE_IN(`QUADRILLE_ROWS_T, rows)
  localparam int ROW = PLACE / 2;
  localparam int COLUMN = PLACE - ROW, TAG_X = (TC - 1 > COLUMN) ? TC - 1 - COLUMN : 1;
  localparam int TAG_Y = (TC - 1 > ROW) ? TC - 1 - ROW : 1, TAG = TAG_X + TAG_Y;
  localparam int WIDE = TC + PLACE;  // so that the slices below exist
  localparam int BOUNDS = TAG + EPOCH + 2 * H;  // {tag, epoch, far, masked_far}
  localparam logic [H-1:0] UNKNOWN = {H{1'b1}};  // not '1, of which Yosys 0.23 makes 1 in a parameter

  // ---- The quads ---------------------------------------------------------------------------------------------------
  logic [(1<<SLOT)-1:0] lowers_q;
  logic start_q1;
  logic [SLOT-1:0] start_slot_q1;

  always_ff @(posedge clk_i) begin
    start_q1 <= start_i;
    start_slot_q1 <= start_slot_i;
    if (start_q1) lowers_q[start_slot_q1] <= lowers_i && on_i;
  end

  // ---- The tile in the tag register --------------------------------------------------------------------------------
  logic [WIDE-1:0] wide_x, wide_y;
  logic [PLACE-1:0] place;
  logic [TAG-1:0] tag;
  assign wide_x = WIDE'(tile.tile_x);
  assign wide_y = WIDE'(tile.tile_y);
  assign place = {wide_y[ROW-1:0], wide_x[COLUMN-1:0]};
  assign tag = {wide_y[ROW+:TAG_Y], wide_x[COLUMN+:TAG_X]};

  // ---- Memory: a place that is read is never the one that is written (asserted below) ------------------------------
  logic [TILE-1:0] rows_write, rows_clear, row_word_q3;
  logic bounds_write;
  logic [PLACE-1:0] place_q3, bounds_place;
  logic [BOUNDS-1:0] bounds_word, bounds_read;
  logic [TILE*TILE-1:0] mask_read;

  quadrille_memory #(.WIDTH(BOUNDS), .DEPTH(1 << PLACE)) u_bounds (
      .clk_i, .write_i(bounds_write), .write_place_i(bounds_place), .write_data_i(bounds_word), .read_i(rows.load),
      .read_place_i(place), .clear_i(1'b0), .data_o(bounds_read)
  );

  for (genvar r = 0; r < TILE; r++) begin : gen_mask
    quadrille_memory #(.WIDTH(TILE), .DEPTH(1 << PLACE)) u_row (
        .clk_i, .write_i(rows_write[r]), .write_place_i(place_q3), .write_data_i(rows_clear[r] ? '0 : row_word_q3),
        .read_i(rows.load), .read_place_i(place), .clear_i(1'b0), .data_o(mask_read[r*TILE+:TILE])
    );
  end

  // ---- In the context register: what holds, and what the quad makes of it ------------------------------------------
  logic context_lowers_q;
  logic [PLACE-1:0] place_c, place_r;
  logic [TAG-1:0] tag_c, tag_r, bounds_tag;
  logic [H-1:0] near_c, far_c, bounds_far, bounds_masked;
  logic [TILE_LOG2-1:0] last_row_c, last_row_r;
  logic [EPOCH-1:0] bounds_epoch;
  logic known, useful;

  always_ff @(posedge clk_i) begin
    if (rows.load) begin
      place_c <= place;
      tag_c <= tag;
      last_row_c <= tile.last_row;
    end
  end

  quadrille_memory #(.WIDTH(2 * H), .DEPTH(1 << SLOT)) u_interval (
      .clk_i, .write_i(start_q1), .write_place_i(start_slot_q1), .write_data_i({near_i, far_i}), .read_i(rows.load),
      .read_place_i(tile.slot), .clear_i(1'b0), .data_o({near_c, far_c})
  );

  assign {bounds_tag, bounds_epoch, bounds_far, bounds_masked} = bounds_read;
  assign known = bounds_tag == tag_c && bounds_epoch == epoch_i;
  assign useful = context_lowers_q && (!known || far_c < bounds_far);

  // ---- In the rows register ----------------------------------------------------------------------------------------
  // Nearer than the mask by more than a quarter of what the mask is before the rest: 4 (masked - far_c) > far - masked.
  // As masked is below far, far_c then is below masked.
  logic rows_lowers_q, first_q, masked_hidden_q, useful_q, no_mask_q, begins, joins;
  logic [H-1:0] far_q, old_masked_q, quad_far_q, masked;
  logic [H+2:0] five_masked_q, rest_q;
  logic [TILE*TILE-1:0] mask_q;
  logic [TILE-1:0] old_row;
  logic rest_whole;  // the rows behind the last one that is issued

  always_ff @(posedge clk_i) begin
    if (rows.rows_load) begin
      place_r <= place_c;
      tag_r <= tag_c;
      last_row_r <= last_row_c;
      hidden_o <= on_i && known && near_c >= bounds_far;
      masked_hidden_q <= on_i && known && near_c >= bounds_masked;
      useful_q <= useful;
      no_mask_q <= !known || bounds_masked == UNKNOWN;
      five_masked_q <= {1'b0, bounds_masked, 2'b00} + (H + 3)'(bounds_masked);
      rest_q <= {1'b0, far_c, 2'b00} + (H + 3)'(bounds_far);
      far_q <= known ? bounds_far : UNKNOWN;
      old_masked_q <= bounds_masked;
      quad_far_q <= far_c;
      mask_q <= mask_read;
    end
    first_q <= rows.rows_load || (first_q && !rows.issue);
  end

  assign begins = useful_q && (no_mask_q || five_masked_q > rest_q);
  assign joins = useful_q && !begins;
  assign masked = (begins || quad_far_q > old_masked_q) ? quad_far_q : old_masked_q;

  always_comb begin
    rest_whole = 1'b1;
    for (int r = 0; r < TILE; r++) begin
      if (TILE_LOG2'(r) > last_row_r && !(joins && mask_q[r*TILE+:TILE] == '1)) rest_whole = 1'b0;
    end
  end

  assign old_row = mask_q[rows.row*TILE+:TILE];

  // ---- Issued rows -------------------------------------------------------------------------------------------------
  // {place, tag, far, masked, row, first, last, rest_whole}
  localparam int TAGGED = PLACE + TAG + 2 * H + TILE_LOG2 + 3;
  logic [2:0] begins_way_q, joins_way_q;  // 0: a clock after the issue; neither where the quad changes nothing
  logic [1:0] masked_hidden_way_q, hidden_way_q;
  logic [TAGGED-1:0] way_q1, way_q2, way_q3;
  logic [TILE-1:0] old_q1, old_q2, row_word;
  logic first_q2, first_q3, last_q3, rest_whole_q3;
  logic [TILE_LOG2-1:0] row_q3;
  logic [TAG-1:0] tag_q3;
  logic [H-1:0] far_q3, masked_q3;
  logic some, more, changed_q, changed_before, whole_q, write_q3, clear_q3, lowers_tile;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      begins_way_q <= '0;
      joins_way_q <= '0;
    end else begin
      begins_way_q <= {begins_way_q[1:0], rows.issue && begins};
      joins_way_q <= {joins_way_q[1:0], rows.issue && joins};
    end
  end

  always_ff @(posedge clk_i) begin
    masked_hidden_way_q <= {masked_hidden_way_q[0], masked_hidden_q};
    hidden_way_q <= {hidden_way_q[0], hidden_o};
    way_q1 <= {place_r, tag_r, far_q, masked, rows.row, first_q, rows.done, rest_whole};
    way_q2 <= way_q1;
    way_q3 <= way_q2;
    old_q1 <= old_row;
    old_q2 <= old_q1;
  end

  assign first_q2 = way_q2[2];
  assign {place_q3, tag_q3, far_q3, masked_q3, row_q3, first_q3, last_q3, rest_whole_q3} = way_q3;

  assign seen_o = ~({TILE{masked_hidden_way_q[1]}} & old_q2) & {TILE{!hidden_way_q[1]}};

  // The row's part of the mask, and whether the tile's has changed with it.
  assign some = rows.covered != '0;
  assign more = begins_way_q[1] ? some : (rows.covered & ~old_q2) != '0;
  assign row_word = joins_way_q[1] ? rows.covered | old_q2 : rows.covered;
  assign changed_before = changed_q && !first_q2;

  always_ff @(posedge clk_i) begin
    if (begins_way_q[1] || joins_way_q[1]) begin
      changed_q <= changed_before || more;
      whole_q <= (whole_q || first_q2) && row_word == '1;
    end
    row_word_q3 <= row_word;
    write_q3 <= (begins_way_q[1] || joins_way_q[1]) && some;
    clear_q3 <= begins_way_q[1] && some && !changed_before;  // a new mask: the first row with a pixel clears the others
  end

  always_comb begin
    for (int r = 0; r < TILE; r++) begin
      rows_clear[r] = row_q3 != TILE_LOG2'(r);
      rows_write[r] = write_q3 && (!rows_clear[r] || clear_q3);
    end
  end

  assign lowers_tile = (begins_way_q[2] || joins_way_q[2]) && last_q3 && changed_q;
  assign bounds_write = wipe_i || lowers_tile;
  assign bounds_place = wipe_i ? wipe_place_i : place_q3;
  assign bounds_word = wipe_i ? {tag_q3, epoch_i, UNKNOWN, UNKNOWN}
      : (whole_q && rest_whole_q3) ? {tag_q3, epoch_i, masked_q3, UNKNOWN} : {tag_q3, epoch_i, far_q3, masked_q3};

  // ---- Tiles that may still write: the low bits of their places are enough, of x and of y --------------------------
  // Of one quad no two are so near one another in the walk that these could be the same.
  localparam int LOW = 3;
  logic [2*LOW-1:0] low, low_c, low_r, low_q1, low_q2, low_q3;
  logic [2:0] way_lowers_q;
  assign low = {tile.tile_y[LOW-1:0], tile.tile_x[LOW-1:0]};
  assign wait_o = !tile.end_token && ((context_lowers_q && low == low_c) || (rows_lowers_q && low == low_r)
      || (way_lowers_q[0] && low == low_q1) || (way_lowers_q[1] && low == low_q2) ||
          (way_lowers_q[2] && low == low_q3));

  always_ff @(posedge clk_i) begin
    if (rows.load) low_c <= low;
    if (rows.rows_load) low_r <= low_c;
    low_q1 <= low_r;
    low_q2 <= low_q1;
    low_q3 <= low_q2;
    if (!rst_ni) begin
      context_lowers_q <= 1'b0;
      rows_lowers_q <= 1'b0;
      way_lowers_q <= '0;
    end else begin
      context_lowers_q <= rows.load ? lowers_q[tile.slot] && !tile.end_token : context_lowers_q && !rows.rows_load;
      rows_lowers_q <= rows.rows_load ? context_lowers_q : rows_lowers_q && !rows.done;
      way_lowers_q <= {way_lowers_q[1:0], rows.issue && rows_lowers_q};
    end
  end

  logic unused;
  assign unused = ^{wide_x, wide_y, first_q3};

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_bounds_race,
          !rows.load || tile.end_token || !bounds_write || place != bounds_place,
          "bounds are not read in the clock of their write")
      `QUADRILLE_ASSERT(assert_mask_race,
          !rows.load || tile.end_token || !write_q3 || place != place_q3,
          "a mask is not read in the clock of its write")
    end
  end
`endif
endmodule
