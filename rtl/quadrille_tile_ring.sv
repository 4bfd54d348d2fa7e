// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Ring of tile contexts between the walk and the pixels. Pointers have one extra bit.
//
// A tile of an ordinary quad is one entry. One of a homogeneous quad takes HOMOGENEOUS_PARTS: its quadratic functions
// are in as many words of four, one an entry, all else in the first. The walk writes linear functions and tag,
// tile_context the words; only then (complete_i) coverage sees the entry.
//
// An entry lives until the last stamp of its tile has been emitted: the tail is the tile of the stamp FIFO's head, or,
// when the FIFO is empty, the entry of the row that coverage has at its end. It is a register: an entry is free two
// clocks after its last stamp was popped, which is the clock in which emission reads its values for the last time
// (asserted). Reads end in registers. Coverage: tag with fetch_i, values with load_i. Emission, every clock: the tag a
// clock after the pointer, all else two clocks after it, so that the quad's constants, found by the tag's slot, arrive
// together with it; of the words that of the pixel's part.
module quadrille_tile_ring #(
    localparam int TC = quadrille_pkg::TC_BITS, VAL = quadrille_pkg::VAL_BITS, QVAL = quadrille_pkg::QVAL_BITS,
    localparam int QGRAD = quadrille_pkg::QGRAD_BITS, QCURV = quadrille_pkg::QCURV_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2, RING = quadrille_pkg::RING_LOG2,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS, BUSES = quadrille_pkg::CONTEXT_BUSES
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // Write: tile_walk's tile, tile_context's words
    input logic push_i,
    output logic full_o,  // no room for the entry
    output logic [RING-1:0] entry_o,  // that a push takes
    input logic end_i, homogeneous_i,
    input logic [quadrille_pkg::TILE_BITS-1:0] tile_i,
    input logic [quadrille_pkg::WORDS_BITS-1:0] words_i,
    // Read for coverage
    input logic fetch_i,
    input logic [RING:0] fetch_ptr_i,
    output logic stamp_present_o,
    output logic fetch_homogeneous_o,  // the entry at fetch_ptr_i
    output logic [quadrille_pkg::TAG_BITS-1:0] tag_o,
    input logic load_i,
    input logic [RING:0] load_ptr_i,
    output logic [5*VAL-1:0] stamp_lin_value_o,
    // Tail
    input logic [RING:0] stamp_ptr_i,
    input logic stamps_empty_i, head_valid_i,
    input logic [RING:0] head_ptr_i,
    // Read for emission
    input logic emit_valid_i,
    input logic [RING:0] emit_ptr_i,
    input logic [1:0] emit_part_i,
    output logic [SLOT-1:0] tag_slot_o,  // a clock after the pointer
    output logic [quadrille_pkg::CONTEXT_BITS-1:0] context_o  // two clocks after it
);
  `QUADRILLE_IN(`QUADRILLE_TILE_T, tile)
  `QUADRILLE_IN(`QUADRILLE_WORDS_T, words)
  logic [quadrille_pkg::QUAD_SLOTS_LOG2-1:0] emit_slot;
  logic [quadrille_pkg::TC_BITS-1:0] emit_tile_x, emit_tile_y;
  logic [6*quadrille_pkg::VAL_BITS-1:0] emit_lin_value;
  logic [4*quadrille_pkg::QVAL_BITS-1:0] emit_quad_value;
  logic [4*quadrille_pkg::QGRAD_BITS-1:0] emit_quad_gx, emit_quad_gy;
  logic [4*quadrille_pkg::QCURV_BITS-1:0] emit_quad_q;
  localparam int ENTRIES = 1 << RING;
  assign context_o = {emit_slot, emit_tile_x, emit_tile_y, emit_lin_value, emit_quad_value, emit_quad_gx, emit_quad_gy,
      emit_quad_q};

  localparam logic [RING:0] PARTS = (RING + 1)'(quadrille_pkg::HOMOGENEOUS_PARTS), ALL = (RING + 1)'(ENTRIES);
  localparam logic [RING:0] TWICE = (ALL < 2 * PARTS) ? '0 : ALL - 2 * PARTS + 1;  // from so many on, no room for both

  logic [RING:0] write_q, complete_q, tail_q;  // next entry to write, first one that is not complete, first one in use
  logic [RING:0] tail_next, used, complete_next;  // used: in the next clock, without this one's push
  logic in_parts, full_q, full_parts_q;  // the entry that comes takes PARTS; no room for one, for PARTS, a clock ahead
  logic [RING-1:0] write_index, fetch_index, load_index, tag_index, emit_index_q, word_index_q;
  assign tail_next = head_valid_i ? head_ptr_i : stamps_empty_i ? stamp_ptr_i : tail_q;
  assign used = write_q - tail_next;
  assign complete_next = complete_q + (words.complete_homogeneous ? PARTS : (RING + 1)'(1));
  assign in_parts = homogeneous_i && !end_i;
  assign full_o = in_parts ? full_parts_q : full_q;
  assign stamp_present_o = fetch_ptr_i != complete_q;
  assign write_index = write_q[RING-1:0];
  assign entry_o = write_index;
  assign fetch_index = fetch_ptr_i[RING-1:0];
  assign load_index = load_ptr_i[RING-1:0];
  assign tag_index = emit_ptr_i[RING-1:0];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      write_q <= '0;
      complete_q <= '0;
      tail_q <= '0;
      {full_q, full_parts_q} <= '0;
    end else begin
      if (push_i) write_q <= write_q + (in_parts ? PARTS : (RING + 1)'(1));
      if (words.complete) complete_q <= complete_next;
      tail_q <= tail_next;
      full_q <= push_i ? used >= (in_parts ? ALL - PARTS : ALL - 1) : used >= ALL;
      full_parts_q <= push_i ? used >= (in_parts ? TWICE : ALL - PARTS) : used > ALL - PARTS;
    end
  end

  always_ff @(posedge clk_i) begin
    emit_index_q <= tag_index;
    word_index_q <= (emit_part_i == quadrille_pkg::PART_SQUARES) ? tag_index : tag_index + RING'(emit_part_i);
  end

  // Coverage's tag is {end, homogeneous, slot, x, y, last row}; emission's the slot and place alone.
  localparam int PLACED = SLOT + 2 * TC, TAG = quadrille_pkg::TAG_BITS;
  logic [ENTRIES-1:0] homogeneous_q;  // known before the tag is read
  logic [2*TC-1:0] tag_tile_q;
  assign fetch_homogeneous_o = homogeneous_q[fetch_index];

  always_ff @(posedge clk_i) begin
    if (push_i) homogeneous_q[write_index] <= in_parts;
    {emit_slot, emit_tile_x, emit_tile_y} <= {tag_slot_o, tag_tile_q};
  end

  quadrille_memory #(.WIDTH(TAG), .DEPTH(ENTRIES)) u_tag (
      .clk_i, .write_i(push_i), .write_place_i(write_index),
      .write_data_i({end_i, in_parts, tile.slot, tile.tile_x, tile.tile_y, tile.last_row}), .read_i(fetch_i),
      .read_place_i(fetch_index), .clear_i(1'b0), .data_o(tag_o)
  );

  quadrille_memory #(.WIDTH(PLACED), .DEPTH(ENTRIES)) u_emit_tag (
      .clk_i, .write_i(push_i), .write_place_i(write_index), .write_data_i({tile.slot, tile.tile_x, tile.tile_y}),
      .read_i(1'b1), .read_place_i(tag_index), .clear_i(1'b0), .data_o({tag_slot_o, tag_tile_q})
  );

  quadrille_memory #(.WIDTH(5 * VAL), .DEPTH(ENTRIES)) u_value (
      .clk_i, .write_i(push_i), .write_place_i(write_index), .write_data_i(tile.lin_value[5*VAL-1:0]), .read_i(load_i),
      .read_place_i(load_index), .clear_i(1'b0), .data_o(stamp_lin_value_o)
  );

  quadrille_memory #(.WIDTH(6 * VAL), .DEPTH(ENTRIES)) u_emit_value (
      .clk_i, .write_i(push_i), .write_place_i(write_index), .write_data_i(tile.lin_value), .read_i(1'b1),
      .read_place_i(emit_index_q), .clear_i(1'b0), .data_o(emit_lin_value)
  );

  for (genvar g = 0; g < 4; g++) begin : gen_quadratic
    quadrille_memory #(.WIDTH(QVAL), .DEPTH(ENTRIES)) u_value (
        .clk_i, .write_i(words.value_write[g]), .write_place_i(words.value_entry),
        .write_data_i(words.value[(g%BUSES)*QVAL+:QVAL]), .read_i(1'b1), .read_place_i(word_index_q), .clear_i(1'b0),
        .data_o(emit_quad_value[g*QVAL+:QVAL])
    );

    quadrille_memory #(.WIDTH(2 * QGRAD), .DEPTH(ENTRIES)) u_gradient (
        .clk_i, .write_i(words.gradient_write[g]), .write_place_i(words.gradient_entry),
        .write_data_i({words.gx[(g%BUSES)*QGRAD+:QGRAD], words.gy[(g%BUSES)*QGRAD+:QGRAD]}), .read_i(1'b1),
        .read_place_i(word_index_q), .clear_i(1'b0),
        .data_o({emit_quad_gx[g*QGRAD+:QGRAD], emit_quad_gy[g*QGRAD+:QGRAD]})
    );

    quadrille_memory #(.WIDTH(QCURV), .DEPTH(ENTRIES)) u_q (
        .clk_i, .write_i(words.q_write[g]), .write_place_i(words.q_entry),
        .write_data_i(words.q[(g%PAIRS)*QCURV+:QCURV]), .read_i(1'b1), .read_place_i(word_index_q), .clear_i(1'b0),
        .data_o(emit_quad_q[g*QCURV+:QCURV])
    );
  end

  // The pointer's upper bit is for the tail alone.
  logic unused;
  assign unused = ^{fetch_ptr_i[RING], load_ptr_i[RING], emit_ptr_i[RING]};

`ifndef SYNTHESIS
  logic value_valid_q;
  logic [RING:0] value_ptr_q;  // of the entry whose values emission reads

  always_ff @(posedge clk_i) begin
    value_valid_q <= rst_ni && emit_valid_i;
    value_ptr_q <= emit_ptr_i;
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_push_has_room, !push_i || !full_o, "a tile pushed finds an entry")
      `QUADRILLE_ASSERT(assert_used_range, used <= ALL, "no more entries are used than there are")
      `QUADRILLE_ASSERT(assert_value_alive,
          !value_valid_q || (RING + 1)'(write_q - value_ptr_q) <= ALL,
          "an entry read is not written over yet")
    end
  end
`endif
endmodule
