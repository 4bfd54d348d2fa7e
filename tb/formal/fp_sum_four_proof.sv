// fp_sum of four terms is fp_sum of rtl/README.md section 2 behind the products: for all terms, as fp_term gives them (proof fp_products), all exponents and signs.
// Assumed: a term is 0, and its rank, or has a one in its upper two places (a product of significand numbers).
module fp_sum_four_proof #(
    parameter int TERMS = 4,
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int TERM = quadrille_pkg::TERM_BITS,
    localparam int RANK = quadrille_pkg::RANK_BITS
) (
    input logic clk_i,
    input logic [TERMS*E-1:0] exp_i,
    input logic [TERMS-1:0] neg_i,
    input logic [TERMS*TERM-1:0] term_i
);
  localparam int WIDE = TERM + 4;
  logic [TERMS*RANK-1:0] rank;
  logic [TERMS-1:0] neg_q;
  logic [TERMS*TERM-1:0] term_q;
  logic neg, neg_spec;
  logic [E-1:0] exp, exp_spec;
  logic [S-1:0] sig, sig_spec;
  logic [E+S:0] expected;

  for (genvar k = 0; k < TERMS; k++) begin : gen_rank
    assign rank[k*RANK+:RANK] = quadrille_pkg::exponent_rank(exp_i[k*E+:E], term_i[k*TERM+:TERM] != '0);
  end

  always_ff @(posedge clk_i) {neg_q, term_q} <= {neg_i, term_i};

  fp_sum #(.TERMS(TERMS)) u_dut (.clk_i, .rank_i(rank), .neg_i(neg_q), .term_i(term_q), .neg_o(neg), .exp_o(exp), .sig_o(sig));

  logic some;
  logic signed [E:0] top;
  logic signed [WIDE-1:0] sum, part;
  logic [WIDE-1:0] m;

  always_comb begin
    some = 1'b0;
    top = '0;
    for (int k = 0; k < TERMS; k++) begin
      assume (term_i[k*TERM+:TERM] == '0 || term_i[k*TERM+TERM-1-:2] != 2'b00);
      if (term_i[k*TERM+:TERM] != '0 && (!some || $signed(exp_i[k*E+:E]) > top)) begin
        some = 1'b1;
        top = $signed(exp_i[k*E+:E]);
      end
    end
    sum = '0;
    for (int k = 0; k < TERMS; k++) begin
      part = WIDE'(term_i[k*TERM+:TERM] >> (E + 1)'(top - $signed({exp_i[k*E+E-1], exp_i[k*E+:E]})));
      sum = neg_i[k] ? sum - part : sum + part;
    end
    neg_spec = sum < 0;
    m = (sum < 0) ? -sum : sum;
    exp_spec = '0;
    sig_spec = '0;
    for (int h = 0; h < WIDE; h++) begin
      if (m[h]) begin  // the last that is set: the highest one
        exp_spec = E'(top) + E'(h) - E'(quadrille_pkg::PREC_BITS);
        sig_spec = (h >= S - 1) ? S'(m >> (h - (S - 1))) : S'(m << (S - 1 - h));
      end
    end
  end

  delay_line #(.WIDTH(1 + E + S), .DEPTH(1 + quadrille_pkg::FP_SUM_STAGES)) u_spec (.clk_i, .data_i({neg_spec, exp_spec, sig_spec}), .data_o(expected));

  always_comb assert ({neg, exp, sig} == expected);
endmodule
