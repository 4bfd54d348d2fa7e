// SPDX-License-Identifier: Apache-2.0
`include "quadrille_assert.svh"
// First-in first-out buffer for at most DEPTH words, its output register included: the head and its valid bit are
// registers, a word is there two clocks after its push. The user knows that there is room: a push beyond, or a pop of
// nothing, is an error (asserted). Data is not reset.
module quadrille_sync_fifo #(
    parameter int WIDTH = 8,
    parameter int DEPTH = 8
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic push_i,
    input logic [WIDTH-1:0] data_i,
    input logic pop_i,
    output logic empty_o,  // nothing behind the head either
    output logic valid_o,
    output logic [WIDTH-1:0] data_o
);
  localparam int POINTER = $clog2(DEPTH);
  localparam int COUNT = $clog2(DEPTH + 1);

  logic [POINTER-1:0] write_q, read_q;
  logic [COUNT-1:0] count_q;  // of words behind the head
  logic valid_q, load;
  assign load = count_q != '0 && (!valid_q || pop_i);
  assign valid_o = valid_q;
  assign empty_o = count_q == '0 && !valid_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      write_q <= '0;
      read_q <= '0;
      count_q <= '0;
      valid_q <= 1'b0;
    end else begin
      if (push_i) write_q <= write_q + POINTER'(1);
      if (load) read_q <= read_q + POINTER'(1);
      count_q <= count_q + COUNT'(push_i) - COUNT'(load);
      valid_q <= load || (valid_q && !pop_i);
    end
  end

  quadrille_memory #(.WIDTH(WIDTH), .DEPTH(1 << POINTER)) u_word (
      .clk_i, .write_i(push_i), .write_place_i(write_q), .write_data_i(data_i), .read_i(load), .read_place_i(read_q),
      .clear_i(1'b0), .data_o
  );

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `QUADRILLE_ASSERT(assert_push_has_room,
          !push_i || count_q + COUNT'(valid_q) < COUNT'(DEPTH),
          "a word pushed finds a place")
      `QUADRILLE_ASSERT(assert_pop_has_word, !pop_i || valid_q, "pop comes with a valid head")
    end
  end
`endif
endmodule
