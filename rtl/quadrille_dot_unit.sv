// SPDX-License-Identifier: Apache-2.0
// One multiplier pair of the front: a*b + c*d or a*b - c*d, signed. Latency 4, one job a clock: products of the halves
// and the halves' sums; the sums' product; the whole products; the result.
//
// Operands are DOT_BITS signed. A product takes three multipliers of 18 bits (Karatsuba & Ofman 1962): with x = xh
// 2^LOW + xl, x y = hh 2^(2 LOW) + ((xh + xl)(yh + yl) - hh - ll) 2^LOW + ll. The user keeps track of which job comes
// out; without active_i all registers hold.
module quadrille_dot_unit #(
    localparam int W = quadrille_pkg::DOT_BITS, OUT = quadrille_pkg::DOT_OUT_BITS
) (
    input logic clk_i, active_i,
    input logic [W-1:0] a_i, b_i, c_i, d_i,
    input logic subtract_i,
    output logic [OUT-1:0] result_o
);
  localparam int LOW = 16;  // the sum of the halves then fits 18 bits, signed
  localparam int HIGH = W - LOW, SUM = HIGH + 1;

  logic [2*W-1:0] x, y;  // the factors of either product
  logic [2:0] subtract_q;
  assign x = {c_i, a_i};
  assign y = {d_i, b_i};

  for (genvar g = 0; g < 2; g++) begin : gen_product
    logic signed [HIGH-1:0] xh, yh;
    logic signed [LOW:0] xl, yl;  // not negative
    logic signed [SUM-1:0] xs_q, ys_q;
    logic signed [2*HIGH-1:0] hh_q;
    logic [2*LOW-1:0] ll_q;
    logic signed [2*SUM-1:0] ss_q;
    logic [2*W-1:0] ends_q;
    logic signed [2*SUM-1:0] end_sum_q, middle;
    logic signed [2*W-1:0] product_q;
    assign middle = ss_q - end_sum_q;  // xh yl + xl yh
    assign {xh, xl} = {x[g*W+LOW+:HIGH], 1'b0, x[g*W+:LOW]};
    assign {yh, yl} = {y[g*W+LOW+:HIGH], 1'b0, y[g*W+:LOW]};

    always_ff @(posedge clk_i) begin
      if (active_i) begin
        hh_q <= (2 * HIGH)'(xh) * (2 * HIGH)'(yh);
        ll_q <= (2 * LOW)'(xl) * (2 * LOW)'(yl);
        xs_q <= SUM'(xh) + SUM'(xl);
        ys_q <= SUM'(yh) + SUM'(yl);
        ss_q <= (2 * SUM)'(xs_q) * (2 * SUM)'(ys_q);
        ends_q <= {hh_q, ll_q};
        end_sum_q <= (2 * SUM)'(hh_q) + $signed((2 * SUM)'(ll_q));
        product_q <= ends_q + ((2 * W)'(middle) << LOW);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      subtract_q <= {subtract_q[1:0], subtract_i};
      result_o <= subtract_q[2] ? OUT'(gen_product[0].product_q) - OUT'(gen_product[1].product_q) :
          OUT'(gen_product[0].product_q) + OUT'(gen_product[1].product_q);
    end
  end
endmodule
