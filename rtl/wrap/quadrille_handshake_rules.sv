// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
// Assertions of a valid/ready channel, for AXI4-Stream and each channel of AXI4-Lite: valid is low after reset, then
// stays, with its payload, until ready. Nothing in synthesis.
module quadrille_handshake_rules #(
    parameter int WIDTH = 1
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic valid_i, ready_i,
    input logic [WIDTH-1:0] payload_i
);
`ifdef SYNTHESIS
  logic unused;
  assign unused = ^{clk_i, rst_ni, valid_i, ready_i, payload_i};
`else
  logic reset_q, held_q;
  logic [WIDTH-1:0] payload_q;

  always_ff @(posedge clk_i) begin
    reset_q <= !rst_ni;
    held_q <= rst_ni && valid_i && !ready_i;
    payload_q <= payload_i;
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_low_after_reset, !reset_q || !valid_i, "valid is low in the first clock after reset")
      `QUADRILLE_ASSERT(assert_valid_held, !held_q || valid_i, "valid stays until ready")
      `QUADRILLE_ASSERT(assert_payload_held, !held_q || payload_i == payload_q, "the payload stays until ready")
    end
  end
`endif
endmodule
