// SPDX-License-Identifier: Apache-2.0
// Spill register: two places between a producer and a consumer, so that valid, payload and ready of either side are
// registers of their own. A beat a clock, a clock later. Data is not reset.
module quadrille_spill #(
    parameter int WIDTH = 1
) (
    input logic clk_i,
    input logic rst_ni,  // synchronous, active low
    input logic clear_i,  // forgets both places and the beat of this clock
    input logic valid_i,
    output logic ready_o,
    input logic [WIDTH-1:0] data_i,
    output logic valid_o,
    input logic ready_i,
    output logic [WIDTH-1:0] data_o
);
  logic spilled_q;  // the second place is in use
  logic [WIDTH-1:0] spill_q;
  assign ready_o = !spilled_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni || clear_i) begin
      valid_o <= 1'b0;
      spilled_q <= 1'b0;
    end else if (!valid_o || ready_i) begin
      valid_o <= spilled_q || valid_i;
      spilled_q <= 1'b0;
    end else if (valid_i) begin
      spilled_q <= 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (!valid_o || ready_i) data_o <= spilled_q ? spill_q : data_i;
    if (!spilled_q) spill_q <= data_i;
  end
endmodule
