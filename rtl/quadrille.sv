// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Quadrille: rasterizer whose primitive is the quadrilateral, with mean value coordinates. Top level: wiring only.
//
//     front: vertex_assembly -> quad_setup   tiles: tile_walk -> tile_ring -> stamp_coverage -> sync_fifo -> pixel_emit
//     pixel: pixel_pipeline -> fragment_fifo     multipliers: vertex_products (quad_setup, tile_context)
//
// Inside, a bundle goes over with its valid and the taker's take, or with a push that the taker's ready or room allows.
// Ports: README.md; number formats and clocks: SPEC.md. Both streams are valid/ready: valid never depends on ready,
// payload is stable while valid and not ready. state_i is static while quads are under way (asserted). The pixel
// pipeline never waits: pixel_emit counts the places of the fragment FIFO. clear_hidden_i goes with a clear of the
// depth buffer (hierarchical_z) and is ignored while busy_o. flush_i, in any clock, discards the beats of a quad that
// is not complete, that of the same clock among them, and nothing else.
module quadrille (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic clear_hidden_i,
    input logic flush_i,
    input logic [quadrille_pkg::VERTEX_BITS-1:0] vertex_i,
    input logic vertex_valid_i,
    output logic vertex_ready_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK*quadrille_pkg::FRAGMENT_BITS-1:0] fragment_o,
    output logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] fragment_mask_o,
    output logic fragment_valid_o,
    input logic fragment_ready_i,
    output logic busy_o,
    // A performance counter by its index; 0 without them
    input logic [quadrille_pkg::COUNTER_INDEX_BITS-1:0] counter_index_i,
    output logic [quadrille_pkg::COUNTER_BITS-1:0] counter_o
);
  localparam int GRAD = quadrille_pkg::GRAD_BITS;
  localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2, PIXELS = quadrille_pkg::PIXELS_BITS;
  quadrille_config_check u_config_check ();

  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  logic assembly_busy, slots_busy, fragments_busy, assembly_ready, depths_ready;
  logic [quadrille_pkg::FRONT_EVENTS_BITS-1:0] front_events;
  logic [quadrille_pkg::TILES_EVENTS_BITS-1:0] tiles_events;
  logic [quadrille_pkg::PIXEL_EVENTS_BITS-1:0] pixel_events;
  assign vertex_ready_o = assembly_ready && depths_ready;
  assign busy_o = assembly_busy || slots_busy || fragments_busy || !depths_ready;

  // ---- Quads -------------------------------------------------------------------------------------------------------
  logic start, offer, plane, setup_valid, take, jobs_valid, stamp_load, slot_release;
  logic [SLOT-1:0] start_slot, stamp_slot, emit_slot, release_slot;
  logic [quadrille_pkg::QUAD_BITS-1:0] quad;
  logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits;
  logic [quadrille_pkg::SETUP_BITS-1:0] setup_i;
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  logic [quadrille_pkg::JOBS_BITS-1:0] jobs;
  logic [quadrille_pkg::PRODUCTS_BITS-1:0] products;
  logic [quadrille_pkg::EDGES_BITS-1:0] edges;
  logic [6*GRAD-1:0] emit_gx, emit_gy;
  quadrille_front u_front (
      .clk_i, .rst_ni, .state_i, .flush_i, .vertex_i, .vertex_valid_i(vertex_valid_i && depths_ready),
      .vertex_ready_o(assembly_ready), .assembly_busy_o(assembly_busy), .slots_busy_o(slots_busy), .start_o(start),
      .offer_o(offer), .start_slot_o(start_slot), .plane_o(plane), .quad_o(quad), .limits_o(limits),
      .setup_valid_o(setup_valid), .take_i(take), .setup_o(setup_i), .jobs_valid_i(jobs_valid), .jobs_i(jobs),
      .products_o(products), .stamp_load_i(stamp_load), .stamp_slot_i(stamp_slot), .edges_o(edges),
      .emit_slot_i(emit_slot), .emit_gx_o(emit_gx), .emit_gy_o(emit_gy), .release_i(slot_release),
      .release_slot_i(release_slot), .events_o(front_events)
  );

  // ---- Tiles -------------------------------------------------------------------------------------------------------
  logic [PIXELS-1:0] pixels;
  logic [quadrille_pkg::CONTEXT_BITS-1:0] tile;
  logic freed, discard;
  quadrille_tiles u_tiles (
      .clk_i, .rst_ni, .state_i, .clear_hidden_i(clear_hidden_i && !busy_o), .depths_ready_o(depths_ready),
      .start_i(start), .start_slot_i(start_slot), .quad_i(quad), .limits_i(limits), .setup_valid_i(setup_valid),
      .take_o(take), .setup_i, .jobs_valid_o(jobs_valid), .jobs_o(jobs), .products_i(products),
      .stamp_load_o(stamp_load), .stamp_slot_o(stamp_slot), .edges_i(edges), .pixels_o(pixels), .emit_slot_o(emit_slot),
      .context_o(tile), .freed_i(freed), .discard_i(discard), .events_o(tiles_events)
  );

  // ---- Pixels ------------------------------------------------------------------------------------------------------
  quadrille_pixel u_pixel (
      .clk_i, .rst_ni, .state_i, .offer_i(offer), .start_slot_i(start_slot), .plane_i(plane), .quad_i(quad),
      .limits_i(limits), .take_i(take), .setup_i, .pixels_i(pixels), .tile_i(tile), .gx_i(emit_gx), .gy_i(emit_gy),
      .freed_o(freed), .discard_o(discard), .release_o(slot_release), .release_slot_o(release_slot), .fragment_o,
      .fragment_mask_o, .fragment_valid_o, .fragment_ready_i, .busy_o(fragments_busy), .events_o(pixel_events)
  );

  // ---- Performance counters ----------------------------------------------------------------------------------------
  quadrille_performance_counters u_counters (
      .clk_i, .rst_ni, .index_i(counter_index_i), .value_o(counter_o), .take_i(take), .homogeneous_i(setup.homogeneous),
      .busy_i(busy_o), .front_i(front_events), .tiles_i(tiles_events), .pixel_i(pixel_events)
  );

`ifndef SYNTHESIS
  logic [quadrille_pkg::STATE_BITS-1:0] state_q;

  always_ff @(posedge clk_i) begin
    state_q <= state_i;
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_state_static,
          !(assembly_busy || slots_busy || fragments_busy) || state_i == state_q,
          "the draw state is static while quads are under way")
    end
  end
`endif
endmodule
