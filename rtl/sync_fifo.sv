// First-in first-out buffer with 2^DEPTH_LOG2 words; full and valid come from the registered count, the head is a combinational
// read. A push while full or a pop while empty is the user's error (asserted). Data is not reset.
module sync_fifo #(
    parameter int WIDTH = 8,
    parameter int DEPTH_LOG2 = 3
) (
    input logic clk_i,
    input logic rst_ni,
    input logic push_i,
    input logic [WIDTH-1:0] data_i,
    output logic full_o,
    input logic pop_i,
    output logic valid_o,
    output logic [WIDTH-1:0] data_o
);
  localparam int DEPTH = 1 << DEPTH_LOG2;

  logic [WIDTH-1:0] word_q[0:DEPTH-1];
  logic [DEPTH_LOG2-1:0] write_q, read_q;
  logic [DEPTH_LOG2:0] count_q;

  assign full_o = count_q == (DEPTH_LOG2 + 1)'(DEPTH);
  assign valid_o = count_q != '0;
  assign data_o = word_q[read_q];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      write_q <= '0;
      read_q <= '0;
      count_q <= '0;
    end else begin
      if (push_i) write_q <= write_q + DEPTH_LOG2'(1);
      if (pop_i) read_q <= read_q + DEPTH_LOG2'(1);
      count_q <= count_q + (DEPTH_LOG2 + 1)'(push_i) - (DEPTH_LOG2 + 1)'(pop_i);
    end
  end

  always_ff @(posedge clk_i) if (push_i) word_q[write_q] <= data_i;

`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!push_i || !full_o);
      assert (!pop_i || valid_o);
      assert (count_q <= (DEPTH_LOG2 + 1)'(DEPTH));
    end
  end
`endif
endmodule
