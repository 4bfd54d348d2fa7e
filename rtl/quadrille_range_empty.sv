// SPDX-License-Identifier: Apache-2.0
// Judges a quad by its vertices while they come in: is there no pixel centre along one axis, between its least and
// greatest coordinate and inside the scissor? Registers: there in the clock after the fourth beat, until the next
// quad's first.
//
// Ordinary quad: none if every coordinate is before the scissor's first pixel, or every one behind its last, or all lie
// between two neighbouring centres. Homogeneous quad, or any: none if the scissor has none. bounding_range gives the
// pixels when there are some.
module quadrille_range_empty #(
    localparam int T = quadrille_pkg::T_BITS, V = quadrille_pkg::VIEWPORT_BITS
) (
    input logic clk_i, accept_i, first_i,
    input logic [T-1:0] coordinate_i,
    input logic [T-1:0] low_i,  // least coordinate of the beats before
    input logic [V:0] scissor0_i, scissor1_i,
    input logic ordinary_i,  // all beats so far have W = ONE, a clock after the beat
    output logic empty_o
);
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int IW = T - FRAC;  // whole pixels, signed; two bits more than a guard band position

  logic [IW-1:0] floor, last;
  logic between;  // not on a centre
  logic before_q, behind_q, apart_q, closed_q;
  assign floor = coordinate_i[T-1:FRAC];
  assign between = coordinate_i[FRAC-1:0] != '0;
  assign last = IW'(scissor1_i) - IW'(1);

  always_ff @(posedge clk_i) begin
    if (accept_i) begin
      before_q <= (first_i || before_q) && $signed(floor) < $signed(IW'(scissor0_i));
      behind_q <= (first_i || behind_q) && $signed({floor, between}) > $signed({last, 1'b0});
      apart_q <= between && (first_i || (apart_q && floor == low_i[T-1:FRAC]));
      closed_q <= scissor0_i >= scissor1_i;
    end
  end

  assign empty_o = closed_q || (ordinary_i && (before_q || behind_q || apart_q));

  logic unused;
  assign unused = ^low_i[FRAC-1:0];
endmodule
