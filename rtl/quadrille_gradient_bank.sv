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
  logic [5*GRAD-1:0] stamp_gx, stamp_gy;
  logic [4:0] stamp_tie_pos, stamp_tie_neg;
  logic [3:0] stamp_visible;
  logic [13:0] stamp_q[0:SLOTS-1];
  assign edges_o = {stamp_gx, stamp_gy, stamp_tie_pos, stamp_tie_neg, stamp_visible};

  for (genvar g = 0; g < 6; g++) begin : gen_linear
    logic [GRAD-1:0] gx_q[0:SLOTS-1];
    logic [GRAD-1:0] gy_q[0:SLOTS-1];

    always_ff @(posedge clk_i) begin
      if (take_i) begin
        gx_q[setup.slot] <= setup.lin_gx[g*GRAD+:GRAD];
        gy_q[setup.slot] <= setup.lin_gy[g*GRAD+:GRAD];
      end
      emit_gx_o[g*GRAD+:GRAD] <= gx_q[emit_slot_i];
      emit_gy_o[g*GRAD+:GRAD] <= gy_q[emit_slot_i];
    end

    if (g < 5) begin : gen_stamp
      always_ff @(posedge clk_i) begin
        if (stamp_load_i) begin
          stamp_gx[g*GRAD+:GRAD] <= gx_q[stamp_slot_i];
          stamp_gy[g*GRAD+:GRAD] <= gy_q[stamp_slot_i];
        end
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (take_i) stamp_q[setup.slot] <= {setup.tie_pos, setup.tie_neg, setup.visible};
    if (stamp_load_i) {stamp_tie_pos, stamp_tie_neg, stamp_visible} <= stamp_q[stamp_slot_i];
  end
endmodule
