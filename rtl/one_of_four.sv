// One of four words by its index. Combinational.
//
// A case, not words_i[index*WIDTH +: WIDTH]: synthesis takes the product in the latter for a multiplier.
module one_of_four #(
    parameter int WIDTH = 8
) (
    input logic [4*WIDTH-1:0] words_i,
    input logic [1:0] index_i,
    output logic [WIDTH-1:0] word_o
);
  always_comb begin
    case (index_i)
      2'd0: word_o = words_i[0+:WIDTH];
      2'd1: word_o = words_i[WIDTH+:WIDTH];
      2'd2: word_o = words_i[2*WIDTH+:WIDTH];
      default: word_o = words_i[3*WIDTH+:WIDTH];
    endcase
  end
endmodule
