// SPDX-License-Identifier: Apache-2.0
// Exact integer to significand number: sign and magnitude, then fp_normalise. Latency NORMALISE_STAGES, one per clock.
//
// value_i two's complement; exponent of the result = index of the highest one of |value| + BIAS; S bits kept, the rest
// dropped. Zero gives neg = exp = sig = 0. With CLAMP set a negative value counts as zero. The result's register is
// written in clocks with active_i, else it holds.
module quadrille_normalise #(
    parameter int WIDTH = 64,
    parameter int BIAS = 0,
    parameter bit CLAMP = 1'b0,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i, active_i,
    input logic [WIDTH-1:0] value_i,
    output logic neg_o,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  logic neg_d, late_neg;
  logic [WIDTH-1:0] magnitude_d, magnitude_q;
  assign neg_d = value_i[WIDTH-1] && !CLAMP;
  assign magnitude_d = !value_i[WIDTH-1] ? value_i : CLAMP ? '0 : WIDTH'(0) - value_i;

  always_ff @(posedge clk_i) magnitude_q <= magnitude_d;

  quadrille_delay_line #(.WIDTH(1), .DEPTH(quadrille_pkg::NORMALISE_STAGES - 1)) u_neg (.clk_i, .data_i(neg_d),
      .data_o(late_neg));
  always_ff @(posedge clk_i) if (active_i) neg_o <= late_neg;

  quadrille_fp_normalise #(.WIDTH(WIDTH)) u_normalise (
      .clk_i, .active_i, .magnitude_i(magnitude_q), .bias_i(E'(BIAS)), .exp_o, .sig_o
  );
endmodule
