// Suite `reciprocal`: a number in, its reciprocal out.
module replay_reciprocal (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"

  quadrille_reciprocal u_reciprocal (.*);

  replay_valid #(.LATENCY(quadrille_pkg::RECIPROCAL_STAGES)) u_valid (.*);
endmodule
