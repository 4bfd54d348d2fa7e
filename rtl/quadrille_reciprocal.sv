// SPDX-License-Identifier: Apache-2.0
// 1/a of a signed significand number by table. Latency RECIPROCAL_STAGES: table, inner and outer product, clamp. One
// result per clock.
//
// An exact power of two is exact; every other argument gives a significand in [1/2, 1) from the table of the top bits
// of the fraction. Zero gives zero. The sign is kept.
//
// Error, with the automatic segments of degree 2, S = 8 to 26: below 1 ulp, at most 0.81 (every argument: model_test
// --gtest_filter='*Table*'); relative, proved within -0.76 to +0.65 of 2^-(S-1) (analysis_test
// --gtest_filter='TableErrors.*').
module quadrille_reciprocal #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i, neg_i,
    input logic [E-1:0] exp_i,
    input logic [S-1:0] sig_i,
    output logic neg_o,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int K = quadrille_pkg::RECIP_SEGMENTS_LOG2;
  localparam int R = S - 1 - K, DX_BITS = (R < 1) ? 1 : R;

  logic zero, exact;
  logic [E-1:0] exp_d;
  logic [3*S+3:0] word;
  logic [DX_BITS-1:0] dx;
  assign zero = sig_i == '0;
  assign exact = sig_i[S-2:0] == '0;
  assign exp_d = zero ? '0 : exact ? E'(0) - exp_i : ~exp_i;  // -e or -e-1
  assign word = quadrille_tables_pkg::recip_rom(sig_i[S-2-:K]);
  if (R < 1) begin : gen_no_dx
    assign dx = '0;
  end else begin : gen_dx
    assign dx = sig_i[DX_BITS-1:0];
  end

  logic [S-1:0] poly;
  quadrille_table_polynomial #(.SEGMENTS_LOG2(K)) u_polynomial (.clk_i, .word_i(word), .dx_i(dx), .sig_o(poly));

  logic zero_q, exact_q, neg_q;
  logic [E-1:0] exp_q;
  quadrille_delay_line #(.WIDTH(E + 3), .DEPTH(quadrille_pkg::RECIPROCAL_STAGES - 1)) u_delay (
      .clk_i, .data_i({zero, exact, neg_i, exp_d}), .data_o({zero_q, exact_q, neg_q, exp_q})
  );

  always_ff @(posedge clk_i) begin
    neg_o <= neg_q;
    exp_o <= exp_q;
    sig_o <= zero_q ? '0 : exact_q ? {1'b1, (S - 1)'(0)} : poly;
  end
endmodule
