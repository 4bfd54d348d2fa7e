// SPDX-License-Identifier: Apache-2.0
// TMDS encoder of a channel (DVI 1.0, 3.2): few transitions, then as many ones as zeros in the long run.
module demo_tmds (
    input logic clk_i,
    input logic visible_i,
    input logic [1:0] control_i,  // sent while not visible
    input logic [7:0] data_i,
    output logic [9:0] word_o  // bit 0 goes first
);
  function automatic logic [3:0] ones(input logic [7:0] bits);
    ones = 4'd0;
    for (int i = 0; i < 8; i++) ones += {3'd0, bits[i]};
  endfunction

  // Fewer transitions: each bit is XOR or XNOR with the one before it; bit 8 says which.
  logic same, balanced, invert;
  logic [8:0] coded;
  assign same = ones(data_i) > 4'd4 || (ones(data_i) == 4'd4 && !data_i[0]);
  for (genvar g = 0; g < 8; g++) begin : gen_coded
    assign coded[g] = ^data_i[g:0] ^ (g % 2 == 1 && same);  // XNOR g times
  end
  assign coded[8] = !same;

  // Ones minus zeros, both halved: of the coded byte, and of all words sent since the line began.
  logic signed [4:0] excess, sum_q;
  assign excess = $signed({1'b0, ones(coded[7:0])}) - 5'sd4;
  assign balanced = sum_q == 5'sd0 || excess == 5'sd0;
  assign invert = balanced ? same : sum_q[4] == excess[4];

  always_ff @(posedge clk_i) begin
    if (visible_i) begin
      word_o <= {invert, coded[8], invert ? ~coded[7:0] : coded[7:0]};
      sum_q <= invert ? sum_q - excess + (balanced ? 5'sd0 : $signed({4'd0, coded[8]}))
          : sum_q + excess - (balanced ? 5'sd0 : $signed({4'd0, same}));
    end else begin
      sum_q <= 5'sd0;
      case (control_i)
        2'b00: word_o <= 10'b1101010100;
        2'b01: word_o <= 10'b0010101011;
        2'b10: word_o <= 10'b0101010100;
        default: word_o <= 10'b1010101011;
      endcase
    end
  end
endmodule
