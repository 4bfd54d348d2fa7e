// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// Option hierarchical_z_bits: what of a quad nothing can be seen of, by bounds of the depths in the depth buffer. Tiles
// and blocks for the walk (hierarchical_z), pixels for coverage (masked_depth). At 0 nothing is hidden.
module quadrille_hidden_tiles #(
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2, H = quadrille_pkg::DEPTH_CODE_BITS,
    localparam int TILE = quadrille_pkg::TILE
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic clear_i,  // never while the machine is busy
    output logic ready_o,  // places are not being wiped
    input logic on_i,
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    // Quad
    input logic start_i,
    input logic [SLOT-1:0] start_slot_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    input logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits_i,
    input logic take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // Walk
    input logic [quadrille_pkg::TEST_BITS-1:0] test_i,
    output logic hidden_o, block_hidden_o,
    // Coverage
    input logic [quadrille_pkg::TAG_BITS-1:0] tile_i,
    input logic [quadrille_pkg::ROWS_BITS-1:0] rows_i,
    output logic wait_o, masked_o,
    output logic [TILE-1:0] seen_o
);
  if (quadrille_pkg::HIERARCHICAL_Z_BITS != 0) begin : gen_hidden
    `QUADRILLE_IN(`QUADRILLE_QUAD_T, quad)
    logic [quadrille_pkg::HIERARCHICAL_Z_TILES_LOG2-1:0] wipe_place;
    logic [quadrille_pkg::HIDDEN_EPOCH_BITS-1:0] epoch;
    logic [H-1:0] near, far;
    logic lowers;
    quadrille_depth_interval u_interval (
        .clk_i, .low_i(quad.depth_low), .high_i(quad.depth_high), .limits_i, .ordinary_i(quad.ordinary), .near_o(near),
        .far_o(far), .lowers_o(lowers)
    );

    quadrille_hierarchical_z u_hierarchical (
        .clk_i, .rst_ni, .clear_i, .ready_o, .wipe_place_o(wipe_place), .epoch_o(epoch), .state_i, .on_i, .start_i,
        .start_slot_i, .near_i(near), .far_i(far), .lowers_i(lowers), .take_i, .setup_i, .test_i, .hidden_o,
        .block_hidden_o
    );

    quadrille_masked_depth u_masked (
        .clk_i, .rst_ni, .wipe_i(!ready_o), .wipe_place_i(wipe_place), .epoch_i(epoch), .on_i, .start_i, .start_slot_i,
        .near_i(near), .far_i(far), .lowers_i(lowers), .tile_i, .wait_o, .rows_i, .hidden_o(masked_o), .seen_o
    );
  end else begin : gen_nothing_hidden
    logic unused;
    assign unused = ^{clk_i, rst_ni, clear_i, on_i, state_i, start_i, start_slot_i, quad_i, limits_i, take_i, setup_i,
        test_i, tile_i, rows_i};
    assign {hidden_o, block_hidden_o, wait_o, masked_o} = '0;
    assign ready_o = 1'b1;
    assign seen_o = '1;
  end
endmodule
