// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// From pixels' positions to fragments: what the quads' slots have for it, the pipeline, the fragment FIFO.
module quadrille_pixel #(
    localparam int P = quadrille_pkg::PIXELS_PER_CLOCK, GRAD = quadrille_pkg::GRAD_BITS,
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2, PIXELS = quadrille_pkg::PIXELS_BITS,
    localparam int FB = quadrille_pkg::FRAGMENT_BITS
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // A quad is to start, in this slot
    input logic offer_i,
    input logic [SLOT-1:0] start_slot_i,
    input logic plane_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    input logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits_i,
    // and is set up
    input logic take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // Pixels; two clocks later their tile and their quad's gradients
    input logic [PIXELS-1:0] pixels_i,
    input logic [quadrille_pkg::CONTEXT_BITS-1:0] tile_i,
    input logic [6*GRAD-1:0] gx_i, gy_i,
    // Places of the fragment FIFO given back, and slots
    output logic freed_o, discard_o, release_o,
    output logic [SLOT-1:0] release_slot_o,
    // Fragments
    output logic [P*FB-1:0] fragment_o,
    output logic [P-1:0] fragment_mask_o,
    output logic fragment_valid_o,
    input logic fragment_ready_i,
    output logic busy_o,
    output logic [quadrille_pkg::PIXEL_EVENTS_BITS-1:0] events_o
);
  logic [quadrille_pkg::READS_BITS-1:0] reads;
  logic [quadrille_pkg::TERMS_BITS-1:0] terms;
  logic [P*quadrille_pkg::LATENCY-1:0] lane_valid;
  logic [P-1:0] drawn, count_norm, count_area;
  logic [P*FB-1:0] fragment;
  logic norm_plane;
  logic [quadrille_pkg::ATTRIBUTE_SLOTS+2:0] sum_active;

  // Pixels wait for what ring and gradients have of their tile and quad.
  logic [2*PIXELS-1:0] pixels_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) pixels_q <= '0;
    else pixels_q <= {pixels_q[PIXELS-1:0], pixels_i};
  end

  quadrille_vertex_bank u_bank (
      .clk_i, .state_i, .offer_i, .start_slot_i, .plane_i, .quad_i, .limits_i, .take_i, .setup_i, .reads_i(reads),
      .terms_o(terms), .norm_plane_o(norm_plane), .sum_active_o(sum_active)
  );

  quadrille_pixel_pipeline u_pipeline (
      .clk_i, .rst_ni, .state_i, .pixels_i(pixels_q[2*PIXELS-1:PIXELS]), .tile_i, .lin_gx_i(gx_i), .lin_gy_i(gy_i),
      .reads_o(reads), .terms_i(terms), .release_o, .release_slot_o, .discard_o, .lane_valid_o(lane_valid),
      .count_norm_o(count_norm), .count_area_o(count_area), .fragment_valid_o(drawn), .fragment_o(fragment)
  );

  quadrille_fragment_fifo u_fragments (
      .clk_i, .rst_ni, .push_i(drawn), .data_i(fragment), .busy_o, .freed_o, .valid_o(fragment_valid_o),
      .ready_i(fragment_ready_i), .mask_o(fragment_mask_o), .data_o(fragment_o)
  );

  assign events_o = {lane_valid, drawn, count_norm, count_area, norm_plane, sum_active};

`ifndef SYNTHESIS
  localparam int LATENCY = quadrille_pkg::LATENCY;
  // a read goes with the pixel in this register
  localparam int LENGTH2_READ = quadrille_pkg::FORWARD_DIFFERENCE_STAGES - 2;
  localparam int BLEND_READ = quadrille_pkg::WEIGHT_STAGE - 2, BASE_READ = LATENCY - 6;
  /* verilator lint_off UNUSEDSIGNAL */
  `QUADRILLE_SETUP_T setup;
  `QUADRILLE_READS_T read;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [LATENCY-1:0] pixel_at;  // some lane has a pixel in the register
  assign setup = setup_i;
  assign read = reads;

  always_comb begin
    pixel_at = '0;
    for (int g = 0; g < P; g++) pixel_at |= lane_valid[g*LATENCY+:LATENCY];
  end

  // no_rw_check in vertex_bank: what a pixel reads is not written in that clock.
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_blend_race,
          !offer_i || !pixel_at[BLEND_READ] || read.blend != start_slot_i,
          "blend operands are not read in the clock of their write")
      `QUADRILLE_ASSERT(assert_base_race,
          !offer_i || !pixel_at[BASE_READ] || read.base != start_slot_i,
          "bases are not read in the clock of their write")
      `QUADRILLE_ASSERT(assert_length2_race,
          !take_i || !pixel_at[LENGTH2_READ] || read.length2 != setup.slot,
          "lengths are not read in the clock of their write")
    end
  end
`endif
endmodule
