// Suite `setup`: four vertices and the scissor rectangle in, the `setup` boundary out. One quad at a time, as long as quad_setup takes.
module replay_setup (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int SLOT = quadrille_pkg::QUAD_SLOTS_LOG2;

  quad_setup u_setup (
      .start_i(valid_i && ready_o),
      .slot_i(SLOT'(0)),
      .idle_o(ready_o),
      .take_i(valid_o),
      .done_o(valid_o),
      .*
  );
endmodule
