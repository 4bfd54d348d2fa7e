// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
// Which quad slot the next quad gets, one after the other. A slot is in use from start until its quad leaves the
// pipeline, or setup drops it: those of dropped quads are free earlier than older ones, so that the next one may be in
// use.
module quadrille_slot_allocation #(
    localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic start_i,
    output logic [SLOT-1:0] alloc_o,
    output logic available_o, busy_o,
    input logic release_i,
    input logic [SLOT-1:0] release_slot_i,
    input logic drop_i,
    input logic [SLOT-1:0] drop_slot_i
);
  localparam int SLOTS = 1 << SLOT;
  logic [SLOT-1:0] alloc_q;
  logic [SLOTS-1:0] in_use_q;
  assign alloc_o = alloc_q;
  assign available_o = !in_use_q[alloc_q];
  assign busy_o = in_use_q != '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      alloc_q <= '0;
      in_use_q <= '0;
    end else begin
      alloc_q <= alloc_q + SLOT'(start_i || (in_use_q[alloc_q] && in_use_q != '1));
      if (release_i) in_use_q[release_slot_i] <= 1'b0;
      if (drop_i) in_use_q[drop_slot_i] <= 1'b0;
      if (start_i) in_use_q[alloc_q] <= 1'b1;
    end
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_start_has_slot, !start_i || available_o, "start comes with a free slot")
      `QUADRILLE_ASSERT(assert_release_in_use, !release_i || busy_o, "a slot released was in use")
    end
  end
`endif
endmodule
