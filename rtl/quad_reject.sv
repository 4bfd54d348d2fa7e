// Judges a quad by its vertices while they come in: wholly behind the eye, or no depth code inside [znear, zfar] possible. The judgement is
// there in the clock after the fourth beat and stays until the next quad's first.
//
// Depth: every code lies between the corners' |Z / W| but for a relative margin (model/quad_reject.hpp derives it). Compared as ranks,
// {exponent, significand without its highest bit}, next numbers apart by 1, with W taken for the powers of two around it, so that nothing
// is divided: exact where W = 1. Conservative: a quad of which a pixel is inside is never rejected. The draw state is looked at in the clock
// of the first beat and later.
module quad_reject #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int E = quadrille_pkg::EXP_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS
) (
    input logic clk_i,
    // Draw state
    input logic depth_on_i,
    input logic [DB:0] znear_i,
    input logic [DB:0] zfar_i,
    // Beat
    input logic accept_i,
    input logic first_i,
    input logic w_positive_i,
    input logic [PE-1:0] w_exp_i,  // floor(log2 |W|)
    input logic w_single_i,  // W is a power of two
    input logic z_neg_i,
    input logic [PE-1:0] z_exp_i,
    input logic [S-1:0] z_sig_i,
    // Quad
    output logic behind_o,
    output logic depth_o
);
  localparam int RANK = PE + 2 + S - 1;
  // The margin in units of 2^-(S-1), 2 + 3/2^ALIGN_GUARD_BITS rounded up; a rank is more than half of one, and one more for products of losses.
  localparam int MARGIN = (quadrille_pkg::ALIGN_GUARD_BITS == 0) ? 6 : (quadrille_pkg::ALIGN_GUARD_BITS == 1) ? 4 : 3;
  localparam logic [RANK-1:0] STEPS = RANK'(2 * MARGIN + 1);
  // It holds for a table of reciprocals that has its automatic number of segments, or more.
  localparam bit BY_DEPTH = quadrille_pkg::RECIP_SEGMENTS_LOG2 >= quadrille_pkg::RECIP_AUTO;

  // ---- Limits -------------------------------------------------------------------------------------------------------------
  logic [E-1:0] near_exp, far_exp;
  logic [S-1:0] near_sig, far_sig;
  logic near_some_q;
  logic [RANK-1:0] near_q, far_q;  // up to near_q a code is below znear, from far_q on it is beyond zfar

  fp_normalise #(
      .WIDTH(DB + 1),
      .REGISTERED(1'b0)
  ) u_near (
      .clk_i,
      .magnitude_i(znear_i),
      .bias_i(E'(0) - E'(DB)),
      .exp_o(near_exp),
      .sig_o(near_sig)
  );

  fp_normalise #(
      .WIDTH(DB + 2),
      .REGISTERED(1'b0)
  ) u_far (
      .clk_i,
      .magnitude_i({1'b0, zfar_i} + (DB + 2)'(1)),
      .bias_i(E'(0) - E'(DB)),
      .exp_o(far_exp),
      .sig_o(far_sig)
  );

  always_ff @(posedge clk_i) begin
    near_some_q <= near_sig[S-1];
    near_q <= {near_exp[PE+1:0], near_sig[S-2:0]} - STEPS;
    far_q <= {far_exp[PE+1:0], far_sig[S-2:0]} + STEPS + RANK'(1);  // one more where the significand was truncated
  end

  logic unused;
  assign unused = ^{near_exp[E-1:PE+2], far_exp[E-1:PE+2], far_sig[S-1]};

  // The rank of code 1, and STEPS: from there a code is not 0.
  localparam logic [RANK-1:0] SOME = {(PE + 2)'(0) - (PE + 2)'(DB), STEPS[S-2:0]};

  // ---- The beat -----------------------------------------------------------------------------------------------------------
  logic valid_q, first_q, single_q, neg_q, zero_q, positive_q;
  logic [RANK-1:0] greatest_q, least;

  always_ff @(posedge clk_i) begin
    valid_q <= accept_i;
    if (accept_i) begin
      first_q <= first_i;
      positive_q <= w_positive_i;
      single_q <= w_single_i;
      neg_q <= z_neg_i;
      zero_q <= !z_sig_i[S-1];
      greatest_q <= {(PE + 2)'($signed(z_exp_i)) - (PE + 2)'($signed(w_exp_i)), z_sig_i[S-2:0]};
    end
  end

  assign least = {greatest_q[RANK-1:S-1] - (PE + 2)'(!single_q), greatest_q[S-2:0]};

  // ---- What holds for all beats so far ------------------------------------------------------------------------------------
  localparam int TERMS = 7;
  logic below, beyond, some;
  logic [TERMS-1:0] term, so_far_q, so_far;
  logic all_below, all_beyond, all_some, all_negative, none_negative, all_positive_w, no_positive_w;

  assign below = near_some_q && (zero_q || $signed(greatest_q) <= $signed(near_q));
  assign beyond = !zero_q && $signed(least) >= $signed(far_q);
  assign some = !zero_q && $signed(least) >= $signed(SOME);
  assign term = {below, beyond, some, neg_q, !neg_q, positive_q, !positive_q};
  assign so_far = valid_q ? (term & ({TERMS{first_q}} | so_far_q)) : so_far_q;

  always_ff @(posedge clk_i) so_far_q <= so_far;

  assign {all_below, all_beyond, all_some, all_negative, none_negative, all_positive_w, no_positive_w} = so_far;
  assign behind_o = no_positive_w;
  assign depth_o = BY_DEPTH && depth_on_i && all_positive_w &&
      (all_below || (none_negative && all_beyond) || (all_negative && all_some));
endmodule
