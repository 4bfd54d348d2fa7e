// Suite `setup`: four vertices and the scissor rectangle in, the `setup` boundary out. One quad at a time, as long as quad_setup takes.
module replay_setup (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2;

  // What follows from the gradients is not of the boundary: the walk and the coverage show it.
  logic [4:0] tie_pos_o, tie_neg_o;
  logic [5*quadrille_pkg::REACH_BITS-1:0] fall_tile_o, rise_tile_o, fall_block_o, rise_block_o;

  quad_setup u_setup (
      .start_i(valid_i && ready_o),
      .slot_i(SLOT'(0)),
      .idle_o(ready_o),
      .take_i(valid_o),
      .done_o(valid_o),
      .*
  );
endmodule
