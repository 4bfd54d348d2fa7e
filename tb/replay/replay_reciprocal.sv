// Suite `reciprocal`: a number in, its reciprocal out. Latency 3.
module replay_reciprocal (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"

  reciprocal u_reciprocal (.en_i(1'b1), .*);

  replay_valid #(.LATENCY(3)) u_valid (.*);
endmodule
