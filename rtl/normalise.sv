// Exact integer to significand number in two stages: sign, magnitude and the long shifts; then the short ones. One per enabled clock.
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
  localparam int SPLIT = 3;  // shifts by 2^SPLIT and more in stage 1
  localparam int KEPT = S + (1 << SPLIT) - 1;  // bits at the top that a shorter shift can still bring into the significand
  localparam int WIDE = (WIDTH > KEPT) ? WIDTH : KEPT;  // a narrow value is widened at its low end
  localparam int COUNT_BITS = $clog2(WIDE);

  // Stage 1
  logic neg_d, neg_q;
  logic [WIDTH-1:0] magnitude;
  logic [WIDE-1:0] coarse_d;
  logic [KEPT-1:0] coarse_q;
  logic [COUNT_BITS-1:SPLIT] high_count_d, high_count_q;

  assign neg_d = value_i[WIDTH-1] && !CLAMP;
  assign magnitude = !value_i[WIDTH-1] ? value_i : CLAMP ? '0 : WIDTH'(0) - value_i;

  shift_to_top #(
      .WIDTH(WIDE),
      .LAST(SPLIT)
  ) u_coarse (
      .value_i(WIDE'(magnitude) << (WIDE - WIDTH)),
      .count_o(high_count_d),
      .value_o(coarse_d)
  );

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      neg_q <= neg_d;
      coarse_q <= KEPT'(coarse_d >> (WIDE - KEPT));
      high_count_q <= high_count_d;
    end
  end

  // Stage 2
  logic [KEPT-1:0] fine;
  logic [SPLIT-1:0] low_count;

  shift_to_top #(
      .WIDTH(KEPT),
      .FIRST(SPLIT - 1)
  ) u_fine (
      .value_i(coarse_q),
      .count_o(low_count),
      .value_o(fine)
  );

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      neg_o <= neg_q;
      exp_o <= !fine[KEPT-1] ? '0 : E'(WIDTH - 1 + BIAS) - E'({high_count_q, low_count});
      sig_o <= S'(fine >> (KEPT - S));
    end
  end
endmodule
