// reciprocal and sqrt of the default machine, with its tables: zero, powers of two and of four, exponents and signs as rtl/SPEC.md, Numbers, has
// them, and every other result a significand number: its top bit set. For all numbers.
// Assumed: the argument is a significand number.
module table_units_proof #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic neg_i,
    input logic [E-1:0] exp_i,
    input logic [S-1:0] sig_i
);
  logic neg, neg_q;
  logic [E-1:0] recip_exp, root_exp, exp_q;
  logic [S-1:0] recip_sig, root_sig, sig_q;
  logic zero, one;
  logic signed [E:0] wide;

  quadrille_reciprocal u_reciprocal (
      .clk_i,
      .neg_i,
      .exp_i,
      .sig_i,
      .neg_o(neg),
      .exp_o(recip_exp),
      .sig_o(recip_sig)
  );

  quadrille_sqrt u_sqrt (
      .clk_i,
      .exp_i,
      .sig_i,
      .exp_o(root_exp),
      .sig_o(root_sig)
  );

  quadrille_delay_line #(.WIDTH(1 + E + S), .DEPTH(quadrille_pkg::RECIPROCAL_STAGES)) u_delay (
      .clk_i,
      .data_i({neg_i, exp_i, sig_i}),
      .data_o({neg_q, exp_q, sig_q})
  );

  assign zero = sig_q == '0;
  assign one = sig_q == S'(1) << (S - 1);
  assign wide = {exp_q[E-1], exp_q};

  logic signed [E:0] recip_spec, root_spec;

  assign recip_spec = one ? -wide : -wide - 1;
  assign root_spec = (wide < 0 && exp_q[0]) ? (wide - 1) / 2 : wide / 2;  // floor

  always_comb begin
    assume (sig_i[S-1] || (sig_i == '0 && exp_i == '0));
    assert (neg == neg_q);
    if (zero) begin
      assert (recip_sig == '0 && recip_exp == '0 && root_sig == '0 && root_exp == '0);
    end else begin
      assert (recip_exp == recip_spec[E-1:0] && root_exp == root_spec[E-1:0]);
      assert (recip_sig[S-1] && root_sig[S-1]);
      if (one) assert (recip_sig == S'(1) << (S - 1));
      if (one && !exp_q[0]) assert (root_sig == S'(1) << (S - 1));
    end
  end
endmodule
