// Where the depths of a quad's fragments lie, by its vertices while they come in: codes with H = HIERARCHICAL_Z_BITS fraction bits, the
// nearest one rounded down, the farthest one up. There from the fourth clock after the fourth beat's until the second after the next
// quad's first beat's: sums with the margin and shifts have a clock each.
//
// W of an ordinary quad is 1, so every depth lies between its corners' Z but for the margin of quadrille_pkg. Of all others near_o is 0
// and far_o all ones: no statement. lowers_o: a pixel that the quad covers surely is a fragment with such a depth; for that the interval
// must lie inside [znear, zfar], and D and r^2 of an ordinary quad be exact, so that no sum of weights is 0. Wrong in no case: near_o and
// far_o may be farther apart than need be by a code and the margin.
module depth_interval #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS,
    localparam int PE = quadrille_pkg::PORT_EXP_BITS,
    localparam int DB = quadrille_pkg::DEPTH_BITS,
    localparam int H = quadrille_pkg::DEPTH_CODE_BITS
) (
    input logic clk_i,
    // Draw state
    input logic [DB:0] znear_i,
    input logic [DB:0] zfar_i,
    // Beat
    input logic accept_i,
    input logic first_i,
    input logic z_neg_i,
    input logic [PE-1:0] z_exp_i,
    input logic [S-1:0] z_sig_i,
    // Quad
    input logic ordinary_i,
    output logic [H-1:0] near_o,
    output logic [H-1:0] far_o,
    output logic lowers_o
);
  localparam int RANK = PE + 1 + S - 1;  // {exponent, significand without its highest bit}, a bit to spare for the margin
  localparam logic [RANK-1:0] STEPS = RANK'(quadrille_pkg::DEPTH_MARGIN_STEPS);
  localparam logic [RANK-1:0] ZERO = {2'b11, (RANK - 2)'(0)};  // below every number
  localparam logic [H-1:0] UNKNOWN = {H{1'b1}};  // not '1, of which Yosys 0.23 makes 1 in a parameter
  localparam bit EXACT = quadrille_pkg::QUADRATIC_FRAC_BITS >= 2 * quadrille_pkg::SUBPIXEL_BITS;

  // ---- The beats so far -----------------------------------------------------------------------------------------------------
  logic valid_q, first_q, neg_q, some_neg_q;
  logic [RANK-1:0] rank_q, least_q, greatest_q;

  always_ff @(posedge clk_i) begin
    valid_q <= accept_i;
    if (accept_i) begin
      first_q <= first_i;
      neg_q <= z_neg_i;
      rank_q <= z_sig_i[S-1] ? {z_exp_i[PE-1], z_exp_i, z_sig_i[S-2:0]} : ZERO;
    end
    if (valid_q) begin
      some_neg_q <= neg_q || (!first_q && some_neg_q);
      if (first_q || $signed(rank_q) < $signed(least_q)) least_q <= rank_q;
      if (first_q || $signed(rank_q) > $signed(greatest_q)) greatest_q <= rank_q;
    end
  end

  // ---- Codes ----------------------------------------------------------------------------------------------------------------
  logic [RANK-1:0] nearest_q, farthest_q;
  logic [PE:0] near_shift, far_shift;  // below 1 the places behind the point's, else negative
  logic [H-1:0] near_bits, far_bits, near, far;
  logic known_q;

  always_ff @(posedge clk_i) begin
    nearest_q <= least_q - STEPS;
    farthest_q <= greatest_q + STEPS;
    known_q <= quadrille_pkg::DEPTH_MARGIN_HOLDS && ordinary_i && !some_neg_q;
  end

  assign near_shift = ~nearest_q[RANK-1:S-1];
  assign far_shift = ~farthest_q[RANK-1:S-1];

  // The highest H bits of {1, significand}, as many zeros behind it as may be missing
  logic [S+H-1:0] near_window, far_window;
  assign near_window = {1'b1, nearest_q[S-2:0], H'(0)};
  assign far_window = {1'b1, farthest_q[S-2:0], H'(0)};
  assign near_bits = near_window[S+H-1-:H] >> near_shift;
  assign far_bits = far_window[S+H-1-:H] >> far_shift;

  assign near = (near_shift[PE] || near_bits == UNKNOWN) ? UNKNOWN - H'(1) : near_bits;
  assign far = (far_shift[PE] || far_bits == UNKNOWN) ? UNKNOWN : far_bits + H'(1);

  // far below UNKNOWN and at most zfar, near above znear, by the bits before the code that is added: the comparisons need not wait for it.
  // Where near is no such bits, far is UNKNOWN.
  logic in_limits;
  assign in_limits = !far_shift[PE] && !(&far_bits[H-1:1]) && {1'b0, far_bits} < zfar_i[DB-:H+1] &&
                     (znear_i == '0 || {1'b0, near_bits} > znear_i[DB-:H+1]);

  always_ff @(posedge clk_i) begin
    near_o <= known_q ? near : '0;
    far_o <= known_q ? far : UNKNOWN;
    lowers_o <= EXACT && known_q && in_limits;
  end

  logic unused;
  assign unused = ^{near_window, far_window, zfar_i};
endmodule
