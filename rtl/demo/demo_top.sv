// SPDX-License-Identifier: Apache-2.0
// The demo on an ECP5 board: turning quads, 640x480 over DVI. The parameters are data of the board (boards/).
// The pixel clock is 25 MHz and clocks all but the serialisers, which have five times as much.
module demo_top #(
    parameter int CLKI_DIV = 1, CLKFB_DIV = 5, CLKOP_DIV = 5, CLKOS_DIV = 25,
    parameter int HOLD = 3  // refreshes of the screen for a pose
) (
    input logic clk_i,
    output logic [3:0] gpdi_o,  // blue, green, red, clock: the pins of a pair are driven as a differential output
    output logic high_o  // always 1: an LED, or a pin that the board wants high
);
  logic shift_clk, clk, locked;
  (* ICP_CURRENT = "12", LPF_RESISTOR = "8", MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
  EHXPLLL #(
      .CLKI_DIV(CLKI_DIV), .CLKFB_DIV(CLKFB_DIV), .CLKOP_DIV(CLKOP_DIV), .CLKOS_DIV(CLKOS_DIV), .FEEDBK_PATH("CLKOP"),
      .CLKOP_ENABLE("ENABLED"), .CLKOS_ENABLE("ENABLED"), .CLKOP_CPHASE(CLKOP_DIV / 2), .CLKOS_CPHASE(CLKOP_DIV / 2)
  ) u_pll (
      .CLKI(clk_i), .CLKFB(shift_clk), .RST(1'b0), .STDBY(1'b0), .PHASESEL0(1'b0), .PHASESEL1(1'b0), .PHASEDIR(1'b1),
      .PHASESTEP(1'b1), .PHASELOADREG(1'b1), .PLLWAKESYNC(1'b0), .ENCLKOP(1'b0), .CLKOP(shift_clk), .CLKOS(clk),
      .LOCK(locked)
  );
  assign high_o = 1'b1;

  logic [7:0] reset_q = 8'd0;
  always_ff @(posedge clk) reset_q <= locked ? {reset_q[6:0], 1'b1} : 8'd0;

  logic frame_end, visible;
  logic [8:0] x;
  logic [7:0] y, colour;
  demo_draw #(.HOLD(HOLD)) u_draw (
      .clk_i(clk), .rst_ni(reset_q[7]), .frame_end_i(frame_end), .x_i(x), .y_i(y), .colour_o(colour)
  );

  logic hsync, vsync;
  demo_timing u_timing (
      .clk_i(clk), .rst_ni(reset_q[7]), .x_o(x), .y_o(y), .visible_o(visible), .hsync_o(hsync), .vsync_o(vsync),
      .frame_end_o(frame_end)
  );

  // Colours of 3:3:2 bits, repeated to 8.
  logic [9:0] red, green, blue;
  demo_tmds u_red (
      .clk_i(clk), .visible_i(visible), .control_i(2'b00), .data_i({{2{colour[7:5]}}, colour[7:6]}), .word_o(red)
  );
  demo_tmds u_green (
      .clk_i(clk), .visible_i(visible), .control_i(2'b00), .data_i({{2{colour[4:2]}}, colour[4:3]}), .word_o(green)
  );
  demo_tmds u_blue (
      .clk_i(clk), .visible_i(visible), .control_i({vsync, hsync}), .data_i({4{colour[1:0]}}), .word_o(blue)
  );

  demo_serialise u_serialise (
      .clk_i(clk), .shift_clk_i(shift_clk), .words_i({10'b0000011111, red, green, blue}), .pins_o(gpdi_o)
  );
endmodule
