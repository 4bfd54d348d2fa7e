// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// What coverage and emission need to know of a quad, by slot: written when the walk takes the quad, read until it
// leaves the pipeline. Reads end in registers. Not reset.
module quadrille_gradient_bank #(
    localparam int GRAD = quadrille_pkg::GRAD_BITS, SLOT = quadrille_pkg::QUAD_SLOTS_LOG2
) (
    input logic clk_i, take_i,
    input logic [quadrille_pkg::SETUP_BITS-1:0] setup_i,
    // Read for coverage: there a clock after stamp_load_i, until the next
    input logic stamp_load_i,
    input logic [SLOT-1:0] stamp_slot_i,
    output logic [quadrille_pkg::EDGES_BITS-1:0] edges_o,
    // Read for emission: there a clock after the slot
    input logic [SLOT-1:0] emit_slot_i,
    output logic [6*GRAD-1:0] emit_gx_o, emit_gy_o
);
  localparam int SLOTS = 1 << SLOT;
  `QUADRILLE_IN(`QUADRILLE_SETUP_T, setup)
  logic [quadrille_pkg::EDGES_BITS-1:0] edges;
  assign edges = {setup.lin_gx[5*GRAD-1:0], setup.lin_gy[5*GRAD-1:0], setup.tie_pos, setup.tie_neg, setup.visible};

  quadrille_memory #(.WIDTH(quadrille_pkg::EDGES_BITS), .DEPTH(SLOTS)) u_edges (
      .clk_i, .write_i(take_i), .write_place_i(setup.slot), .write_data_i(edges), .read_i(stamp_load_i),
      .read_place_i(stamp_slot_i), .clear_i(1'b0), .data_o(edges_o)
  );

  quadrille_memory #(.WIDTH(12 * GRAD), .DEPTH(SLOTS)) u_gradients (
      .clk_i, .write_i(take_i), .write_place_i(setup.slot), .write_data_i({setup.lin_gx, setup.lin_gy}), .read_i(1'b1),
      .read_place_i(emit_slot_i), .clear_i(1'b0), .data_o({emit_gx_o, emit_gy_o})
  );
endmodule
