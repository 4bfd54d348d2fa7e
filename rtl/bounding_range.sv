// First tile and tile count of a quad along one axis. Combinational.
//
// Ordinary quad: lo = max(ceil(min P), scissor0), hi = min(floor(max P), scissor1 - 1), P = the four coordinates in pixels.
// Homogeneous quad: lo = 0, hi = scissor1 - 1, empty if scissor0 >= scissor1. Empty: both outputs mean nothing.
module bounding_range #(
    localparam int T = quadrille_pkg::T_BITS,
    localparam int V = quadrille_pkg::VIEWPORT_BITS,
    localparam int TC = quadrille_pkg::TC_BITS
) (
    input logic [4*T-1:0] position_i,
    input logic ordinary_i,
    input logic [V:0] scissor0_i,
    input logic [V:0] scissor1_i,
    output logic empty_o,
    output logic [TC-1:0] first_o,
    output logic [TC-1:0] count_o
);
  localparam int FRAC = quadrille_pkg::FRAC;
  localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2;
  localparam int IW = T - FRAC;  // whole pixels, signed; two bits more than a guard band position

  logic [T-1:0] low, high;
  logic [T-1:0] low_up;
  logic [IW-1:0] low_px, high_px;
  logic [IW-1:0] begin_px, last_px;
  logic [IW-1:0] lo, hi;

  always_comb begin
    low = position_i[0+:T];
    high = position_i[0+:T];
    for (int i = 1; i < 4; i++) begin
      if ($signed(position_i[i*T+:T]) < $signed(low)) low = position_i[i*T+:T];
      if ($signed(position_i[i*T+:T]) > $signed(high)) high = position_i[i*T+:T];
    end
  end

  assign low_up = low + T'((1 << FRAC) - 1);
  assign low_px = IW'($signed(low_up) >>> FRAC);
  assign high_px = IW'($signed(high) >>> FRAC);
  assign begin_px = IW'(scissor0_i);
  assign last_px = IW'(scissor1_i) - IW'(1);

  assign lo = !ordinary_i ? '0 : ($signed(low_px) > $signed(begin_px)) ? low_px : begin_px;
  assign hi = !ordinary_i ? last_px : ($signed(high_px) < $signed(last_px)) ? high_px : last_px;
  assign empty_o = ordinary_i ? $signed(lo) > $signed(hi) : scissor0_i >= scissor1_i;

  assign first_o = TC'(lo >> TILE_LOG2);
  assign count_o = TC'(hi >> TILE_LOG2) - first_o + TC'(1);
endmodule
