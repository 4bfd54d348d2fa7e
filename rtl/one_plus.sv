// 1 + c of a raw product c >= 0, truncated and normalised: the bits of fp_sum of 1 * 1 and c. Latency ONE_PLUS_STAGES, one per
// clock.
//
// c = |D| rho rho' is a cosine, at most 1 but for the rounding of rho. So the one needs no alignment, and the sum has its highest one
// in one of two places:
//
//     1        01|000...           unit 2^-PREC_BITS
//     c        0x|xxx...|dropped   product >> (S-1-G - exp), exp <= 0 unless the product is 0
//
// Where D and r^2 have lost their QDROP lowest bits c has no bound, and fp_add does the work.
module one_plus #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic [E-1:0] exp_i,
    input logic [2*S-1:0] prod_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  localparam int TERM = quadrille_pkg::TERM_BITS;
  localparam int DROP = 2 * S - TERM;  // product bits below the unit at exponent 0
  logic unused;

  if (quadrille_pkg::QDROP == 0) begin : gen_cosine
    localparam int PREC = quadrille_pkg::PREC_BITS;
    localparam int NEAR = $clog2(TERM);  // bits of a distance that leaves something of the term

    // Stage 1: distance.
    logic [E-1:0] distance_q;
    logic [TERM-1:0] term_q;

    always_ff @(posedge clk_i) begin
      distance_q <= E'(0) - exp_i;  // a distance past the end clears the term
      term_q <= prod_i[DROP+:TERM];
    end

    // Stage 2: aligned sum. The upper integer bit of c is 0.
    logic [TERM-1:0] term;
    logic [PREC+1:0] sum_q;

    assign term = (distance_q[E-1:NEAR] != '0) ? '0 : term_q >> distance_q[NEAR-1:0];

    always_ff @(posedge clk_i) sum_q <= {term[PREC], !term[PREC], term[PREC-1:0]};

    // Stage 3: normalise.
    always_ff @(posedge clk_i) begin
      exp_o <= E'(sum_q[PREC+1]);
      sig_o <= sum_q[PREC+1] ? sum_q[PREC+1-:S] : sum_q[PREC-:S];
    end

    assign unused = ^{term[TERM-1], prod_i};
  end else begin : gen_any
    fp_add u_add (
        .clk_i,
        .a_rank_i(quadrille_pkg::exponent_rank(E'(0), 1'b1)),
        .a_term_i({2'b01, (TERM - 2)'(0)}),
        .b_rank_i(quadrille_pkg::exponent_rank(exp_i, prod_i[2*S-2+:2] != 2'b00)),  // a product is 0 or at least 2^(2S-2)
        .b_term_i(prod_i[DROP+:TERM]),
        .exp_o,
        .sig_o
    );

    assign unused = ^prod_i;
  end
endmodule
