// Exact integer to significand number in two stages: sign, magnitude and leading zeros; then the shift. One per enabled clock.
//
// value_i two's complement; exponent of the result = index of the highest one of |value| + BIAS; S bits kept, the rest dropped.
// Zero gives neg = exp = sig = 0. With CLAMP set a negative value counts as zero.
module normalise #(
    parameter int WIDTH = 64,
    parameter int BIAS = 0,
    parameter bit CLAMP = 1'b0,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic en_i,
    input logic [WIDTH-1:0] value_i,
    output logic neg_o,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int COUNT_BITS = $clog2(WIDTH);
  localparam int PAD = (WIDTH < S) ? S - WIDTH : 0;

  // Stage 1
  logic neg_d, neg_q;
  logic [WIDTH-1:0] magnitude_d, magnitude_q;
  logic [COUNT_BITS-1:0] count_d, count_q;

  assign neg_d = value_i[WIDTH-1] && !CLAMP;
  assign magnitude_d = !value_i[WIDTH-1] ? value_i : CLAMP ? '0 : WIDTH'(0) - value_i;

  leading_zeros #(.WIDTH(WIDTH)) u_leading_zeros (
      .value_i(magnitude_d),
      .count_o(count_d)
  );

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      neg_q <= neg_d;
      magnitude_q <= magnitude_d;
      count_q <= count_d;
    end
  end

  // Stage 2
  logic [WIDTH-1:0] shifted;

  assign shifted = magnitude_q << count_q;

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      neg_o <= neg_q;
      exp_o <= (magnitude_q == '0) ? '0 : E'(WIDTH - 1 + BIAS) - E'(count_q);
      sig_o <= S'(((WIDTH + PAD)'(shifted) << PAD) >> (WIDTH + PAD - S));
    end
  end
endmodule
