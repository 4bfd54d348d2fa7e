// SPDX-License-Identifier: Apache-2.0
// Judges a quad by its vertices while they come in: wholly behind the eye, or all its depths outside [znear, zfar]. The
// judgement is there in the clock after the fourth beat and stays until the next quad's first. The draw state is looked
// at in the clock of the first beat and later.
//
// Depths lie between the codes of the nearest and the farthest corner, for fragment_output clamps them there. So one
// interval is enough for clamping and for znear and zfar: below least, near_cuts says whether a pixel is discarded or
// takes least; above greatest likewise. limits_o = {outside, near_cuts, far_cuts, least, greatest} comes a clock later,
// without a sign: where a limit is negative all is outside.
module quadrille_quad_reject #(
    localparam int DB = quadrille_pkg::DEPTH_BITS, CODE = quadrille_pkg::CORNER_DEPTH_BITS, W = quadrille_pkg::W_BITS
) (
    input logic clk_i,
    // Draw state
    input logic depth_on_i,
    input logic [DB:0] znear_i, zfar_i,
    // Beat
    input logic accept_i, first_i,
    input logic [W-1:0] w_i,
    // Depths of the quad's corners, from the clock after the first beat on
    input logic [CODE-1:0] low_i, high_i,
    // Quad
    output logic behind_o, depth_o,
    output logic [quadrille_pkg::DEPTH_LIMIT_BITS-1:0] limits_o
);
  logic [CODE-1:0] znear, zfar;
  logic outside_q, near_cuts_q, far_cuts_q;
  logic [DB:0] least_q, greatest_q;
  assign znear = {1'b0, znear_i};
  assign zfar = {1'b0, zfar_i};

  always_ff @(posedge clk_i) begin
    if (accept_i) behind_o <= (first_i || behind_o) && (w_i[W-1] || w_i == '0);
    outside_q <= $signed(high_i) < $signed(znear) || $signed(low_i) > $signed(zfar);
    near_cuts_q <= $signed(low_i) < $signed(znear);
    far_cuts_q <= $signed(high_i) > $signed(zfar);
    least_q <= near_cuts_q ? znear_i : low_i[DB:0];
    greatest_q <= far_cuts_q ? zfar_i : high_i[DB:0];
  end

  assign depth_o = depth_on_i && outside_q;
  assign limits_o = {outside_q, near_cuts_q, far_cuts_q, least_q, greatest_q};
endmodule
