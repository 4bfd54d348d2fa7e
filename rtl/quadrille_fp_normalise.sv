// SPDX-License-Identifier: Apache-2.0
// fp_from_magnitude of SPEC.md, Numbers: an unsigned integer becomes a significand number. Latency FP_NORMALISE_STAGES
// (2): the long shifts, then the short ones; one per clock. Combinational with REGISTERED = 0.
//
// The last register is written in clocks with active_i, else it holds: what stands behind it does not switch.
//
// value = magnitude * 2^(bias) read as integer: p = index of the highest one, sig has it at bit S-1 (lower bits
// dropped, truncation), exp = p + bias. Magnitude 0 gives exp = 0, sig = 0.
module quadrille_fp_normalise #(
    parameter int WIDTH = 32,
    parameter bit REGISTERED = 1'b1,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i, active_i,
    input logic [WIDTH-1:0] magnitude_i,
    input logic [E-1:0] bias_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int SPLIT = 3;  // shifts by 2^SPLIT and more in stage 1
  // bits at the top that a shorter shift can still bring into the significand
  localparam int KEPT = S + (1 << SPLIT) - 1;
  localparam int WIDE = (WIDTH > KEPT) ? WIDTH : KEPT;  // a narrow magnitude is widened at its low end
  localparam int COUNT_BITS = $clog2(WIDE);

  // Stage 1
  logic [WIDE-1:0] coarse_d;
  logic [KEPT-1:0] coarse_top, coarse_q;
  logic [COUNT_BITS-1:SPLIT] high_count_d, high_count_q;
  logic [E-1:0] top_exp_d, top_exp_q;  // of a one at the top
  assign coarse_top = KEPT'(coarse_d >> (WIDE - KEPT));
  assign top_exp_d = bias_i + E'(WIDTH - 1);

  quadrille_shift_to_top #(.WIDTH(WIDE), .LAST(SPLIT)) u_coarse (
      .value_i(WIDE'(magnitude_i) << (WIDE - WIDTH)), .count_o(high_count_d), .value_o(coarse_d)
  );

  // Stage 2
  logic [KEPT-1:0] fine;
  logic [SPLIT-1:0] low_count;
  quadrille_shift_to_top #(.WIDTH(KEPT), .FIRST(SPLIT - 1)) u_fine (
      .value_i(coarse_q), .count_o(low_count), .value_o(fine)
  );

  logic [E-1:0] exp;
  logic [S-1:0] sig;
  assign sig = S'(fine >> (KEPT - S));
  assign exp = !fine[KEPT-1] ? '0 : top_exp_q - E'({high_count_q, low_count});

  if (REGISTERED) begin : gen_register
    always_ff @(posedge clk_i) begin
      {coarse_q, high_count_q, top_exp_q} <= {coarse_top, high_count_d, top_exp_d};
      if (active_i) {exp_o, sig_o} <= {exp, sig};
    end
  end else begin : gen_wire
    logic unused;
    assign unused = ^{clk_i, active_i};
    assign {coarse_q, high_count_q, top_exp_q} = {coarse_top, high_count_d, top_exp_d};
    assign {exp_o, sig_o} = {exp, sig};
  end
endmodule
