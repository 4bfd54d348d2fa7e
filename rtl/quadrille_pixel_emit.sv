// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
`include "quadrille_types.svh"
// Takes stamps apart: the PIXELS_PER_CLOCK lowest pixels a clock, lowest x in lane 0; an end entry becomes an end beat
// without a pixel. The pixels of a homogeneous quad go in their three parts, one a clock (quadrille_pkg: PART_*); they
// are pixels, valid, with the last.
//
// Pixels are sent only when a place of fragment_fifo is surely free, since the pipeline behind never waits: free places
// are counted here, less one for the pixels of a clock, one more for each hand-over (freed_i) and for pixels that were
// all discarded (discard_i). An end beat takes no place. The head is popped with its last pixel; pixels leave in
// registers.
module quadrille_pixel_emit #(
    localparam int P = quadrille_pkg::PIXELS_PER_CLOCK, RING = quadrille_pkg::RING_LOG2,
    localparam int PLACES = quadrille_pkg::FRAGMENT_FIFO_LOG2, TILE_LOG2 = quadrille_pkg::TILE_LOG2,
    localparam int TILE = quadrille_pkg::TILE
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    // Stamp FIFO head
    input logic head_valid_i,
    input logic [quadrille_pkg::STAMP_BITS-1:0] head_i,
    output logic pop_o,
    // Places of the fragment FIFO given back
    input logic freed_i, discard_i,
    // Pixels, and the ring's entry of their tile
    output logic [RING:0] ptr_o,
    output logic [quadrille_pkg::PIXELS_BITS-1:0] pixels_o,
    output logic event_o  // for performance_counters, else 0: the head has no place for its fragments
);
  `QUADRILLE_IN(`QUADRILLE_STAMP_T, head)
  logic sent_end;
  logic [1:0] sent_part;
  logic [quadrille_pkg::TILE_LOG2-1:0] sent_row;
  logic [quadrille_pkg::ROW_DIGIT_BITS-1:0] sent_row_digits;
  logic [quadrille_pkg::PIXELS_PER_CLOCK*quadrille_pkg::TILE_LOG2-1:0] sent_dx;
  logic [quadrille_pkg::PIXELS_PER_CLOCK-1:0] sent_valid, sent_front, sent_tie;
  assign pixels_o = {sent_end, sent_part, sent_row, sent_row_digits, sent_dx, sent_valid, sent_front, sent_tie};

  // Free places less one: negative when there is none, so that one bit of a register decides.
  logic [PLACES+1:0] spare_q;
  logic [TILE-1:0] sent_q, remaining, chosen;
  logic [1:0] part, part_q;  // part_q: the one before, of a homogeneous quad's pixels
  logic may_send, send_part, whole, send;
  assign remaining = head.mask & ~sent_q;
  assign may_send = !spare_q[PLACES+1];
  assign part = head.homogeneous ? part_q + 2'd1 : quadrille_pkg::PART_WHOLE;
  assign whole = !head.homogeneous || part == quadrille_pkg::PART_SQUARES;
  assign send_part = head_valid_i && !head.end_token && may_send;
  assign send = send_part && whole;
  assign event_o = quadrille_pkg::PERFORMANCE_COUNTERS != 0 && head_valid_i && !head.end_token && !may_send;
  assign pop_o = head_valid_i && (head.end_token || (may_send && whole && remaining == chosen));

  // ---- Ranks: bit n of a pixel's P bits says that more than n remaining pixels lie in a range that ends with it ----
  // Ranges double from level to level: up to the pixel's 2^l-th place, the range of the block before is joined to its
  // own.
  for (genvar l = 0; l <= TILE_LOG2; l++) begin : gen_level
    logic [TILE*P-1:0] more;

    for (genvar i = 0; i < TILE; i++) begin : gen_pixel
      if (l == 0) begin : gen_one
        assign more[i*P+:P] = P'(remaining[i]);
      end else if (((i >> (l - 1)) & 1) == 1) begin : gen_join
        assign more[i*P+:P] = join_ranges(gen_level[l-1].more[i*P+:P], gen_level[l-1].more[((i>>(l-1)<<(l-1))-1)*P+:P]);
      end else begin : gen_keep
        assign more[i*P+:P] = gen_level[l-1].more[i*P+:P];
      end
    end
  end

  // More than n in two ranges: more than n in one of them, or more than k in one and more than n - 1 - k in the other.
  function automatic logic [P-1:0] join_ranges(input logic [P-1:0] a, input logic [P-1:0] b);
    for (int n = 0; n < P; n++) begin
      join_ranges[n] = a[n] | b[n];
      for (int k = 0; k < n; k++) join_ranges[n] = join_ranges[n] | (a[k] & b[n-1-k]);
    end
  endfunction

  // ---- Lanes: lane g has the pixel that has g remaining ones below it ----------------------------------------------
  for (genvar i = 0; i < TILE; i++) begin : gen_chosen
    if (i == 0) begin : gen_lowest
      assign chosen[i] = remaining[i];
    end else begin : gen_other
      assign chosen[i] = remaining[i] && !gen_level[TILE_LOG2].more[(i-1)*P+P-1];
    end
  end

  for (genvar g = 0; g < P; g++) begin : gen_lane
    logic [TILE-1:0] own;  // its pixel
    logic [TILE_LOG2-1:0] dx;
    logic present;

    for (genvar i = 0; i < TILE; i++) begin : gen_own
      logic enough, too_many;  // remaining ones below
      if (i == 0) begin : gen_none
        assign enough = g == 0;
        assign too_many = 1'b0;
      end else if (g == 0) begin : gen_first
        assign enough = 1'b1;
        assign too_many = gen_level[TILE_LOG2].more[(i-1)*P];
      end else begin : gen_next
        assign enough = gen_level[TILE_LOG2].more[(i-1)*P+g-1];
        assign too_many = gen_level[TILE_LOG2].more[(i-1)*P+g];
      end
      assign own[i] = remaining[i] && enough && !too_many;
    end

    assign present = g == 0 || own != '0;  // a head that is no end has a pixel left

    // Bit b of the place of a single one. (A loop that adds up dx would read what it writes: Icarus would repeat it for
    // ever.)
    for (genvar b = 0; b < TILE_LOG2; b++) begin : gen_dx
      logic [TILE-1:0] with_bit;
      for (genvar i = 0; i < TILE; i++) begin : gen_place
        assign with_bit[i] = own[i] && ((i >> b) & 1) == 1;
      end
      assign dx[b] = with_bit != '0;
    end

    always_ff @(posedge clk_i) begin
      if (!rst_ni) sent_valid[g] <= 1'b0;
      else sent_valid[g] <= send && present;
    end

    always_ff @(posedge clk_i) begin
      sent_dx[g*TILE_LOG2+:TILE_LOG2] <= dx;
      sent_front[g] <= (head.front & own) != '0;
      sent_tie[g] <= (head.tie & own) != '0;
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      spare_q <= (PLACES + 2)'((1 << PLACES) - 1);
      sent_q <= '0;
      part_q <= quadrille_pkg::PART_WHOLE;
      sent_part <= quadrille_pkg::PART_WHOLE;
      sent_end <= 1'b0;
    end else begin
      spare_q <= spare_q + (PLACES + 2)'(freed_i) + (PLACES + 2)'(discard_i) - (PLACES + 2)'(send);
      if (pop_o) sent_q <= '0;
      else if (send) sent_q <= sent_q | chosen;
      if (send_part) part_q <= whole ? quadrille_pkg::PART_WHOLE : part;
      sent_part <= send_part ? part : quadrille_pkg::PART_WHOLE;
      sent_end <= head_valid_i && head.end_token;
    end
  end

  logic [quadrille_pkg::ROW_DIGIT_BITS-1:0] row_digits;
  quadrille_radix4_digits #(.NUMBER_BITS(TILE_LOG2)) u_row_digits (.number_i(head.row), .digits_o(row_digits));

  always_ff @(posedge clk_i) begin
    ptr_o <= head.tile_ptr;
    sent_row <= head.row;
    sent_row_digits <= row_digits;
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_chosen_remain,
          !head_valid_i || (chosen & ~remaining) == '0,
          "chosen pixels are among those that remain")
      `QUADRILLE_ASSERT(assert_send_some, !send || remaining != '0, "what is sent has a pixel")
      `QUADRILLE_ASSERT(assert_spare_range,
          $signed(spare_q) >= -(PLACES + 2)'(1) && $signed(spare_q) < $signed((PLACES + 2)'(1 << PLACES)),
          "the count of spare places is in range")
    end
  end
`endif
endmodule
