// fixed_point is floor(prod 2^(exp-(2S-2)) 2^FRAC_BITS) with the sign of neg_i, overflow_o from 2^INT_BITS on, for all products and all
// exponents. Assumed: prod_i is a product of significand numbers, 0 or with a one in its upper two places (fp_raw_product, proof fp_products).
module fixed_point_proof #(
    parameter int INT_BITS = 3,
    parameter int FRAC_BITS = 20,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int OUT = INT_BITS + FRAC_BITS
) (
    input logic clk_i,
    input logic neg_i,
    input logic [E-1:0] exp_i,
    input logic [2*S-1:0] prod_i
);
  localparam int WIDE = 2 * S + OUT + 4;
  logic overflow, overflow_spec, overflow_expected, neg;
  logic [OUT-1:0] fixed;
  logic [OUT:0] signed_fixed, fixed_spec, fixed_expected;
  logic signed [E+6:0] shift;  // to the left
  logic [WIDE-1:0] value;

  quadrille_fixed_point #(
      .INT_BITS(INT_BITS),
      .FRAC_BITS(FRAC_BITS)
  ) u_dut (
      .clk_i,
      .neg_i,
      .exp_i,
      .prod_i,
      .overflow_o(overflow),
      .neg_o(neg),
      .fixed_o(fixed)
  );

  assign signed_fixed = {neg, fixed} + (OUT + 1)'(neg);

  always_comb begin
    assume (prod_i == '0 || prod_i[2*S-1-:2] != 2'b00);
    shift = $signed(exp_i);
    shift = shift - (2 * S - 2) + FRAC_BITS;
    value = prod_i;
    overflow_spec = 1'b0;
    if (prod_i == '0) begin
      value = '0;
    end else if (shift >= OUT) begin
      overflow_spec = 1'b1;
    end else if (shift >= 0) begin
      value = value << shift;
    end else if (shift < -(2 * S)) begin
      value = '0;
    end else begin
      value = value >> (-shift);
    end
    if ((value >> OUT) != 0) overflow_spec = 1'b1;
    fixed_spec = neg_i ? (OUT + 1)'(0) - (OUT + 1)'(value) : (OUT + 1)'(value);
  end

  quadrille_delay_line #(.WIDTH(OUT + 2), .DEPTH(quadrille_pkg::FIXED_POINT_STAGES)) u_spec (
      .clk_i,
      .data_i({overflow_spec, fixed_spec}),
      .data_o({overflow_expected, fixed_expected})
  );

  always_comb assert (overflow == overflow_expected && (overflow || signed_fixed == fixed_expected));
endmodule
