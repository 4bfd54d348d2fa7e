// SPDX-License-Identifier: Apache-2.0
// Every memory of the machine: DEPTH words, one write port, one read port that ends in a register. Replace this module
// to use memory macros (wrap/README.md, Memories). Not reset.
//
// A read takes a clock; data_o stays until the next one. clear_i makes data_o 0 and goes before a read: the fragment
// FIFO alone uses it. A place that is read in the clock of its write gives the word before the write. Only with OLD = 1
// does anything depend on that; with 0 nobody looks at such a word.
module quadrille_memory #(
    parameter int WIDTH = 1, DEPTH = 2,
    /* verilator lint_off UNUSEDPARAM */
    parameter int BLOCK = 0, OLD = 0,  // BLOCK = 1: a block RAM, however few words there are
    /* verilator lint_on UNUSEDPARAM */
    localparam int PLACE = $clog2(DEPTH)
) (
    input logic clk_i,
    input logic write_i,
    input logic [PLACE-1:0] write_place_i,
    input logic [WIDTH-1:0] write_data_i,
    input logic read_i,
    input logic [PLACE-1:0] read_place_i,
    input logic clear_i,
    output logic [WIDTH-1:0] data_o
);
`ifdef YOSYS  // not every tool takes a parameter in an attribute
  (* ram_style = BLOCK ? "block" : "auto", no_rw_check = !OLD *)
`endif
  logic [WIDTH-1:0] word_q[0:DEPTH-1];

  always_ff @(posedge clk_i) begin
    if (write_i) word_q[write_place_i] <= write_data_i;
    if (clear_i) data_o <= '0;
    else if (read_i) data_o <= word_q[read_place_i];
  end

`ifdef FORMAL
  logic [DEPTH*WIDTH-1:0] words;  // for proofs, which have no other way in
  for (genvar g = 0; g < DEPTH; g++) begin : gen_word
    assign words[g*WIDTH+:WIDTH] = word_q[g];
  end
`endif
endmodule
