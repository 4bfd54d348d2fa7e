// fp_multiply is fp_multiply of rtl/SPEC.md, Numbers, for all pairs of numbers. Above 18 bits the product is that of the proof
// significand_product.
// Assumed: the factors are significand numbers: the top bit is set, or significand and exponent are 0.
module fp_multiply_proof #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic [E-1:0] a_exp_i,
    input logic [S-1:0] a_sig_i,
    input logic [E-1:0] b_exp_i,
    input logic [S-1:0] b_sig_i
);
  logic [E-1:0] exp, exp_spec, exp_expected;
  logic [S-1:0] sig, sig_spec, sig_expected;

  quadrille_fp_multiply u_dut (
      .clk_i,
      .a_exp_i,
      .a_sig_i,
      .b_exp_i,
      .b_sig_i,
      .exp_o(exp),
      .sig_o(sig)
  );

  logic [2*S-1:0] product;

  quadrille_significand_product u_product (
      .a_i(a_sig_i),
      .b_i(b_sig_i),
      .product_o(product)
  );

  always_comb begin
    assume (a_sig_i[S-1] || (a_sig_i == '0 && a_exp_i == '0));
    assume (b_sig_i[S-1] || (b_sig_i == '0 && b_exp_i == '0));
    exp_spec = a_exp_i + b_exp_i;
    if (a_sig_i == '0 || b_sig_i == '0) begin
      exp_spec = '0;
      sig_spec = '0;
    end else if (product >= (2 * S)'(1) << (2 * S - 1)) begin  // 2 or more
      exp_spec = exp_spec + 1;
      sig_spec = S'(product >> S);
    end else begin
      sig_spec = S'(product >> (S - 1));
    end
  end

  quadrille_delay_line #(.WIDTH(E + S), .DEPTH(quadrille_pkg::PRODUCT_STAGES)) u_spec (
      .clk_i,
      .data_i({exp_spec, sig_spec}),
      .data_o({exp_expected, sig_expected})
  );

  always_comb assert ({exp, sig} == {exp_expected, sig_expected});
endmodule
