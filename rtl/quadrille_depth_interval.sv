// SPDX-License-Identifier: Apache-2.0
// Where the depths of a quad's fragments lie, for hidden tiles: the codes of its corners with H = HIERARCHICAL_Z_BITS
// fraction bits, the nearest one rounded down, the farthest one up. There from the second clock after the fourth beat's
// until the second after the next quad's first beat's.
//
// far_o all ones says nothing, as that of a quad with a vertex that is not before the eye. lowers_o: a pixel that the
// quad covers surely is a fragment with such a depth; for that its corners must lie inside [znear, zfar], and D and r^2
// of an ordinary quad be exact, so that no sum of weights is 0.
module quadrille_depth_interval #(
    localparam int DB = quadrille_pkg::DEPTH_BITS, CODE = quadrille_pkg::CORNER_DEPTH_BITS,
    localparam int LIMITS = quadrille_pkg::DEPTH_LIMIT_BITS, H = quadrille_pkg::DEPTH_CODE_BITS
) (
    input logic clk_i,
    input logic [CODE-1:0] low_i, high_i,
    input logic [LIMITS-1:0] limits_i,  // of quad_reject
    input logic ordinary_i,
    output logic [H-1:0] near_o, far_o,
    output logic lowers_o
);
  localparam int DROP = DB - H;
  localparam logic [H-1:0] UNKNOWN = {H{1'b1}};  // not '1, of which Yosys 0.23 makes 1 in a parameter
  localparam bit EXACT = quadrille_pkg::QUADRATIC_FRAC_BITS >= 2 * quadrille_pkg::SUBPIXEL_BITS;
  localparam logic [CODE-1:0] ROUND_UP = (CODE'(1) << DROP) - CODE'(1);
  logic [CODE-1:0] near_down, far_up;
  logic near_end, far_end;

  // Below 0: any, for the registers are 0 then.
  assign near_down = low_i >> DROP;
  assign far_up = (high_i + ROUND_UP) >> DROP;
  // 1 and beyond count as the code before all ones, which hides whatever an entry says.
  assign near_end = near_down >= CODE'(UNKNOWN);
  assign far_end = far_up >= CODE'(UNKNOWN);

  always_ff @(posedge clk_i) begin
    near_o <= near_end ? UNKNOWN - H'(1) : near_down[H-1:0];
    far_o <= far_end ? UNKNOWN : far_up[H-1:0];
    if (low_i[CODE-1]) near_o <= '0;
    if (high_i[CODE-1]) far_o <= '0;
    lowers_o <= EXACT && ordinary_i && !far_end && limits_i[LIMITS-2-:2] == 2'b00;
  end

  logic unused;
  assign unused = ^{limits_i, near_down, far_up};
endmodule
