// normalise is fp_from_int of rtl/SPEC.md, Numbers: sign and fp_from_magnitude of |value| with BIAS, for all values; with CLAMP a negative one counts
// as 0. Held while not active.
module normalise_proof #(
    parameter int WIDTH = 20,
    parameter int BIAS = -7,
    parameter bit CLAMP = 1'b0,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic active_i,
    input logic [WIDTH-1:0] value_i
);
  localparam int STAGES = quadrille_pkg::NORMALISE_STAGES;
  logic neg, neg_spec;
  logic [E-1:0] exp, exp_spec;
  logic [S-1:0] sig, sig_spec;
  logic signed [WIDTH:0] value;
  logic [WIDTH:0] magnitude;
  logic [E+S:0] early, expected;

  quadrille_normalise #(.WIDTH(WIDTH), .BIAS(BIAS), .CLAMP(CLAMP)) u_dut (.clk_i, .active_i, .value_i, .neg_o(neg), .exp_o(exp), .sig_o(sig));

  always_comb begin
    value = $signed(value_i);
    if (CLAMP && value < 0) value = 0;
    neg_spec = value < 0;
    magnitude = (value < 0) ? -value : value;
    exp_spec = '0;
    sig_spec = '0;
    for (int p = 0; p <= WIDTH; p++) begin  // the last that is set: the highest one
      if (magnitude[p]) begin
        exp_spec = E'(p + BIAS);
        sig_spec = S'(((WIDTH + 1 + S)'(magnitude) << S) >> (p + 1));
      end
    end
  end

  quadrille_delay_line #(.WIDTH(1 + E + S), .DEPTH(STAGES - 1)) u_spec (.clk_i, .data_i({neg_spec, exp_spec, sig_spec}), .data_o(early));
  always_ff @(posedge clk_i) expected <= active_i ? early : {neg, exp, sig};

  always_comb assert ({neg, exp, sig} == expected);
endmodule
