// Suite `reciprocal`: a number in, its reciprocal out.
module replay_reciprocal (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"

  reciprocal u_reciprocal (.en_i(1'b1), .*);

  replay_valid #(.LATENCY(quadrille_pkg::RECIPROCAL_STAGES)) u_valid (.*);
endmodule
