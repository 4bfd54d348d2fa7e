// SPDX-License-Identifier: Apache-2.0
// sqrt(a) of an unsigned significand number by table. Latency SQRT_STAGES: table, inner and outer product, clamp. One
// result per clock.
//
// a = sig 2^(exp-(S-1)); p = exp & 1, h = floor(exp/2): sqrt(a) = 2^h sqrt(2^p m), m in [1, 2): a significand in [1, 2)
// from the table {p, top bits of m}. An exact power of four is exact. Zero gives zero.
//
// Error, with the automatic segments of degree 2, S = 8 to 26: below 1 ulp, at most 0.81 (every argument: model_test
// --gtest_filter='*Table*'). Of an argument that was itself truncated, relative: proved within -1.13 to +0.76 of
// 2^-(S-1) (analysis_test --gtest_filter='TableErrors.*').
module quadrille_sqrt #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic [E-1:0] exp_i,
    input logic [S-1:0] sig_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int K = quadrille_pkg::SQRT_SEGMENTS_LOG2;
  localparam int R = S - 1 - K, DX_BITS = (R < 1) ? 1 : R;

  logic zero;
  logic [E-1:0] half;
  logic [3*S+3:0] word;
  logic [DX_BITS-1:0] dx;
  assign zero = sig_i == '0;  // its exponent is 0
  assign half = {exp_i[E-1], exp_i[E-1:1]};
  assign word = quadrille_tables_pkg::sqrt_rom({exp_i[0], sig_i[S-2-:K]});
  if (R < 1) begin : gen_no_dx
    assign dx = '0;
  end else begin : gen_dx
    assign dx = sig_i[DX_BITS-1:0];
  end

  logic [S-1:0] poly;
  quadrille_table_polynomial #(.SEGMENTS_LOG2(K), .RISING(1'b1)) u_polynomial (
      .clk_i, .word_i(word), .dx_i(dx), .sig_o(poly)
  );

  logic zero_q;
  logic [E-1:0] exp_q;
  quadrille_delay_line #(.WIDTH(E + 1), .DEPTH(quadrille_pkg::SQRT_STAGES - 1)) u_delay (
      .clk_i, .data_i({zero, half}), .data_o({zero_q, exp_q})
  );

  always_ff @(posedge clk_i) begin
    exp_o <= exp_q;
    sig_o <= zero_q ? '0 : poly;
  end
endmodule
