// Takes stamps apart: one pixel a clock, lowest x first; an end entry becomes an end beat without a pixel. A pixel of a homogeneous
// quad goes in its three parts, one a clock (quadrille_pkg: PART_*); it is a pixel, valid, with the last.
//
// A pixel is sent only when a place of fragment_fifo is surely free, since the pipeline behind never waits: free places are counted here,
// less one for each pixel sent, one more for each fragment handed over (freed_i) and each pixel discarded (discard_i). An end beat takes
// no place. The head is popped with its last pixel; pixels leave in registers.
module pixel_emit #(
    localparam int RING = quadrille_pkg::RING_LOG2,
    localparam int PLACES = quadrille_pkg::FRAGMENT_FIFO_LOG2,
    localparam int TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int TILE = quadrille_pkg::TILE
) (
    input logic clk_i,
    input logic rst_ni,
    // Stamp FIFO head
    input logic head_valid_i,
    input logic head_end_i,
    input logic head_homogeneous_i,
    input logic [RING:0] head_ptr_i,
    input logic [TILE_LOG2-1:0] head_row_i,
    input logic [TILE-1:0] head_mask_i,
    input logic [TILE-1:0] head_front_i,
    input logic [TILE-1:0] head_tie_i,
    output logic pop_o,
    // Places of the fragment FIFO given back
    input logic freed_i,
    input logic discard_i,
    // Pixel
    output logic valid_o,
    output logic end_o,
    output logic [1:0] part_o,
    output logic [RING:0] ptr_o,
    output logic [TILE_LOG2-1:0] row_o,
    output logic [TILE_LOG2-1:0] dx_o,
    output logic front_o,
    output logic tie_o
);
  // Free places less one: negative when there is none, so that one bit of a register decides.
  logic [PLACES+1:0] spare_q;
  logic [TILE-1:0] sent_q;
  logic [TILE-1:0] remaining, lowest;
  logic [TILE_LOG2-1:0] dx;
  logic [1:0] part, part_q;  // part_q: the one before, of a homogeneous quad's pixel
  logic may_send, send_part, whole, send;

  assign remaining = head_mask_i & ~sent_q;
  assign lowest = remaining & (TILE'(0) - remaining);
  assign may_send = !spare_q[PLACES+1];
  assign part = head_homogeneous_i ? part_q + 2'd1 : quadrille_pkg::PART_WHOLE;
  assign whole = !head_homogeneous_i || part == quadrille_pkg::PART_SQUARES;
  assign send_part = head_valid_i && !head_end_i && may_send;
  assign send = send_part && whole;
  assign pop_o = head_valid_i && (head_end_i || (may_send && whole && remaining == lowest));

  // Bit b of the place of a single one. (A loop that adds up dx would read what it writes: Icarus would repeat it for ever.)
  for (genvar b = 0; b < TILE_LOG2; b++) begin : gen_dx
    logic [TILE-1:0] with_bit;
    for (genvar i = 0; i < TILE; i++) begin : gen_place
      assign with_bit[i] = lowest[i] && ((i >> b) & 1) == 1;
    end
    assign dx[b] = with_bit != '0;
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      spare_q <= (PLACES + 2)'((1 << PLACES) - 1);
      sent_q <= '0;
      part_q <= quadrille_pkg::PART_WHOLE;
      part_o <= quadrille_pkg::PART_WHOLE;
      valid_o <= 1'b0;
      end_o <= 1'b0;
    end else begin
      spare_q <= spare_q + (PLACES + 2)'(freed_i) + (PLACES + 2)'(discard_i) - (PLACES + 2)'(send);
      if (pop_o) sent_q <= '0;
      else if (send) sent_q <= sent_q | lowest;
      if (send_part) part_q <= whole ? quadrille_pkg::PART_WHOLE : part;
      part_o <= send_part ? part : quadrille_pkg::PART_WHOLE;
      valid_o <= send;
      end_o <= head_valid_i && head_end_i;
    end
  end

  always_ff @(posedge clk_i) begin
    ptr_o <= head_ptr_i;
    row_o <= head_row_i;
    dx_o <= dx;
    front_o <= (head_front_i & lowest) != '0;
    tie_o <= (head_tie_i & lowest) != '0;
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!head_valid_i || (lowest & (lowest - TILE'(1))) == '0);
      assert (!send || remaining != '0);
      assert ($signed(spare_q) >= -(PLACES + 2)'(1) && $signed(spare_q) < $signed((PLACES + 2)'(1 << PLACES)));
    end
  end
`endif
endmodule
