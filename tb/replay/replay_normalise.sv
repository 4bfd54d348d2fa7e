// Suite `normalise`: A, D, r^2 in, the `norm` boundary (significand numbers and singular class) out. Latency 2.
module replay_normalise #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int VAL = quadrille_pkg::VAL_BITS,
    localparam int QVAL = quadrille_pkg::QVAL_BITS,
    localparam int STIMULUS_BITS = 6 * VAL + 10 * QVAL,
    localparam int RESPONSE_BITS = 4 + 12 + 16 * (E + S)
) (
    input logic clk_i,
    input logic rst_ni,
    input logic valid_i,
    output logic ready_o,
    input logic [STIMULUS_BITS-1:0] stimulus_i,
    output logic valid_o,
    output logic [RESPONSE_BITS-1:0] response_o
);
  localparam int LATENCY = 2;

  logic [6*VAL-1:0] a;
  logic [6*QVAL-1:0] d;
  logic [4*QVAL-1:0] r2;
  logic [5:0] a_neg, d_neg;
  logic [6*E-1:0] a_exp, d_exp;
  logic [6*S-1:0] a_sig, d_sig;
  logic [3:0] r2_neg;
  logic [4*E-1:0] r2_exp;
  logic [4*S-1:0] r2_sig;
  logic [12:0] class_word;
  logic unused;

  assign {a, d, r2} = stimulus_i;
  assign response_o = {class_word[12:9], a_neg, a_exp, a_sig, d_neg, d_exp, d_sig, r2_exp, r2_sig};
  assign unused = ^{r2_neg, class_word[8:0]};

  for (genvar g = 0; g < 6; g++) begin : gen_norm
    normalise #(
        .WIDTH(VAL),
        .BIAS(-quadrille_pkg::QDROP)
    ) u_a (
        .clk_i,
        .en_i(1'b1),
        .value_i(a[g*VAL+:VAL]),
        .neg_o(a_neg[g]),
        .exp_o(a_exp[g*E+:E]),
        .sig_o(a_sig[g*S+:S])
    );

    normalise #(.WIDTH(QVAL)) u_d (
        .clk_i,
        .en_i(1'b1),
        .value_i(d[g*QVAL+:QVAL]),
        .neg_o(d_neg[g]),
        .exp_o(d_exp[g*E+:E]),
        .sig_o(d_sig[g*S+:S])
    );
  end

  for (genvar g = 0; g < 4; g++) begin : gen_norm_r2
    normalise #(
        .WIDTH(QVAL),
        .CLAMP(1'b1)
    ) u_r2 (
        .clk_i,
        .en_i(1'b1),
        .value_i(r2[g*QVAL+:QVAL]),
        .neg_o(r2_neg[g]),
        .exp_o(r2_exp[g*E+:E]),
        .sig_o(r2_sig[g*S+:S])
    );
  end

  singular_class u_class (
      .clk_i,
      .en_i(1'b1),
      .a_i(a[0+:4*VAL]),
      .d_i(d[0+:4*QVAL]),
      .r2_i(r2),
      .class_o(class_word)
  );

  replay_valid #(.LATENCY(LATENCY)) u_valid (.clk_i, .rst_ni, .valid_i, .ready_o, .valid_o);
endmodule
