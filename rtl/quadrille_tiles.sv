// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// From quads to pixels' positions: the walk over a quad's tiles, their quadratic functions, coverage, emission; and
// what hides a tile.
module quadrille_tiles #(
    localparam int VAL = quadrille_pkg::VAL_BITS, SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int RING = quadrille_pkg::RING_LOG2, TILE = quadrille_pkg::TILE
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic clear_hidden_i,  // never while the machine is busy
    output logic depths_ready_o,  // no places of hidden tiles are being wiped
    // A quad starts, in this slot
    input logic start_i,
    input logic [SLOT-1:0] start_slot_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    input logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits_i,
    // and is set up
    input logic setup_valid_i,
    output logic take_o,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // Multipliers of the front
    output logic jobs_valid_o,
    output logic [quadrille_pkg::JOBS_BITS-1:0] jobs_o,
    input logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_i,
    // Gradients: edges_i a clock after stamp_load_o
    output logic stamp_load_o,
    output logic [SLOT-1:0] stamp_slot_o,
    input logic [quadrille_pkg::EDGES_BITS-1:0] edges_i,
    // Pixels; a clock later their quad's slot, two clocks later their tile
    output logic [quadrille_pkg::PIXELS_BITS-1:0] pixels_o,
    output logic [SLOT-1:0] emit_slot_o,
    output logic [quadrille_pkg::CONTEXT_BITS-1:0] context_o,
    // Places of the fragment FIFO given back
    input logic freed_i, discard_i,
    output logic [quadrille_pkg::TILES_EVENTS_BITS-1:0] events_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  logic [5:0] walk_events;
  logic [3:0] coverage_events;
  logic head_waits;

  // ---- Walk --------------------------------------------------------------------------------------------------------
  logic ring_full, context_ready, tile_push, tile_end, tile_homogeneous, tile_hidden, block_hidden;
  logic [quadrille_pkg::TILE_BITS-1:0] tile;
  logic [quadrille_pkg::TEST_BITS-1:0] test;
  quadrille_tile_walk u_walk (
      .clk_i, .rst_ni, .state_i, .setup_valid_i, .take_o, .setup_i, .ready_i(context_ready && !ring_full),
      .push_o(tile_push), .end_o(tile_end), .tile_o(tile), .test_o(test), .hidden_i(tile_hidden),
      .block_hidden_i(block_hidden), .events_o(walk_events)
  );

  // ---- Tiles: quadratic functions, and the ring --------------------------------------------------------------------
  logic [RING-1:0] tile_entry;
  logic [quadrille_pkg::WORDS_BITS-1:0] words;
  logic [RING:0] fetch_ptr, load_ptr, emit_ptr;
  logic fetch, fetch_homogeneous, stamp_present, stamps_empty, head_valid, pop, stamp_push;
  logic [5*VAL-1:0] stamp_lin_value;
  logic [quadrille_pkg::TAG_BITS-1:0] tag_i;
  logic [quadrille_pkg::STAMP_BITS-1:0] stamp_i, head_i;
  `QUADRILLE_IN(`QUADRILLE_TAG_T, tag)
  `QUADRILLE_IN(`QUADRILLE_STAMP_T, stamp)
  `QUADRILLE_IN(`QUADRILLE_STAMP_T, head)
  logic [quadrille_pkg::PIXELS_BITS-1:0] pixels_i;
  `QUADRILLE_IN(`QUADRILLE_PIXELS_T, pixels)

  assign stamp_slot_o = tag.slot;
  assign pixels_o = pixels_i;

  quadrille_tile_context u_context (
      .clk_i, .rst_ni, .take_i(take_o), .setup_i, .homogeneous_o(tile_homogeneous), .push_i(tile_push),
      .ready_o(context_ready), .end_i(tile_end), .tile_i(tile), .entry_i(tile_entry), .job_valid_o(jobs_valid_o),
      .jobs_o, .products_i, .words_o(words)
  );

  quadrille_tile_ring u_ring (
      .clk_i, .rst_ni, .push_i(tile_push), .full_o(ring_full), .entry_o(tile_entry), .end_i(tile_end),
      .homogeneous_i(tile_homogeneous), .tile_i(tile), .words_i(words), .fetch_i(fetch), .fetch_ptr_i(fetch_ptr),
      .stamp_present_o(stamp_present), .fetch_homogeneous_o(fetch_homogeneous), .tag_o(tag_i), .load_i(stamp_load_o),
      .load_ptr_i(load_ptr), .stamp_lin_value_o(stamp_lin_value), .stamp_ptr_i(stamp.tile_ptr),
      .stamps_empty_i(stamps_empty), .head_valid_i(head_valid), .head_ptr_i(head.tile_ptr),
      .emit_valid_i(pixels.valid != '0), .emit_ptr_i(emit_ptr), .emit_part_i(pixels.part), .tag_slot_o(emit_slot_o),
      .context_o
  );

  // ---- Coverage, what it leaves out, its FIFO, emission ------------------------------------------------------------
  logic [quadrille_pkg::ROWS_BITS-1:0] rows;
  logic coverage_wait, tile_masked;
  logic [TILE-1:0] row_seen;
  quadrille_stamp_coverage u_coverage (
      .clk_i, .rst_ni, .state_i, .present_i(stamp_present), .fetch_o(fetch), .fetch_ptr_o(fetch_ptr),
      .fetch_homogeneous_i(fetch_homogeneous), .tag_i, .load_o(stamp_load_o), .load_ptr_o(load_ptr),
      .lin_value_i(stamp_lin_value), .edges_i, .rows_o(rows), .wait_i(coverage_wait), .hidden_i(tile_masked),
      .seen_i(row_seen), .freed_i(pop), .push_o(stamp_push), .stamp_o(stamp_i), .events_o(coverage_events)
  );

  quadrille_hidden_tiles u_hidden (
      .clk_i, .rst_ni, .clear_i(clear_hidden_i), .ready_o(depths_ready_o), .on_i(state.depth && state.skip[2]),
      .state_i, .start_i, .start_slot_i, .quad_i, .limits_i, .take_i(take_o), .setup_i, .test_i(test),
      .hidden_o(tile_hidden), .block_hidden_o(block_hidden), .tile_i(tag_i), .rows_i(rows), .wait_o(coverage_wait),
      .masked_o(tile_masked), .seen_o(row_seen)
  );

  quadrille_sync_fifo #(.WIDTH(quadrille_pkg::STAMP_BITS), .DEPTH(quadrille_pkg::STAMP_PLACES)) u_fifo (
      .clk_i, .rst_ni, .push_i(stamp_push), .data_i(stamp_i), .pop_i(pop), .empty_o(stamps_empty), .valid_o(head_valid),
      .data_o(head_i)
  );

  quadrille_pixel_emit u_emit (
      .clk_i, .rst_ni, .head_valid_i(head_valid), .head_i, .pop_o(pop), .freed_i, .discard_i, .ptr_o(emit_ptr),
      .pixels_o(pixels_i), .event_o(head_waits)
  );

  assign events_o = {jobs_valid_o, walk_events, tile_push && !tile_end, coverage_events,
      stamp_push && !stamp.end_token, head_valid, head_waits, !depths_ready_o};
endmodule
