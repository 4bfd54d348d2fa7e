// SPDX-License-Identifier: Apache-2.0
// Moves the highest one of a word to its top bit, by halving, and says by how much. Combinational.
//
// Levels FIRST down to LAST: if the 2^level bits at the top are zero, the word moves up by 2^level and that bit of the
// count is set. With all levels from $clog2(WIDTH)-1 to 0 the count is the number of leading zeros, and the top bit of
// the result says whether the word is not zero; the count of a zero word means nothing. Two modules in a row can share
// the levels.
module quadrille_shift_to_top #(
    parameter int WIDTH = 32,
    parameter int FIRST = $clog2(WIDTH) - 1,
    parameter int LAST = 0
) (
    input logic [WIDTH-1:0] value_i,
    output logic [FIRST:LAST] count_o,
    output logic [WIDTH-1:0] value_o
);
  logic [WIDTH-1:0] work;

  always_comb begin
    work = value_i;
    count_o = '0;
    for (int level = FIRST; level >= LAST; level--) begin
      if ((work >> (WIDTH - (1 << level))) == '0) begin
        count_o[level] = 1'b1;
        work = work << (1 << level);
      end
    end
    value_o = work;
  end
endmodule
