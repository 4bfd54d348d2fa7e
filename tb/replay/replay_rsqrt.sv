// Suite `rsqrt`: four r^2 in, their four rho out.
module replay_rsqrt (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;

  for (genvar g = 0; g < 4; g++) begin : gen_rsqrt
    rsqrt u_rsqrt (
        .clk_i,
        .exp_i(exp_i[g*E+:E]),
        .sig_i(sig_i[g*S+:S]),
        .exp_o(exp_o[g*E+:E]),
        .sig_o(sig_o[g*S+:S])
    );
  end

  replay_valid #(.LATENCY(quadrille_pkg::RSQRT_STAGES)) u_valid (.*);
endmodule
