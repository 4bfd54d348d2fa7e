// One multiplier pair of the setup: a*b + c*d or a*b - c*d, signed. Latency 2 (operand register, product register), one job a
// clock; the sum is combinational behind the product registers, the user's destination register is the third.
//
// Operands are DOT_BITS signed. No enable and no valid: the user keeps track of which job comes out.
module dot_unit #(
    localparam int W = quadrille_pkg::DOT_BITS,
    localparam int OUT = quadrille_pkg::DOT_OUT_BITS
) (
    input logic clk_i,
    input logic [W-1:0] a_i,
    input logic [W-1:0] b_i,
    input logic [W-1:0] c_i,
    input logic [W-1:0] d_i,
    input logic subtract_i,
    output logic [OUT-1:0] result_o
);
  logic signed [W-1:0] a_q, b_q, c_q, d_q;
  logic signed [2*W-1:0] ab_q, cd_q;
  logic subtract_q, subtract_product_q;

  always_ff @(posedge clk_i) begin
    a_q <= a_i;
    b_q <= b_i;
    c_q <= c_i;
    d_q <= d_i;
    subtract_q <= subtract_i;
    ab_q <= (2 * W)'(a_q) * (2 * W)'(b_q);
    cd_q <= (2 * W)'(c_q) * (2 * W)'(d_q);
    subtract_product_q <= subtract_q;
  end

  assign result_o = subtract_product_q ? {ab_q[2*W-1], ab_q} - {cd_q[2*W-1], cd_q} : {ab_q[2*W-1], ab_q} + {cd_q[2*W-1], cd_q};
endmodule
