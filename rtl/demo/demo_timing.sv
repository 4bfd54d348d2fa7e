// SPDX-License-Identifier: Apache-2.0
// Timing of 640x480 at 60 Hz: 800 x 525 clocks. x_o and y_o name a place of the frame buffer, each pixel of which is
// two wide and two high. visible_o and the syncs (active low) are a clock later, as is the frame buffer's colour.
module demo_timing (
    input logic clk_i,
    input logic rst_ni,
    output logic [8:0] x_o,
    output logic [7:0] y_o,
    output logic visible_o,
    output logic hsync_o,
    output logic vsync_o,
    output logic frame_end_o  // for a clock, behind the last visible line
);
  logic [9:0] column_q, line_q;
  assign x_o = column_q[9:1];
  assign y_o = line_q[8:1];
  assign frame_end_o = column_q == 10'd0 && line_q == 10'd480;

  always_ff @(posedge clk_i) begin
    visible_o <= column_q < 10'd640 && line_q < 10'd480;
    hsync_o <= !(column_q >= 10'd656 && column_q < 10'd752);
    vsync_o <= !(line_q >= 10'd490 && line_q < 10'd492);
    column_q <= column_q == 10'd799 ? 10'd0 : column_q + 10'd1;
    if (column_q == 10'd799) line_q <= line_q == 10'd524 ? 10'd0 : line_q + 10'd1;
    if (!rst_ni) begin
      column_q <= 10'd0;
      line_q <= 10'd0;
    end
  end
endmodule
