// Judges a quad by its vertices while they come in: wholly behind the eye, or no depth code inside [znear, zfar] possible. The judgement is
// there in the clock after the fourth beat and stays until the next quad's first.
//
// Depth: every code lies between the corners' |Z / W| but for a relative margin (model/depth_rank.hpp derives it). Compared as ranks,
// {exponent, significand without its highest bit}, next numbers apart by 1, with W taken for the powers of two around it, so that nothing
// is divided: exact where W = 1. Conservative: a quad of which a pixel is inside is never rejected. The draw state is looked at in the clock
// of the first beat and later.
module quad_reject #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS,
    localparam int W = quadrille_pkg::W_BITS
) (
    input logic clk_i,
    // Draw state
    input logic depth_on_i,
    input logic [DB:0] znear_i,
    input logic [DB:0] zfar_i,
    // Beat
    input logic accept_i,
    input logic first_i,
    input logic [W-1:0] w_i,
    input logic z_neg_i,
    input logic [PE-1:0] z_exp_i,
    input logic [S-1:0] z_sig_i,
    // Quad
    output logic behind_o,
    output logic depth_o
);
  localparam int RANK = PE + 2 + S - 1;
  // Added to a vertex's rank, or taken off, for the limits come late: the draw state may change in the clock before.
  localparam logic [RANK-1:0] STEPS = RANK'(quadrille_pkg::DEPTH_MARGIN_STEPS);
  localparam logic [RANK-1:0] STEPS_FAR = STEPS + RANK'(1);  // one more where the far limit's significand was truncated

  // ---- Limits: the place of the highest one as the distance from the top, which its exponent falls with ------------------------
  localparam int WIDE = (DB + 2 > S) ? DB + 2 : S;  // zfar + 1 has DB + 2 bits
  localparam int COUNT = $clog2(WIDE);
  logic [COUNT-1:0] near_zeros, far_zeros;
  logic [PE+1:0] near_fall, far_fall;
  logic [WIDE-1:0] near_top, far_top;
  logic near_some_q;
  logic [RANK-1:0] near_q, far_q;  // of znear and of the code behind zfar, exponents less TOP

  shift_to_top #(
      .WIDTH(WIDE)
  ) u_near (
      .value_i(WIDE'(znear_i) << (WIDE - DB - 2)),
      .count_o(near_zeros),
      .value_o(near_top)
  );

  shift_to_top #(
      .WIDTH(WIDE)
  ) u_far (
      .value_i((WIDE'(zfar_i) + WIDE'(1)) << (WIDE - DB - 2)),
      .count_o(far_zeros),
      .value_o(far_top)
  );

  assign near_fall = (PE + 2)'(near_zeros);
  assign far_fall = (PE + 2)'(far_zeros);

  always_ff @(posedge clk_i) begin
    near_some_q <= near_top[WIDE-1];
    near_q <= {~near_fall, near_top[WIDE-2-:S-1]};
    far_q <= {~far_fall, far_top[WIDE-2-:S-1]};
  end

  // An exponent is 1 - zeros, and ~zeros is one less than -zeros.
  localparam logic [PE+1:0] TOP = (PE + 2)'(2);

  // Of code 1, as far less one: from there a code is not 0.
  localparam logic [RANK-1:0] SOME = {(PE + 2)'(0) - (PE + 2)'(DB) - TOP, (S - 1)'(0)} - RANK'(1);

  // ---- The beat -----------------------------------------------------------------------------------------------------------
  logic valid_q, first_q, neg_q, zero_q, positive_q;
  logic [RANK-1:0] greatest_q, least_q;  // of the vertex's depth, with the margin
  logic [S-1:0] sig_up, sig_down;  // with carry and borrow
  logic [PE+1:0] exp_up, exp_down;

  // Of a positive W, which alone matters: floor(log2 W) = W_TOP - w_zeros, and whether it is a power of two.
  localparam logic [PE+1:0] W_TOP = (PE + 2)'(W - 1) - (PE + 2)'(quadrille_pkg::FRAC);
  logic [$clog2(W)-1:0] w_zeros;
  logic [W-1:0] w_top;
  logic w_single;

  shift_to_top #(
      .WIDTH(W)
  ) u_w (
      .value_i(w_i),
      .count_o(w_zeros),
      .value_o(w_top)
  );

  assign w_single = (w_i & (w_i - W'(1))) == '0;
  assign sig_up = {1'b0, z_sig_i[S-2:0]} + STEPS[S-1:0];
  assign sig_down = {1'b0, z_sig_i[S-2:0]} - STEPS_FAR[S-1:0];
  assign exp_up = (PE + 2)'($signed(z_exp_i)) - W_TOP - TOP + (PE + 2)'(sig_up[S-1]);
  assign exp_down = (PE + 2)'($signed(z_exp_i)) - W_TOP - TOP - (PE + 2)'(1) - (PE + 2)'(sig_down[S-1]);

  always_ff @(posedge clk_i) begin
    valid_q <= accept_i;
    if (accept_i) begin
      first_q <= first_i;
      positive_q <= !w_i[W-1] && w_top[W-1];
      neg_q <= z_neg_i;
      zero_q <= !z_sig_i[S-1];
      greatest_q <= {exp_up + (PE + 2)'({w_zeros}), sig_up[S-2:0]};
      least_q <= {exp_down + (PE + 2)'({w_zeros}) + (PE + 2)'(w_single), sig_down[S-2:0]};
    end
  end

  logic unused;
  assign unused = ^{w_top, near_top, far_top};

  // ---- What holds for all beats so far ------------------------------------------------------------------------------------
  localparam int TERMS = 7;
  logic below, beyond, some;
  logic [TERMS-1:0] term, so_far_q, so_far;
  logic all_below, all_beyond, all_some, all_negative, none_negative, all_positive_w, no_positive_w;

  assign below = near_some_q && (zero_q || $signed(greatest_q) <= $signed(near_q));
  assign beyond = !zero_q && $signed(least_q) >= $signed(far_q);
  assign some = !zero_q && $signed(least_q) >= $signed(SOME);
  assign term = {below, beyond, some, neg_q, !neg_q, positive_q, !positive_q};
  assign so_far = valid_q ? (term & ({TERMS{first_q}} | so_far_q)) : so_far_q;

  always_ff @(posedge clk_i) so_far_q <= so_far;

  assign {all_below, all_beyond, all_some, all_negative, none_negative, all_positive_w, no_positive_w} = so_far;
  assign behind_o = no_positive_w;
  assign depth_o = quadrille_pkg::DEPTH_MARGIN_HOLDS && depth_on_i && all_positive_w &&
      (all_below || (none_negative && all_beyond) || (all_negative && all_some));
endmodule
