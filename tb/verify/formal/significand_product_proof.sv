// significand_product is the product of any two significands, here of few bits around a small block.
// Assumed: factors are significands: the top bit is set, or all are 0.
module significand_product_proof #(
    parameter int S = 8,
    parameter int BLOCK = 4
) (
    input logic [S-1:0] a_i,
    input logic [S-1:0] b_i
);
  logic [2*S-1:0] product;

  quadrille_significand_product #(
      .S(S),
      .BLOCK(BLOCK)
  ) u_dut (
      .a_i,
      .b_i,
      .product_o(product)
  );

  always_comb begin
    assume (a_i[S-1] || a_i == '0);
    assume (b_i[S-1] || b_i == '0);
    assert (product == {{S{1'b0}}, a_i} * {{S{1'b0}}, b_i});
  end
endmodule
