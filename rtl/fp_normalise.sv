// fp_from_magnitude of README.md section 2, combinational: an unsigned integer becomes a significand number.
//
// value = magnitude * 2^(bias) read as integer: p = index of the highest one, sig has it at bit S-1 (lower bits dropped,
// truncation), exp = p + bias. Magnitude 0 gives exp = 0, sig = 0.
module fp_normalise #(
    parameter int WIDTH = 32,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic [WIDTH-1:0] magnitude_i,
    input logic [E-1:0] bias_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int COUNT_BITS = $clog2(WIDTH);
  localparam int PAD = (WIDTH < S) ? S - WIDTH : 0;  // a narrow magnitude is widened at its low end

  logic [COUNT_BITS-1:0] count;
  logic [WIDTH-1:0] shifted;

  shift_to_top #(.WIDTH(WIDTH)) u_shift (
      .value_i(magnitude_i),
      .count_o(count),
      .value_o(shifted)
  );

  assign sig_o = S'(((WIDTH + PAD)'(shifted) << PAD) >> (WIDTH + PAD - S));
  assign exp_o = !shifted[WIDTH-1] ? '0 : bias_i + E'(WIDTH - 1) - E'(count);
endmodule
