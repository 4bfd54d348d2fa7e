// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// Bounding box of a quad and its tiles, while the quad waits: clamped in the first clock, its tiles in
// the second. An empty one has zero tiles.
module quadrille_setup_box #(
    localparam int TC = quadrille_pkg::TC_BITS, TL = quadrille_pkg::TILE_LOG2
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic held_i, start_i,
    input logic empty_i,  // no pixel centre inside scissor and bounding box
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    output logic boxed_o,  // the outputs are there
    output logic [TC-1:0] x0_o,  // first tile
    output logic [TC-1:0] y0_o, columns_o, rows_o,
    output logic [TL-1:0] last_row_o  // last pixel row, in its tile
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_QUAD_T, quad)

  typedef enum logic [1:0] {NEW, CLAMPED, BOXED} box_state_t;
  box_state_t box_state_q;
  logic is_new;
  logic [TC-1:0] first_x, first_y, count_x, count_y;
  logic [TL-1:0] last_column, last_row;
  assign is_new = box_state_q == NEW;

  quadrille_bounding_range u_range_x (
      .clk_i, .load_i(is_new), .low_i(quad.low_x), .high_i(quad.high_x), .ordinary_i(quad.ordinary),
      .scissor0_i(state.scissor_x0), .scissor1_i(state.scissor_x1), .first_o(first_x), .count_o(count_x),
      .last_o(last_column)
  );

  quadrille_bounding_range u_range_y (
      .clk_i, .load_i(is_new), .low_i(quad.low_y), .high_i(quad.high_y), .ordinary_i(quad.ordinary),
      .scissor0_i(state.scissor_y0), .scissor1_i(state.scissor_y1), .first_o(first_y), .count_o(count_y),
      .last_o(last_row)
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni || start_i) box_state_q <= NEW;
    else if (box_state_q == NEW) box_state_q <= held_i ? CLAMPED : NEW;
    else box_state_q <= BOXED;
  end

  always_ff @(posedge clk_i) begin
    if (box_state_q == CLAMPED) begin
      x0_o <= empty_i ? '0 : first_x;
      y0_o <= empty_i ? '0 : first_y;
      columns_o <= empty_i ? '0 : count_x;
      rows_o <= empty_i ? '0 : count_y;
      last_row_o <= last_row;
    end
  end

  assign boxed_o = box_state_q == BOXED;

  logic unused;
  assign unused = ^last_column;
endmodule
