// Takes covered stamps apart: one pixel an enabled clock, lowest x first; an end entry becomes an end beat without a pixel.
//
// Combinational from the FIFO head and the register of pixels already sent; the head is popped with its last pixel.
module pixel_emit #(
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int TILE = quadrille_pkg::TILE
) (
    input logic clk_i,
    input logic rst_ni,
    input logic en_i,
    // Stamp FIFO head
    input logic head_valid_i,
    input logic head_end_i,
    input logic [TILE-1:0] head_mask_i,
    input logic [TILE-1:0] head_front_i,
    input logic [TILE-1:0] head_tie_i,
    output logic pop_o,
    // Pixel
    output logic valid_o,
    output logic end_o,
    output logic [TILE_LOG2-1:0] dx_o,
    output logic front_o,
    output logic tie_o
);
  logic [TILE-1:0] sent_q;
  logic [TILE-1:0] remaining, lowest;

  assign remaining = head_mask_i & ~sent_q;
  assign lowest = remaining & (TILE'(0) - remaining);
  assign valid_o = head_valid_i && !head_end_i;
  assign end_o = head_valid_i && head_end_i;
  assign pop_o = head_valid_i && en_i && (head_end_i || remaining == lowest);
  assign front_o = (head_front_i & lowest) != '0;
  assign tie_o = (head_tie_i & lowest) != '0;

  always_comb begin
    dx_o = '0;
    for (int i = 0; i < TILE; i++) if (lowest[i]) dx_o = dx_o | TILE_LOG2'(i);
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) sent_q <= '0;
    else if (pop_o) sent_q <= '0;
    else if (head_valid_i && en_i) sent_q <= sent_q | lowest;
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert ((lowest & (lowest - TILE'(1))) == '0);
      assert (!valid_o || remaining != '0);
    end
  end
`endif
endmodule
