// SPDX-License-Identifier: Apache-2.0
// First tile and tile count of a quad along one axis, from its least and greatest coordinate: there the clock after
// load_i. They mean nothing when there is no pixel (range_empty).
//
// Ordinary quad: lo = max(ceil(low), scissor0), hi = min(floor(high), scissor1 - 1), in pixels. Homogeneous quad: lo =
// 0, hi = scissor1 - 1.
module quadrille_bounding_range #(
    localparam int T = quadrille_pkg::T_BITS, V = quadrille_pkg::VIEWPORT_BITS, TC = quadrille_pkg::TC_BITS,
    localparam int TL = quadrille_pkg::TILE_LOG2
) (
    input logic clk_i, load_i,
    input logic [T-1:0] low_i, high_i,
    input logic ordinary_i,
    input logic [V:0] scissor0_i, scissor1_i,
    output logic [TC-1:0] first_o, count_o,
    output logic [TL-1:0] last_o  // last pixel, in its tile
);
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int IW = T - FRAC;  // whole pixels, signed; two bits more than a guard band position

  logic [T-1:0] low_up;
  logic [IW-1:0] low_px, high_px, begin_px, last_px, lo_q, hi_q;
  logic low_inside, high_inside;
  assign low_up = low_i + T'((1 << FRAC) - 1);
  assign low_px = IW'($signed(low_up) >>> FRAC);
  assign high_px = IW'($signed(high_i) >>> FRAC);
  assign begin_px = IW'(scissor0_i);
  assign last_px = IW'(scissor1_i) - IW'(1);

  assign low_inside = $signed(low_px) > $signed(begin_px);
  assign high_inside = $signed(high_px) < $signed(last_px);

  always_ff @(posedge clk_i) begin
    if (load_i) begin
      lo_q <= !ordinary_i ? '0 : low_inside ? low_px : begin_px;
      hi_q <= !ordinary_i ? last_px : high_inside ? high_px : last_px;
    end
  end

  assign first_o = TC'(lo_q >> TL);
  assign count_o = TC'(hi_q >> TL) - first_o + TC'(1);
  assign last_o = TL'(hi_q);
endmodule
