// SPDX-License-Identifier: Apache-2.0
// Words of 10 bits to pins, two bits in a clock of shift_clk_i. It has five times the rate of clk_i, from the same PLL,
// at any phase: a bit toggles with the words, and a word is taken two to three clocks after it.
module demo_serialise (
    input logic clk_i,
    input logic shift_clk_i,
    input logic [4*10-1:0] words_i,
    output logic [3:0] pins_o
);
  logic toggle_q = 1'b0;
  logic [39:0] words_q;
  always_ff @(posedge clk_i) begin
    toggle_q <= !toggle_q;
    words_q <= words_i;
  end

  logic [2:0] seen_q = 3'd0;
  always_ff @(posedge shift_clk_i) seen_q <= {seen_q[1:0], toggle_q};

  for (genvar g = 0; g < 4; g++) begin : gen_pin
    logic [9:0] word_q;
    always_ff @(posedge shift_clk_i) word_q <= seen_q[2] != seen_q[1] ? words_q[10*g+:10] : {2'b00, word_q[9:2]};
    ODDRX1F u_pin (.SCLK(shift_clk_i), .RST(1'b0), .D0(word_q[0]), .D1(word_q[1]), .Q(pins_o[g]));
  end
endmodule
