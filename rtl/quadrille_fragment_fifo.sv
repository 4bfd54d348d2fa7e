// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
// Where the pixel pipeline, which never waits, meets the fragment port, which may: 2^DEPTH_LOG2 words in memory, the
// head in a register.
//
// A word is what leaves the pipeline in a clock: the fragments of its lanes, and which lanes have one (at least one
// has). Not full by credit: pixel_emit sends pixels only when a place for their fragments is free, so that a push
// always finds room (asserted). The port: valid does not depend on ready, the word is stable while valid and not ready,
// and zero while not valid. freed_o, a register, is the hand-over of the clock before.
module quadrille_fragment_fifo #(
    parameter int LANES = quadrille_pkg::PIXELS_PER_CLOCK,
    parameter int WIDTH = LANES * quadrille_pkg::FRAGMENT_BITS,
    parameter int DEPTH_LOG2 = quadrille_pkg::FRAGMENT_FIFO_LOG2
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic [LANES-1:0] push_i,  // the lanes that have a fragment
    input logic [WIDTH-1:0] data_i,
    output logic busy_o,  // holds a word
    output logic freed_o, valid_o,
    input logic ready_i,
    output logic [LANES-1:0] mask_o,
    output logic [WIDTH-1:0] data_o
);
  localparam int DEPTH = 1 << DEPTH_LOG2;

  logic [DEPTH_LOG2-1:0] write_q, read_q;
  logic [DEPTH_LOG2:0] count_q;  // of words in memory
  logic some_q;  // count_q is not 0
  logic push, load, free;
  assign push = push_i != '0;
  assign free = !valid_o || ready_i;
  assign load = some_q && free;
  assign busy_o = some_q || valid_o;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      write_q <= '0;
      read_q <= '0;
      count_q <= '0;
      some_q <= 1'b0;
      valid_o <= 1'b0;
      freed_o <= 1'b0;
    end else begin
      if (push) write_q <= write_q + DEPTH_LOG2'(1);
      if (load) read_q <= read_q + DEPTH_LOG2'(1);
      count_q <= count_q + (DEPTH_LOG2 + 1)'(push) - (DEPTH_LOG2 + 1)'(load);
      some_q <= push || count_q > (DEPTH_LOG2 + 1)'(load);
      freed_o <= valid_o && ready_i;
      if (free) valid_o <= some_q;
    end
  end

  quadrille_memory #(.WIDTH(LANES + WIDTH), .DEPTH(DEPTH)) u_word (
      .clk_i, .write_i(push), .write_place_i(write_q), .write_data_i({push_i, data_i}), .read_i(free),
      .read_place_i(read_q), .clear_i(!rst_ni || (free && !some_q)), .data_o({mask_o, data_o})
  );

`ifndef SYNTHESIS
  // No overflow; valid held and payload stable under stall; zero while not valid.
  logic held_q;
  logic [LANES+WIDTH-1:0] last_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= 1'b0;
    end else begin
      held_q <= valid_o && !ready_i;
      last_q <= {mask_o, data_o};
      `QUADRILLE_ASSERT(assert_push_has_room,
          !push || count_q + (DEPTH_LOG2 + 1)'(valid_o) < (DEPTH_LOG2 + 1)'(DEPTH),
          "a pixel pushed finds a place")
      `QUADRILLE_ASSERT(assert_some_is_count, some_q == (count_q != '0), "some_q says whether words are stored")
      `QUADRILLE_ASSERT(assert_payload_held,
          !held_q || (valid_o && {mask_o, data_o} == last_q),
          "valid and payload stay until they are taken")
      `QUADRILLE_ASSERT(assert_zero_when_idle, valid_o || data_o == '0, "payload is zero without valid")
      `QUADRILLE_ASSERT(assert_valid_has_lane, valid_o == (mask_o != '0), "valid comes with a lane")
    end
  end
`endif
endmodule
