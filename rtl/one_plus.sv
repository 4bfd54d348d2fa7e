// 1 + c of a raw product c >= 0, truncated and normalised: the bits of fp_sum of 1 * 1 and c. Latency 2, one per enabled clock.
//
// c = |D| rho rho' is a cosine, at most 1 but for the rounding of rho. So the one needs no alignment, and the sum has its highest one
// in one of two places:
//
//     1        01|000...           unit 2^-PREC_BITS
//     c        0x|xxx...|dropped   product >> (S-1-G - exp), exp <= 0 unless the product is 0
//
// Where D and r^2 have lost their QDROP lowest bits c has no bound, and fp_sum itself does the work.
module one_plus #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS
) (
    input logic clk_i,
    input logic en_i,
    input logic [E-1:0] exp_i,
    input logic [2*S-1:0] prod_i,
    output logic [E-1:0] exp_o,
    output logic [S-1:0] sig_o
);
  logic unused;

  if (quadrille_pkg::QDROP == 0) begin : gen_cosine
    localparam int PREC = quadrille_pkg::PREC_BITS;
    localparam int DROP = S - 1 - quadrille_pkg::ALIGN_GUARD_BITS;  // product bits below the unit at exponent 0
    localparam int TERM = 2 * S - DROP;  // PREC fraction bits, two integer bits

    // Stage 1: aligned sum. The upper integer bit of c is 0.
    logic [E-1:0] distance;
    logic [TERM-1:0] term;
    logic [PREC+1:0] sum_q;

    assign distance = E'(0) - exp_i;  // a distance past the end clears the term
    assign term = prod_i[DROP+:TERM] >> distance;

    always_ff @(posedge clk_i) if (en_i) sum_q <= {term[PREC], !term[PREC], term[PREC-1:0]};

    // Stage 2: normalise.
    always_ff @(posedge clk_i) begin
      if (en_i) begin
        exp_o <= E'(sum_q[PREC+1]);
        sig_o <= sum_q[PREC+1] ? sum_q[PREC+1-:S] : sum_q[PREC-:S];
      end
    end

    assign unused = ^{term[TERM-1], prod_i};
  end else begin : gen_any
    logic neg;

    fp_sum #(.TERMS(2)) u_sum (
        .clk_i,
        .en_i,
        .neg_i(2'b00),
        .exp_i({exp_i, E'(0)}),
        .prod_i({prod_i, 2'b01, (2 * S - 2)'(0)}),
        .neg_o(neg),
        .exp_o,
        .sig_o
    );

    assign unused = neg;
  end
endmodule
