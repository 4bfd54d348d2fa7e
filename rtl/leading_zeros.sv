// Number of zeros above the highest one of a word, by halving. Combinational.
//
// An all-zero word gives an arbitrary count: the user tests for zero. Does not shift.
module leading_zeros #(
    parameter int WIDTH = 32,
    localparam int COUNT_BITS = $clog2(WIDTH)
) (
    input logic [WIDTH-1:0] value_i,
    output logic [COUNT_BITS-1:0] count_o
);
  localparam int PADDED = 1 << COUNT_BITS;  // halving wants a power of two; the padding is below the word

  logic [PADDED-1:0] work;

  always_comb begin
    work = PADDED'(value_i) << (PADDED - WIDTH);
    count_o = '0;
    for (int level = COUNT_BITS - 1; level >= 0; level--) begin
      if ((work >> (PADDED - (1 << level))) == '0) begin
        count_o[level] = 1'b1;
        work = work << (1 << level);
      end
    end
  end
endmodule
