// table_polynomial is poly of rtl/SPEC.md, Numbers, in integers that neither wrap nor lose a sign, clamped to significands, for all words and dx.
// Assumed of the table (`quadrille config --emit-tables` makes such): C1 is not below the inner product, and C0 +- t0 is in C0's S + 4 bits.
module table_polynomial_proof #(
    parameter int SEGMENTS_LOG2 = 3,
    parameter bit RISING = 1'b0,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int R = S - 1 - SEGMENTS_LOG2
) (
    input logic clk_i,
    input logic [3*S+3:0] word_i,
    input logic [R-1:0] dx_i
);
  logic [S-1:0] sig, spec, expected;

  quadrille_table_polynomial #(
      .SEGMENTS_LOG2(SEGMENTS_LOG2),
      .RISING(RISING)
  ) u_dut (
      .clk_i,
      .word_i,
      .dx_i,
      .sig_o(sig)
  );

  localparam int WIDE = 2 * S + 6;
  logic signed [WIDE-1:0] c0, c1, c2, dx, t1, t0, sum, y;

  always_comb begin
    {c0, c1, c2, dx} = '0;
    c0[S+3:0] = word_i[2*S+:S+4];
    c1[S-1:0] = word_i[S+:S];
    c2[S-1:0] = word_i[0+:S];
    dx[R-1:0] = dx_i;
    t1 = c1 - ((c2 * dx) >>> R);
    t0 = (t1 * dx) >>> R;
    sum = RISING ? c0 + t0 : c0 - t0;
    assume (t1 >= 0);
    assume (sum >= 0 && (sum >>> (S + 4)) == 0);
    y = sum >>> quadrille_pkg::TABLE_GUARD;
    if ((y >>> S) != 0) spec = '1;
    else if ((y >>> (S - 1)) == 0) spec = {1'b1, {(S - 1) {1'b0}}};
    else spec = y[S-1:0];
  end

  quadrille_delay_line #(.WIDTH(S), .DEPTH(3)) u_spec (
      .clk_i,
      .data_i(spec),
      .data_o(expected)
  );

  always_comb assert (sig == expected);
endmodule
