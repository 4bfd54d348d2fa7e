// A sum of two products as rtl/SPEC.md, Numbers, has it, in integers wide enough for each step; for the proofs of fp_sum and fp_add.
// Defines m (the magnitude), e (the exponent of the largest term), negative, and the result exp_spec, sig_spec.
localparam int G = quadrille_pkg::ALIGN_GUARD_BITS;
localparam int WIDE = 2 * S + 4;

logic [WIDE-1:0] p [0:1];
logic signed [E+1:0] ek [0:1];
logic signed [E+1:0] e;
logic [WIDE-1:0] t [0:1];
logic [WIDE-1:0] m;
logic negative;
logic [E-1:0] exp_spec;
logic [S-1:0] sig_spec;

always_comb begin
  for (int k = 0; k < 2; k++) begin
    // Significand numbers, whose products' exponents do not leave EXP_BITS.
    assume (a_sig_i[k*S+S-1] || (a_sig_i[k*S+:S] == '0 && a_exp_i[k*E+:E] == '0));
    assume (b_sig_i[k*S+S-1] || (b_sig_i[k*S+:S] == '0 && b_exp_i[k*E+:E] == '0));
    ek[k] = {{2{a_exp_i[k*E+E-1]}}, a_exp_i[k*E+:E]} + {{2{b_exp_i[k*E+E-1]}}, b_exp_i[k*E+:E]};
    assume (ek[k][E+1] == ek[k][E-1] && ek[k][E] == ek[k][E-1]);
    p[k] = WIDE'(a_sig_i[k*S+:S]) * WIDE'(b_sig_i[k*S+:S]);
  end
  e = (p[1] != '0 && (p[0] == '0 || ek[1] > ek[0])) ? ek[1] : ek[0];
  for (int k = 0; k < 2; k++) t[k] = (p[k] == '0) ? '0 : p[k] >> ((E + 2)'(e - ek[k]) + (E + 2)'(S - 1 - G));
  negative = 1'b0;
  if (neg_i[0] == neg_i[1]) begin
    m = t[0] + t[1];
    negative = neg_i[0];
  end else if (t[0] >= t[1]) begin
    m = t[0] - t[1];
    negative = neg_i[0];
  end else begin
    m = t[1] - t[0];
    negative = neg_i[1];
  end
  exp_spec = '0;
  sig_spec = '0;
  if (m == '0) negative = 1'b0;
  for (int h = 0; h < WIDE; h++) begin
    if (m[h] && (m >> h) == WIDE'(1)) begin  // h: the highest one
      exp_spec = E'(e) + E'(h) - E'(S - 1 + G);
      sig_spec = (h >= S - 1) ? S'(m >> (h - (S - 1))) : S'(m << (S - 1 - h));
    end
  end
end
