// Product of two unsigned significand numbers, truncated and normalised. Latency 1, one result per clock.
//
// value = sig * 2^(exp-(S-1)), sig's top bit set or sig = exp = 0. Zero if either factor is zero. Signs are the user's business.
module fp_multiply #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic [E-1:0] a_exp_i,
    input logic [S-1:0] a_sig_i,
    input logic [E-1:0] b_exp_i,
    input logic [S-1:0] b_sig_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  logic [2*S-1:0] product;
  logic carry;
  logic zero;

  assign product = (2 * S)'(a_sig_i) * (2 * S)'(b_sig_i);
  assign carry = product[2*S-1];
  assign zero = (a_sig_i == '0) || (b_sig_i == '0);

  always_ff @(posedge clk_i) begin
    sig_o <= carry ? product[2*S-1:S] : product[2*S-2:S-1];  // all zero when a factor is
    exp_o <= zero ? '0 : a_exp_i + b_exp_i + E'(carry);
  end
endmodule
