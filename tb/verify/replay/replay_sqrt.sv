// Suite `sqrt`: four r^2 in, their four root out.
module replay_sqrt (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;

  for (genvar g = 0; g < 4; g++) begin : gen_sqrt
    quadrille_sqrt u_sqrt (
        .clk_i,
        .exp_i(exp_i[g*E+:E]),
        .sig_i(sig_i[g*S+:S]),
        .exp_o(exp_o[g*E+:E]),
        .sig_o(sig_o[g*S+:S])
    );
  end

  replay_valid #(.LATENCY(quadrille_pkg::SQRT_STAGES)) u_valid (.*);
endmodule
