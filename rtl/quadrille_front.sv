// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// From vertices to quads that are set up: assembly, setup, the multipliers that it shares with tile_context, the quads'
// slots and their gradients. A quad waits for setup in a register of its own, so that the next one's vertices come
// meanwhile and vertex_ready_o does not depend on setup in the same clock.
module quadrille_front #(
    localparam int GRAD = quadrille_pkg::GRAD_BITS, SLOT = quadrille_pkg::QUAD_SLOTS_LOG2,
    localparam int PAIRS = quadrille_pkg::PRODUCT_PAIRS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic flush_i,
    input logic [quadrille_pkg::VERTEX_BITS-1:0] vertex_i,
    input logic vertex_valid_i,
    output logic vertex_ready_o, assembly_busy_o, slots_busy_o,
    // A quad starts, in this slot. From when that is free it is offered, in each clock, so that start reaches no memory
    output logic start_o, offer_o,
    output logic [SLOT-1:0] start_slot_o,
    output logic plane_o,  // any weights that reproduce linear functions give its values
    output logic [quadrille_pkg::QUAD_BITS-1:0] quad_o,
    output logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits_o,
    // and is set up
    output logic setup_valid_o,
    input logic take_i,
    output logic [quadrille_pkg::SETUP_BITS-1:0] setup_o,
    // Jobs of tile_context
    input logic jobs_valid_i,
    input logic [quadrille_pkg::JOBS_BITS-1:0] jobs_i,
    output logic [quadrille_pkg::PRODUCTS_BITS-1:0] products_o,
    // Gradients of the quad in a slot, for coverage and emission
    input logic stamp_load_i,
    input logic [SLOT-1:0] stamp_slot_i,
    output logic [quadrille_pkg::EDGES_BITS-1:0] edges_o,
    input logic [SLOT-1:0] emit_slot_i,
    output logic [6*GRAD-1:0] emit_gx_o, emit_gy_o,
    // A quad has left the pipeline
    input logic release_i,
    input logic [SLOT-1:0] release_slot_i,
    output logic [quadrille_pkg::FRONT_EVENTS_BITS-1:0] events_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  logic full, empty, behind, outside_depth, drop_vertices, setup_ready, slot_available, drop, setup_jobs_valid;
  logic assembling, move, waits_q, empty_q;  // quad_o, limits_o, empty_q are of a quad that waits
  logic [quadrille_pkg::QUAD_BITS-1:0] quad;
  logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits;
  logic [SLOT-1:0] drop_slot;
  logic [quadrille_pkg::JOBS_BITS-1:0] setup_jobs;
  logic [PAIRS*(quadrille_pkg::VAL_BITS+2*GRAD)-1:0] edges;
  logic [2:0] setup_events;
  assign drop_vertices = full && state.skip[1] && (empty || behind || outside_depth);
  assign move = full && !drop_vertices && !waits_q;
  assign offer_o = waits_q && slot_available;
  assign start_o = offer_o && setup_ready;
  assign assembly_busy_o = assembling || waits_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) waits_q <= 1'b0;
    else waits_q <= move || (waits_q && !start_o);
    if (move) {quad_o, limits_o, empty_q} <= {quad, limits, empty};
  end

  quadrille_vertex_assembly u_assembly (
      .clk_i, .rst_ni, .state_i, .vertex_i, .vertex_valid_i, .vertex_ready_o, .flush_i,
      .leave_i(move || drop_vertices), .full_o(full), .busy_o(assembling), .empty_o(empty), .behind_o(behind),
      .depth_o(outside_depth), .limits_o(limits), .quad_o(quad)
  );

  quadrille_plane_quad u_plane (.clk_i, .state_i, .quad_i(quad_o), .plane_o);

  quadrille_quad_setup u_setup (
      .clk_i, .rst_ni, .state_i, .held_i(waits_q), .start_i(start_o), .ready_o(setup_ready),
      .empty_i(empty_q), .slot_i(start_slot_o), .quad_i(quad_o), .wait_i(jobs_valid_i),
      .jobs_valid_o(setup_jobs_valid), .jobs_o(setup_jobs), .edges_o(edges), .products_i(products_o),
      .valid_o(setup_valid_o), .take_i, .setup_o, .drop_o(drop), .drop_slot_o(drop_slot), .events_o(setup_events)
  );

  quadrille_vertex_products u_products (
      .clk_i, .tile_valid_i(jobs_valid_i), .tile_i(jobs_i), .setup_valid_i(setup_jobs_valid),
      .setup_i(setup_jobs), .edges_i(edges), .products_o
  );

  quadrille_slot_allocation u_slots (
      .clk_i, .rst_ni, .start_i(start_o), .alloc_o(start_slot_o), .available_o(slot_available), .busy_o(slots_busy_o),
      .release_i, .release_slot_i, .drop_i(drop), .drop_slot_i(drop_slot)
  );

  quadrille_gradient_bank u_gradients (
      .clk_i, .take_i, .setup_i(setup_o), .stamp_load_i, .stamp_slot_i, .edges_o, .emit_slot_i, .emit_gx_o, .emit_gy_o
  );

  assign events_o = {start_o, plane_o, drop_vertices, empty, behind, drop, setup_events, waits_q && !start_o,
      setup_valid_o && !take_i, assembly_busy_o};
endmodule
