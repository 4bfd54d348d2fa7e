// SPDX-License-Identifier: Apache-2.0
// DEPTH registers in a row; DEPTH = 0 is a wire. Not reset: for payload, never for valid bits.
module quadrille_delay_line #(
    parameter int WIDTH = 1,
    parameter int DEPTH = 1
) (
    input logic clk_i,
    input logic [WIDTH-1:0] data_i,
    output logic [WIDTH-1:0] data_o
);
  for (genvar g = 0; g < DEPTH; g++) begin : gen_stage
    logic [WIDTH-1:0] data_q;
    if (g == 0) begin : gen_first
      always_ff @(posedge clk_i) data_q <= data_i;
    end else begin : gen_next
      always_ff @(posedge clk_i) data_q <= gen_stage[g-1].data_q;
    end
  end

  if (DEPTH == 0) begin : gen_wire
    logic unused;
    assign unused = clk_i;
    assign data_o = data_i;
  end else begin : gen_out
    assign data_o = gen_stage[DEPTH-1].data_q;
  end
endmodule
