// fp_normalise is fp_from_magnitude of rtl/SPEC.md, Numbers, for all magnitudes and biases; and holds its result while not active.
module fp_normalise_proof #(
    parameter int WIDTH = 63,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic active_i,
    input logic [WIDTH-1:0] magnitude_i,
    input logic [E-1:0] bias_i
);
  localparam int WIDE = WIDTH + S;
  logic [E-1:0] exp, exp_spec, exp_q, exp_expected;
  logic [S-1:0] sig, sig_spec, sig_q, sig_expected;

  quadrille_fp_normalise #(.WIDTH(WIDTH)) u_dut (
      .clk_i,
      .active_i,
      .magnitude_i,
      .bias_i,
      .exp_o(exp),
      .sig_o(sig)
  );

  always_comb begin
    exp_spec = '0;
    sig_spec = '0;
    for (int p = 0; p < WIDTH; p++) begin  // the last that is set: the highest one
      if (magnitude_i[p]) begin
        exp_spec = E'(p) + bias_i;
        sig_spec = S'((WIDE'(magnitude_i) << S) >> (p + 1));
      end
    end
  end

  always_ff @(posedge clk_i) begin
    {exp_q, sig_q} <= {exp_spec, sig_spec};
    {exp_expected, sig_expected} <= active_i ? {exp_q, sig_q} : {exp, sig};
  end

  always_comb assert ({exp, sig} == {exp_expected, sig_expected});
endmodule
