// Suite `normalise`: A, D, r^2 in, the `norm` boundary (significand numbers and singular class) out.
module replay_normalise (
    `include "replay_ports.svh"
);
  `include "replay_fields.svh"
  localparam int S = quadrille_pkg::SIGNIFICAND_BITS;
  localparam int E = quadrille_pkg::EXP_BITS;
  localparam int VAL = quadrille_pkg::VAL_BITS;
  localparam int QVAL = quadrille_pkg::QVAL_BITS;

  logic [3:0] r2_neg;
  logic [quadrille_pkg::CLASS_ON_EDGE-1:0] class_rest;
  logic corner, unused;

  assign unused = ^{r2_neg, corner, class_rest};

  for (genvar g = 0; g < 6; g++) begin : gen_norm
    quadrille_normalise #(
        .WIDTH(VAL),
        .BIAS(-quadrille_pkg::QDROP)
    ) u_a (
        .clk_i,
        .active_i(1'b1),
        .value_i(a_i[g*VAL+:VAL]),
        .neg_o(a_neg_o[g]),
        .exp_o(a_exp_o[g*E+:E]),
        .sig_o(a_sig_o[g*S+:S])
    );

    quadrille_normalise #(.WIDTH(QVAL)) u_d (
        .clk_i,
        .active_i(1'b1),
        .value_i(d_i[g*QVAL+:QVAL]),
        .neg_o(d_neg_o[g]),
        .exp_o(d_exp_o[g*E+:E]),
        .sig_o(d_sig_o[g*S+:S])
    );
  end

  for (genvar g = 0; g < 4; g++) begin : gen_norm_r2
    quadrille_normalise #(
        .WIDTH(QVAL),
        .CLAMP(1'b1)
    ) u_r2 (
        .clk_i,
        .active_i(1'b1),
        .value_i(r2_i[g*QVAL+:QVAL]),
        .neg_o(r2_neg[g]),
        .exp_o(r2_exp_o[g*E+:E]),
        .sig_o(r2_sig_o[g*S+:S])
    );
  end

  quadrille_singular_class u_class (
      .active_i(1'b1),
      .corner_o(corner),
      .a_i(a_i[0+:4*VAL]),
      .d_i(d_i[0+:4*QVAL]),
      .class_o({two_corner_o, on_vertex_o, two_edge_o, on_edge_o, class_rest}),
      .*
  );

  replay_valid #(.LATENCY(quadrille_pkg::NORMALISE_STAGES)) u_valid (.*);
endmodule
